#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/json.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_sim {

/// Of each cable over a run: the largest and smallest tension, the tightest bend, and the most twist.
class Extremes {
 public:
  void add(const World& world);
  tools::Json json() const;

 private:
  struct Extreme {
    std::optional<double> value;
    double time = 0;        ///< [s]
    double arc_length = 0;  ///< [m]
  };
  struct OfCable {
    Extreme max_tension, min_tension;  ///< [N]
    Extreme max_curvature;             ///< [1/m]
    Extreme max_twist;                 ///< [rad/m], by magnitude
  };

  std::map<std::string, OfCable> cables_;  ///< by name
  std::vector<JointView> joints_;          ///< scratch
};

}  // namespace verlet_cable::cable_sim
