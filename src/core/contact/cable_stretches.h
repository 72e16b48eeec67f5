#pragma once

#include <vector>

#include "verlet_cable/core/surface_point.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Some segments of a cable, one after the other: what is far from all of them need not be compared with each.
struct Stretch {
  int first = 0;      ///< segment
  int end = 0;        ///< behind the last one
  Aabb box;           ///< [m] around its nodes
  double radius = 0;  ///< [m] the largest one
  double speed = 0;   ///< [m/s] of the fastest node
};

/// A cable, as it is looked for near obstacles.
class CableStretches {
 public:
  void update(const SimulatedCable& cable);

  const std::vector<Stretch>& all() const { return stretches_; }
  double radius(int node) const { return radii_[node]; }  ///< [m] at a node between sections, that of the thicker one
  double speed(int node) const { return speeds_[node]; }  ///< [m/s]

 private:
  std::vector<Stretch> stretches_;
  std::vector<double> radii_, speeds_;  ///< by node
};

}  // namespace verlet_cable
