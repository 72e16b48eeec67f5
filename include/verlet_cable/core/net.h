#pragma once

#include <array>
#include <string>
#include <vector>

#include "verlet_cable/core/cable.h"
#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// The part of a net that no step changes.
struct NetModel {
  std::string name;
  std::array<double, 4> color{0.7, 0.2, 0.1, 1.0};
  int rows = 0, columns = 0;  ///< of a grid, 0 if there is none; node = row * columns + column
  LinkType link_type = LinkType::spring;
  double stiffness = 0;                   ///< [N/m] 0 for rigid links
  double damping = 0;                     ///< [N s/m] 0 for rigid links
  double tolerance = 0;                   ///< limited: largest |l / l0 - 1|
  double restitution = 0, friction = 0;   ///< of bounces off obstacles
  std::vector<double> masses;             ///< [kg] a node
  std::vector<std::array<int, 2>> links;  ///< nodes; of a grid: all horizontal, all vertical, then both diagonals, row by row
  std::vector<double> rest_lengths;       ///< [m] a link
  std::vector<MinimumDistanceDesc> minimum_distances;

  int nodes() const { return static_cast<int>(masses.size()); }
  bool is_grid() const { return rows > 1 && columns > 1; }
};

/// The part of a net that steps change. Written by World only.
struct NetState {
  std::vector<Vector3> positions;   ///< [m] a node
  std::vector<Vector3> velocities;  ///< [m/s] a node, at the time of the positions
  std::vector<double> tension;      ///< [N] a link, > 0 is tension; mean over the last step
};

struct SimulatedNet {
  NetModel model;
  NetState state;
};

/// A free material point.
struct SimulatedParticle {
  ParticleDesc desc;
  Vector3 position = Vector3::Zero();  ///< [m]
  Vector3 velocity = Vector3::Zero();  ///< [m/s] at the time of the position
};

double strain(const SimulatedNet& net, int link);           ///< l / l0 - 1
std::vector<double> node_tension(const SimulatedNet& net);  ///< [N] a node: the largest of the links at it, 0 without links
int nearest_node(const SimulatedNet& net, const Vector3& point);

/// The link of a net nearest to a point; `segment` is the index of the link, -1 if the net has no links.
NearestPoint nearest_link(const SimulatedNet& net, const Vector3& point);

}  // namespace verlet_cable
