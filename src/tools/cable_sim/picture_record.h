#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/json.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_sim {

/// What the pictures of a run are drawn from: where everything is, and what attachments bear, at times that are evenly spaced and
/// as few as a picture can show.
class PictureRecord {
 public:
  /// Of a run of so many steps that begins with `world`. `title`: above the pictures.
  PictureRecord(const World& world, const std::string& title, std::int64_t steps);

  /// After each step.
  void add(const World& world);
  /// As src/python/verlet_cable/plot.py reads it.
  std::string json() const { return json_.dump(-1, ' ', false, tools::Json::error_handler_t::replace); }

 private:
  void add_frame(const World& world);
  void add_forces(const World& world);

  std::int64_t steps_;
  std::int64_t steps_a_frame_;
  std::int64_t steps_a_force_;
  tools::Json json_;
  std::map<std::string, Vector3> sums_;  ///< [N] of forces since the last that were added
  std::int64_t summed_ = 0;              ///< [steps]
};

}  // namespace verlet_cable::cable_sim
