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

/// The same of a span from what holds a cable to an end that nothing holds, or from end to end, which what it touches presses
/// together: where it would buckle within the substep under the tension that this has found, it is folded a little, and the
/// substep is to be tried again. Else what cannot stretch would go straight through the floor. Whether there was any.
bool fold_pressed_columns(const Participant& p, const std::vector<Touch>& touches, State& state);

/// The same where holders have jumped together: the cable takes a bow between them, before it is carried along.
void carry_straight_columns(int cable, State& state);

/// The same where holders stand: what would buckle takes a bow. Whether there was any.
bool bend_straight_columns(int cable, State& state);

}  // namespace verlet_cable
