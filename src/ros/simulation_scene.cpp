#include <algorithm>
#include <chrono>
#include <utility>

#include "verlet_cable/ros/location.h"
#include "verlet_cable/ros/simulation.h"

namespace verlet_cable {
namespace {

/// A world that takes longer than this to build [s] is built aside.
constexpr double longest_build = 0.02;
/// So many worlds that nobody waits for any longer may still be being built.
constexpr std::size_t most_abandoned = 4;

Simulation::BuiltWorld timed_build(const SceneDesc& scene, const BoundaryInputs& frames) {
  const auto begin = std::chrono::steady_clock::now();
  World world(scene, frames);
  return {std::move(world), std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()};
}

bool is_ready(const std::future<Simulation::BuiltWorld>& built) {
  return built.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

World Simulation::build(const BoundaryInputs& frames) {
  BuiltWorld built = timed_build(scene_, frames);
  build_time_ = built.time;
  return std::move(built.world);
}

void Simulation::build_aside(const SceneDesc& scene, bool loads, const Answer& answer) {
  auto built = std::async(std::launch::async, timed_build, scene, present_frames(scene));
  rebuilds_.push_back({std::move(built), scene, scene_version_, loads, {answer}});
}

/// Where the frames of a scene are now, as far as that is known.
BoundaryInputs Simulation::present_frames(const SceneDesc& scene) const {
  BoundaryInputs frames = initial_frames(scene);
  if (!started_) return frames;
  const std::vector<std::string> names = frame_names(scene);
  for (std::size_t i = 1; i < names.size(); ++i)
    if (const std::optional<Pose> pose = find_frame(names[i])) frames[i] = {*pose, true};
  return frames;
}

void Simulation::finish_rebuilds() {
  abandoned_.remove_if([](const std::future<BuiltWorld>& built) { return is_ready(built); });
  const auto ready = [this](bool loads) {
    const auto first = std::find_if(rebuilds_.begin(), rebuilds_.end(), [&](const Rebuild& r) { return r.loads == loads; });
    return first != rebuilds_.end() && is_ready(first->built) ? first : rebuilds_.end();
  };
  // Scenes in the order they were asked for. Resets do not wait for them: a scene ends whatever was done before it came.
  for (const bool loads : {true, false}) {
    for (auto first = ready(loads); first != rebuilds_.end(); first = ready(loads)) {
      Rebuild rebuild = std::move(*first);
      rebuilds_.erase(first);
      finish(std::move(rebuild));
    }
  }
}

void Simulation::finish(Rebuild rebuild) {
  EditResult result;
  try {
    BuiltWorld built = rebuild.built.get();
    build_time_ = built.time;
    if (rebuild.loads) {
      result = replace_scene(rebuild.scene, std::move(built.world));
    } else {
      if (rebuild.scene_version != scene_version_) built.world.tune(scene_);
      result = start_anew(std::move(built.world));
    }
  } catch (const SceneError& error) {
    result = {false, verlet_cable::join(error.errors()), {}};
  }
  for (const Answer& answer : rebuild.answers) answer(result);
}

bool Simulation::builds() const {
  const auto goes_on = [](const std::future<BuiltWorld>& built) { return !is_ready(built); };
  return std::any_of(rebuilds_.begin(), rebuilds_.end(), [&](const Rebuild& rebuild) { return goes_on(rebuild.built); }) ||
         std::any_of(abandoned_.begin(), abandoned_.end(), goes_on);
}

/// Something that came after them puts the world where it has to be.
void Simulation::forget_resets(const std::string& reason) {
  for (auto rebuild = rebuilds_.begin(); rebuild != rebuilds_.end();) {
    if (rebuild->loads) {
      ++rebuild;
      continue;
    }
    for (const Answer& answer : rebuild->answers) answer({true, "reset, and " + reason + " since", {}});
    // Its end would be waited for.
    abandoned_.push_back(std::move(rebuild->built));
    rebuild = rebuilds_.erase(rebuild);
  }
  if (abandoned_.size() > most_abandoned) abandoned_.pop_front();
}

void Simulation::reset(const Answer& answer) {
  if (!started_) return answer(refused_before_start());
  interrupt_steps("the simulation was reset");
  if (build_time_ <= longest_build) {
    frames_.reset(stamp_);
    return answer(start_anew(build(frames_.inputs())));
  }
  const auto pending = std::find_if(rebuilds_.begin(), rebuilds_.end(), [](const Rebuild& rebuild) { return !rebuild.loads; });
  if (pending == rebuilds_.end()) return build_aside(scene_, false, answer);
  pending->answers.push_back(answer);
}

EditResult Simulation::start_anew(World world) {
  frames_.reset(stamp_);
  world_ = std::move(world);
  // What was built aside may not know the newest frames.
  world_.start_waiting(frames_.inputs());
  moves_.clear();
  place_added_obstacles();
  faulted_ = false;
  intrusions_.clear();
  frame_watch_.forget_from(static_cast<int>(world_.frames().size()));
  report_starts(0, 0);
  const std::string message = "reset to the initial state of the scene";
  announce(CableEvent::RESET, {}, message);
  if (paused_) publish();
  return {true, message, {}};
}

void Simulation::load_scene(const SceneDesc& scene, const Answer& answer) {
  build_aside(scene, true, answer);
}

EditResult Simulation::replace_scene(const SceneDesc& scene, World world) {
  const std::string message = "the scene is replaced by one of " + std::to_string(scene.cables.size()) + " cables";
  interrupt_steps(message);
  forget_resets(message);
  use_scene(scene);
  grid_ = TimeGrid(scene.time_step, scene.publish_rate);
  pacer_.use(grid_, longest_backlog(scene));
  world_ = std::move(world);
  moves_.clear();
  frames_.follow_scene(scene, stamp_);
  events_.set_frame_id(scene.frame_id);
  frame_watch_.watch(scene);
  snapshots_.clear();
  faulted_ = waits_for_frames_ = keeps_world_ = false;
  if (started_) {
    // What is built fast is built again, with the frames where they are at the step that it starts from.
    start(grid_.step_at_or_after(stamp_), build_time_ <= longest_build);
    announce(CableEvent::RESET, {}, message);
  } else {
    place_added_obstacles();
  }
  return {true, message, {}};
}

void Simulation::tune(const SceneDesc& scene) {
  world_.tune(scene);
  use_scene(scene);
}

void Simulation::use_scene(const SceneDesc& scene) {
  scene_ = scene;
  ++scene_version_;
  publishers_.show(scene);
}

}  // namespace verlet_cable
