#include <algorithm>
#include <cassert>
#include <utility>

#include "simulation/simulation.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

constexpr std::size_t most_obstacles = 1000;
/// A world cannot forget a frame.
constexpr std::size_t most_frames = 2000;

}  // namespace

EditResult Simulation::set_obstacle(Obstacle obstacle, const std::string& frame) {
  const bool is_new = added_obstacles_.count(obstacle.name) == 0;
  if (is_new && added_obstacles_.size() >= most_obstacles)
    return {false, "there are " + std::to_string(most_obstacles) + " obstacles already; allowed: no more than these", {}};
  if (const auto reason = refused_frame("header.frame_id", frame)) return *reason;
  const EditResult result = place({obstacle, frame});
  if (result.ok) added_obstacles_.insert_or_assign(result.name, AddedObstacle{std::move(obstacle), frame});
  return result;
}

/// Why no frame of that name, which the field `key` has, can be added; nothing if it can, or is there.
std::optional<EditResult> Simulation::refused_frame(const std::string& key, const std::string& frame) const {
  if (world_.frames().size() < most_frames || find_frame_id(frame) < world_.frames().size()) return std::nullopt;
  return EditResult{false,
                    key + ": " + in_quotes(frame) + "; allowed: one of the " + std::to_string(most_frames) +
                        " that were used since the last reset",
                    {}};
}

void Simulation::remove_obstacle(const std::string& name) {
  if (added_obstacles_.erase(name) > 0) world_.apply(edit::RemoveObstacle{name});
}

EditResult Simulation::place(const AddedObstacle& added) {
  Obstacle obstacle = added.obstacle;
  const std::optional<Pose> pose = started_ ? find_frame(added.frame) : std::nullopt;
  obstacle.frame = world_.add_frame(added.frame, pose);
  [[maybe_unused]] const int id = frames_.add(added.frame, stamp_);
  assert(id == obstacle.frame);
  return world_.apply(edit::SetObstacle{std::move(obstacle)});
}

void Simulation::place_added_obstacles() {
  for (const auto& [name, added] : added_obstacles_) place(added);
}

std::size_t Simulation::find_frame_id(const std::string& frame) const {
  const std::vector<std::string>& names = world_.frames();
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), frame) - names.begin());
}

}  // namespace verlet_cable
