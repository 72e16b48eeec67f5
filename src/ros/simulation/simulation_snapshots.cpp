#include "simulation/simulation.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

constexpr std::size_t longest_name = 100;

EditResult done(const std::string& message) {
  return {true, message, {}};
}
EditResult refused(const std::string& message) {
  return {false, message, {}};
}

std::string names_of(const std::map<std::string, Snapshot>& snapshots) {
  NameList names;
  for (const auto& [name, snapshot] : snapshots) names.add(name);
  return names.text("none is saved");
}

}  // namespace

EditResult Simulation::save_state(const std::string& name) {
  if (!started_) return refused_before_start();
  if (faulted_) return refused("the simulation has failed: call reset first");
  if (name.size() > longest_name || !is_name(name)) {
    return refused("name: " + quoted(name) + "; allowed: " + name_words + ", at most " + std::to_string(longest_name));
  }
  const auto known = snapshots_.find(name);
  const auto most = static_cast<std::size_t>(scene_.limits.snapshots);
  if (known == snapshots_.end() && snapshots_.size() >= most) {
    return refused("name: " + quoted(name) + "; limits.snapshots allows " + std::to_string(most) +
                   "; allowed: to replace one of them: " + names_of(snapshots_));
  }
  const bool replaces = known != snapshots_.end();
  snapshots_.insert_or_assign(name, Snapshot{world_, scene_, stamp_, frames_.save(), added_obstacles_});
  return done("saved as " + quoted(name) + (replaces ? ", which is replaced" : ""));
}

EditResult Simulation::restore_state(const std::string& name) {
  if (!started_) return refused_before_start();
  const auto found = snapshots_.find(name);
  if (found == snapshots_.end()) return refused("name: " + quoted(name) + "; allowed: " + names_of(snapshots_));
  const Snapshot& snapshot = found->second;
  const std::string message = "restored the snapshot " + quoted(name);
  interrupt_steps(message);
  forget_resets(message);
  cable_watch_.end_statuses(stamp_);
  world_ = snapshot.world;
  publishers_.forget_steps();
  added_obstacles_ = snapshot.added_obstacles;
  moves_.clear();
  use_scene(snapshot.scene);
  if (paused_) {
    stamp_ = snapshot.stamp;
    frames_.rewind(snapshot.frames, stamp_);
  } else {
    frames_.restore(snapshot.frames, stamp_);
    // Their frames may have come since it was saved.
    start_waiting_cables();
  }
  faulted_ = false;
  stepped_to_ = 0;
  frame_watch_.forget_from(static_cast<int>(frame_names(scene_).size()));
  announce(CableEvent::RESET, {}, message);
  if (paused_) publish();
  return done(message);
}

std::optional<Snapshot> Simulation::snapshot(const std::string& name) const {
  if (name.empty()) return Snapshot{world_, scene_, stamp_, frames_.save(), added_obstacles_};
  const auto found = snapshots_.find(name);
  return found == snapshots_.end() ? std::nullopt : std::optional<Snapshot>(found->second);
}

}  // namespace verlet_cable
