#include <algorithm>
#include <utility>

#include "edit_requests/error_text.h"
#include "simulation/simulation.h"

namespace verlet_cable {
namespace {

/// A world that takes longer than this to build [s] is built aside.
constexpr double longest_build = 0.01;

}  // namespace

World Simulation::build(const BoundaryInputs& frames) {
  BuiltWorld built = build_world(scene_, frames);
  build_time_ = built.time;
  return std::move(built.world);
}

/// In place of the one that is there.
void Simulation::use_world(World world) {
  std::swap(world_, world);
  publishers_.forget_steps();
  tasks_.dispose(std::move(world));
}

void Simulation::build_aside(const SceneDesc& scene, bool loads, const Answer& answer) {
  rebuilds_.push_back({WorldBuild(scene, present_frames(scene), tasks_), scene, scene_version_, loads, {answer}});
}

/// The world that a run starts with is built aside, but for one that is built fast: that starts at once.
void Simulation::prepare_start(Nanoseconds time) {
  sample_at_start(time);
  if (keeps_world_) return start(time);
  start_.emplace(Start{WorldBuild(scene_, frames_.inputs(), tasks_), time, scene_version_});
  if (start_->build.is_ready(longest_build)) return finish_start();
  // Until then: frames of obstacles that came before are numbered anew, as sampling has dropped them.
  use_world(World(scene_));
  place_added_obstacles();
}

void Simulation::finish_start() {
  Start prepared = std::move(*start_);
  start_.reset();
  BuiltWorld built = prepared.build.take();
  build_time_ = built.time;
  if (prepared.scene_version != scene_version_) built.world.tune(scene_);
  use_world(std::move(built.world));
  start(prepared.time);
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
  while (finish_newest_load()) continue;
  // Resets do not wait for scenes: a scene ends whatever was done before it came.
  const auto reset = std::find_if(rebuilds_.begin(), rebuilds_.end(), [](const Rebuild& rebuild) { return !rebuild.loads; });
  if (reset == rebuilds_.end() || !reset->build.is_ready()) return;
  Rebuild rebuild = std::move(*reset);
  rebuilds_.erase(reset);
  finish(std::move(rebuild));
}

/// Those that were asked for before it would only be replaced by it. False where none is built.
bool Simulation::finish_newest_load() {
  const auto loads = [](const Rebuild& rebuild) { return rebuild.loads; };
  const auto is_built = [](const Rebuild& rebuild) { return rebuild.loads && rebuild.build.is_ready(); };
  const auto newest = std::find_if(rebuilds_.rbegin(), rebuilds_.rend(), is_built);
  if (newest == rebuilds_.rend()) return false;
  Rebuild rebuild = std::move(*newest);
  const auto next = std::find_if(rebuilds_.erase(std::prev(newest.base())), rebuilds_.end(), loads);
  const EditResult result = finish(std::move(rebuild));
  if (result.ok) forget(true, next, "loaded, and " + result.message + " since");
  return true;
}

EditResult Simulation::finish(Rebuild rebuild) {
  EditResult result;
  try {
    BuiltWorld built = rebuild.build.take();
    build_time_ = built.time;
    if (rebuild.loads) {
      result = replace_scene(rebuild.scene, std::move(built.world));
    } else {
      if (rebuild.scene_version != scene_version_) built.world.tune(scene_);
      result = start_anew(std::move(built.world));
    }
  } catch (const SceneError& error) {
    result = refused(error.errors());
  } catch (const std::exception& error) {
    result = {false, std::string("the scene could not be built: ") + error.what(), {}};
  }
  for (const Answer& answer : rebuild.answers) answer(result);
  return result;
}

/// Scenes, or resets, that were asked for before `end`: something that came after them puts the world where it has to be.
void Simulation::forget(bool loads, std::list<Rebuild>::iterator end, const std::string& message) {
  for (auto rebuild = rebuilds_.begin(); rebuild != end;) {
    if (rebuild->loads != loads) {
      ++rebuild;
      continue;
    }
    for (const Answer& answer : rebuild->answers) answer({true, message, {}});
    rebuild = rebuilds_.erase(rebuild);
  }
}

void Simulation::forget_resets(const std::string& reason) {
  forget(false, rebuilds_.end(), "reset, and " + reason + " since");
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
  use_world(std::move(world));
  // What was built aside may not know the newest frames.
  world_.start_waiting(frames_.inputs());
  moves_.clear();
  place_added_obstacles();
  faulted_ = false;
  frame_watch_.forget_from(static_cast<int>(world_.frames().size()));
  cable_watch_.restart(stamp_, world_);
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
  use_world(std::move(world));
  moves_.clear();
  frames_.follow_scene(scene, stamp_);
  events_.set_frame_id(scene.frame_id);
  frame_watch_.watch(scene);
  missing_frames_.watch();
  tasks_.dispose(std::exchange(snapshots_, {}));
  start_.reset();
  faulted_ = waits_for_frames_ = keeps_world_ = false;
  if (started_) {
    const Nanoseconds time = grid_.step_at_or_after(stamp_);
    sample_at_start(time);
    // What is built fast is built again, with the frames where they are at the step that it starts from.
    if (build_time_ <= longest_build) use_world(build(frames_.inputs()));
    start(time);
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
