#pragma once

#include <vector>

#include "rod/lateral_stiffness.h"

namespace verlet_cable {

/// A span between ends that are closer than it is long.
struct Bow {
  /// Nodes of the span: along the line from end to end, and across it [m]. Its segments have their lengths.
  std::vector<double> along, across;
};

/// [half waves] In which a span that cannot stretch gives way to ends that come together suddenly, in a time [s]: of the modes k
/// of deflection a, with 4 L s = (k pi a)^2 for a slack s, the one with the least energy of bending and motion,
///   EI (k pi / L)^2 s + m L s / (2 pi k t)^2,
/// where segments can show it (Lavrentiev and Ishlinsky, Dynamic forms of loss of stability of elastic systems, 1949).
double waves_of_sudden_bow(const CableModel& model, const CableState& state, const StraightSpan& span, double time);

/// Ends at `distance` [m], less than the span is long: half of the slack is in the mode that bends least, half in that of so many
/// half waves. Segments are turned by the slopes of these modes, which leads to any distance.
Bow find_bow(const CableState& state, const StraightSpan& span, double distance, double waves);

}  // namespace verlet_cable
