#pragma once

#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Smallest length of cable between a guide and whatever else holds the cable at the start, in segments of the scene.
constexpr double guide_room = 2;
/// Whether `distance` [m] along a cable with segments of `segment_length` [m] is enough for that.
bool has_guide_room(double distance, double segment_length);

/// Index of the attachment that holds a node, or joins it to a junction; -1: nothing holds it.
int holder_of(const BodyId& body, int node, const std::vector<Attachment>& attachments);

/// A guide that is too near to a node for that node to be pinned.
struct NearGuide {
  int attachment = -1;  ///< index; -1: there is none
  double distance = 0;  ///< [m] of cable between them
};
NearGuide guide_near(const BodyId& cable, int node, const SimulatedCable& simulated, const std::vector<Attachment>& attachments);

}  // namespace verlet_cable
