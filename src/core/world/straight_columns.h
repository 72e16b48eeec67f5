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

/// What is to become of a substep whose solution may be one that does not last.
enum class GivesWay {
  no,       ///< it lasts
  anew,     ///< it is to be solved again, as columns have been bent
  shorter,  ///< a shorter one is to be solved instead
};

/// Whether a cable that touches something, or that bodies hold, would buckle within the substep under the tension that this has
/// found: the motion is then none that lasts, but a saddle, as those of columns that are pressed together on a line. What is
/// exactly straight is bent, across itself alone: as much as the substep has room for, where it is pressed suddenly, without
/// getting any velocity by that; else a seed is enough.
GivesWay gives_way(const Participant& p, const std::vector<Touch>& touches, State& state);

/// The same where holders have jumped together: the cable takes a bow between them, before it is carried along.
void carry_straight_columns(int cable, State& state);

/// The same where holders stand: what would buckle takes a bow. Whether there was any.
bool bend_straight_columns(int cable, State& state);

}  // namespace verlet_cable
