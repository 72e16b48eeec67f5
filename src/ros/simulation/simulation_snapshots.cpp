#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "scene/world_file.h"
#include "scene_sources/scene_files.h"
#include "simulation/edit_result.h"
#include "simulation/simulation.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/scene/resource.h"

namespace verlet_cable {
namespace {

constexpr std::size_t longest_name = 100;

EditResult refused_both(const std::string& name, const std::string& file) {
  return refused("name, file: " + in_quotes(name) + " and " + in_quotes(file) + "; allowed: one of them");
}

/// As a whole, or not at all. Throws SceneError.
void write_file(const std::string& path, const std::string& bytes) {
  const std::string part = path + ".part";
  std::ofstream file(part, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(part, path, error);
  if (file && !error) return;
  std::filesystem::remove(part, error);
  throw SceneError({"file: " + in_quotes(path) + " cannot be written; allowed: where the node may write"});
}

std::string names_of(const std::map<std::string, Snapshot>& snapshots) {
  NameList names;
  for (const auto& [name, snapshot] : snapshots) names.add(name);
  return names.text("none is saved");
}

}  // namespace

EditResult Simulation::save_state(const std::string& name, const std::string& file) {
  if (!started_) return refused_before_start();
  if (faulted_) return refused("the simulation has failed: call reset first");
  if (!name.empty() && !file.empty()) return refused_both(name, file);
  if (!file.empty()) {
    try {
      write_file(writable_scene_file("file", file, scene_.scene_directory), write_world(scene_, world_, {}));
    } catch (const SceneError& error) {
      return refused(error.what());
    }
    return done("saved to " + in_quotes(file));
  }
  if (name.size() > longest_name || !is_name(name)) {
    return refused("name: " + in_quotes(name) + "; allowed: " + name_words + ", at most " + std::to_string(longest_name));
  }
  const auto known = snapshots_.find(name);
  const auto most = static_cast<std::size_t>(scene_.limits.snapshots);
  if (known == snapshots_.end() && snapshots_.size() >= most) {
    return refused("name: " + in_quotes(name) + "; limits.snapshots allows " + std::to_string(most) +
                   "; allowed: to replace one of them: " + names_of(snapshots_));
  }
  const bool replaces = known != snapshots_.end();
  snapshots_.insert_or_assign(name, Snapshot{world_, scene_, stamp_, frames_.save(), added_obstacles_});
  return done("saved as " + in_quotes(name) + (replaces ? ", which is replaced" : ""));
}

EditResult Simulation::restore_state(const std::string& name, const std::string& file) {
  if (!started_) return refused_before_start();
  if (!name.empty() && !file.empty()) return refused_both(name, file);
  if (!file.empty()) {
    try {
      return restore(read_snapshot(file), "restored the file " + in_quotes(file));
    } catch (const std::exception& error) {
      return refused(error.what());
    }
  }
  const auto found = snapshots_.find(name);
  if (found == snapshots_.end()) return refused("name: " + in_quotes(name) + "; allowed: " + names_of(snapshots_));
  return restore(found->second, "restored the snapshot " + in_quotes(name));
}

/// Of the present scene, with the frames where they are now. Throws SceneError, std::invalid_argument.
Snapshot Simulation::read_snapshot(const std::string& file) const {
  const std::string path = find_scene_file("file", file, scene_.scene_directory);
  WorldFile saved = [&] {
    try {
      return read_world(scene_, read_file(path));
    } catch (const ResourceError& error) {
      throw SceneError({"file: " + in_quotes(file) + ": " + error.what()});
    }
  }();
  Snapshot snapshot{std::move(saved.world), {}, stamp_, frames_.save(), {}};
  snapshot.scene = snapshot.world.scene();
  const World begun(scene_);
  for (const Obstacle& obstacle : snapshot.world.obstacles()) {
    const auto is_it = [&](const Obstacle& other) { return other.name == obstacle.name; };
    if (std::any_of(begun.obstacles().begin(), begun.obstacles().end(), is_it)) continue;
    snapshot.added_obstacles.emplace(obstacle.name, AddedObstacle{obstacle, snapshot.world.frames()[obstacle.frame]});
  }
  return snapshot;
}

EditResult Simulation::restore(const Snapshot& snapshot, const std::string& message) {
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
