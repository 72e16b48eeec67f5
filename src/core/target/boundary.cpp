#include "target/boundary.h"

#include <algorithm>
#include <limits>

#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// Further apart than this is worth a report [relative]: cables that are taut may be strained by a tenth of it.
constexpr double reported_stretch = 1e-6;
/// Of places far from the origin, which is no stretch [relative].
constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();

}  // namespace

bool Boundary::is_on_bodies() const {
  return std::any_of(nodes.begin(), nodes.end(), [](const HeldNode& held) { return held.body >= 0; });
}

void HolderMotion::clear() {
  std::fill(displacements.begin(), displacements.end(), Vector3::Zero());
  std::fill(rotations.begin(), rotations.end(), Vector3::Zero());
  for (PointLoad& load : loads) load.force.setZero();
}

int reachable_lengths(const CableModel& model, const CableState& state, const std::vector<HeldNode>& held, DrawnOut drawn_out,
                      std::vector<double>& lengths) {
  for (int i = 0; i < state.segments(); ++i) lengths[i] = state.rest_lengths[i];
  const CableMaterials materials(model, state);
  if (!materials.any_rigid()) return -1;
  int overstretched = -1;
  std::size_t next = 0;
  for (std::size_t k = 0; k + 1 < held.size(); k = next) {
    // On to the next holder that the cable does not slide through; junctions are drawn along.
    bool gives_way = held[k].body >= 0;
    double distance = 0, start_distance = 0;
    const HeldNode* last_place = &held[k];
    for (next = k + 1;; ++next) {
      const HeldNode& node = held[next];
      if (!node.at_junction) {
        distance += (node.position - last_place->position).norm();
        start_distance += (state.positions[node.node] - state.positions[last_place->node]).norm();
        last_place = &node;
        gives_way = gives_way || node.body >= 0;
      }
      if (!(node.slides || node.at_junction) || next + 1 == held.size()) break;
    }
    if (held[k].slides || held[next].slides || held[next].at_junction) continue;
    const int first = held[k].node, last = held[next].node;
    if (materials.any_elastic_between(first, last)) continue;
    const double rest_length = state.length(first, last);
    const double rounded = rounding * held[k].position.cwiseAbs().maxCoeff();
    if (gives_way) distance = start_distance;
    const bool is_reported = !gives_way || drawn_out.is_reported;
    if (is_reported && distance > rest_length * (1 + reported_stretch) + rounded && overstretched < 0) overstretched = first;
    if (gives_way) distance -= drawn_out.drawn_in;
    const double stretch = distance / rest_length;
    if (stretch <= 1) continue;
    for (int i = first; i < last; ++i) lengths[i] *= stretch;
  }
  return overstretched;
}

}  // namespace verlet_cable
