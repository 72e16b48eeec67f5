#include "interact/reach.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {
namespace {

/// Of the cable's length: the last bit would take any force.
constexpr double usable = 0.999;
/// Alternating projections onto balls whose intersection holds the node already.
constexpr int projections = 50;

}  // namespace

Vector3 within_reach(const World& world, int cable, int node, const std::string& except, const Vector3& place) {
  const CableMaterials materials(world.cables()[cable]);
  if (!materials.any_rigid()) return place;
  const std::vector<double> arc_length = world.cables()[cable].state.arc_length();
  Vector3 reached = place;
  for (int i = 0; i < projections; ++i) {
    bool inside = true;
    for (const Attachment& other : world.attachments()) {
      if (other.body != cable_id(cable) || other.name == except) continue;
      if (materials.any_elastic_between(std::min(node, other.node), std::max(node, other.node))) continue;
      const Vector3 center = (world.frame_pose(other.frame) * other.pose).position;
      const double length = usable * std::abs(arc_length[node] - arc_length[other.node]);
      const double distance = (reached - center).norm();
      if (distance <= length) continue;
      reached = center + length / distance * (reached - center);
      inside = false;
    }
    if (inside) break;
  }
  return reached;
}

}  // namespace verlet_cable
