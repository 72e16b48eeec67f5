#pragma once

#include <vector>

#include "target/boundary.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// The shapes that a cable had between what holds it, to be given to it again once its holders are elsewhere, or its spans have
/// other lengths and other nodes: a span is carried along with its ends, and made flatter or deeper until it is straight, or as
/// long as its material is, strained as it was; a free end is longer or shorter where it is held. So its segments have their
/// lengths, whatever material guides let through. Spans of which nothing has changed stay as they were.
class SpanShapes {
 public:
  /// `held`: ascending; at least one.
  SpanShapes(const std::vector<HeldNode>& held, const CableState& state);

  /// `held`: the same holders in the same order. A span that was straight, and has slack now, hangs by `gravity` [m/s^2].
  void apply(const CableModel& model, const std::vector<HeldNode>& held, const Vector3& gravity, CableState& state) const;

 private:
  struct Span {
    std::vector<Vector3> points;       ///< [m] the nodes, with both ends
    std::vector<double> rest_lengths;  ///< [m]
  };

  std::vector<Span> spans_;  ///< before the first holder, between each two, after the last one
};

/// Lays a cable straight between what holds it, and its ends straight on: nodes that guides take in then lose no length.
void lay_straight(const std::vector<HeldNode>& held, CableState& state);

}  // namespace verlet_cable
