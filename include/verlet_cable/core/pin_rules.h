#pragma once

#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// In segments of the scene: so much of a cable is between a guide and what else holds it, at first.
constexpr double guide_room = 2;
/// Whether a guide has that at `distance` [m] along a cable of such segments [m].
bool has_guide_room(double distance, double segment_length);

/// Index of what holds a node, or the junction that joins it to other cables; -1: nothing does.
int holder_of(const BodyId& body, int node, const std::vector<Attachment>& attachments);

/// A guide to which a place along a cable is too near to be pinned.
struct NearGuide {
  int attachment = -1;  ///< index; -1: there is none
  double distance = 0;  ///< [m] of cable between them
};
NearGuide guide_near(const BodyId& cable, int node, const SimulatedCable& simulated, const std::vector<Attachment>& attachments);

}  // namespace verlet_cable
