#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable::bench {

/// A chain that every engine is given alike: inextensible, undamped, its start held at the origin.
struct RopeTask {
  int segments = 0;
  double length = 1;               ///< [m]
  double mass = 0.1;               ///< [kg], evenly spread over the segments, half of each on its nodes
  std::vector<Vector3> positions;  ///< [m] at the start, at rest; a node, segments + 1
  /// Where the last node is held at a time [s]; empty: it is free.
  std::function<Vector3(double)> hand;
  bool numerical_damping = true;  ///< of the package, see SceneDesc

  double node_mass(int node) const { return mass / segments * (node == 0 || node == segments ? 0.5 : 1); }
  double energy_scale() const { return mass * 9.81 * length; }  ///< m g L [J]
};

RopeTask released_from_horizontal(int segments);
/// Hangs between the origin and `driven_hand`.
RopeTask driven(int segments);

/// One engine at one setting.
class Rope {
 public:
  virtual ~Rope() = default;
  virtual void advance() = 0;  ///< by one step; by 10 ms for engines that choose their steps
  virtual double time() const = 0;
  /// [m], [m/s] a node
  virtual void observe(std::vector<Vector3>& positions, std::vector<Vector3>& velocities) const = 0;
};

/// A setting to be tried.
struct Candidate {
  std::string name;
  std::function<std::unique_ptr<Rope>()> make;
};

std::vector<Candidate> cable_candidates(const RopeTask& task);
/// From the cheapest a simulated second to the most expensive.
std::vector<Candidate> bullet_candidates(const RopeTask& task);
std::vector<Candidate> simbody_candidates(const RopeTask& task);

}  // namespace verlet_cable::bench
