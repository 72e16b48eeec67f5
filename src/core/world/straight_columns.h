#pragma once

#include <vector>

#include "contact/law.h"
#include "rod/participant.h"
#include "world/state.h"

namespace verlet_cable {

/// What is pushed together along an exactly straight line would stay on it, in an equilibrium that does not last; no cable is so
/// straight. To be called when its holders' next places are known. Spans between holders that are not bodies, and that no
/// material slides through:
/// * One that cannot stretch, and is longer than its holders will be apart, takes a bow that has room there, without getting any
///   velocity by that: it would be the greater the shorter the step is.
/// * One that can stretch, and would buckle under the load that it carries between its holders, gets velocities across it, whose
///   energy is a tiny part of what is stored in its compression: from there it buckles by itself.
void buckle_straight_columns(int cable, State& state);

/// A span from what holds a cable to an end that nothing holds, or from end to end, which what it touches presses together.
struct PressedColumn {
  int first = 0, last = 0;  ///< nodes
  bool held_at_last = false;
  std::vector<double> shape;  ///< in which it buckles: nodes, across it, of any size
};

/// Those that would buckle within the substep under the tension that this has found. They are to be folded, and the substep to be
/// tried again: else what cannot stretch would go straight through the floor.
std::vector<PressedColumn> find_pressed_columns(const Participant& p, const std::vector<Touch>& touches, const State& state);
/// Folds one of a cable a little, without changing its length.
void fold(const PressedColumn& column, int cable, State& state);

/// The same where holders have jumped together: the cable takes a bow between them, before it is carried along.
void carry_straight_columns(int cable, State& state);

/// The same where holders stand: what would buckle takes a bow. Whether there was any.
bool bend_straight_columns(int cable, State& state);

}  // namespace verlet_cable
