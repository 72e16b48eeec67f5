#pragma once

#include <vector>

#include "target/boundary.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Whether one holder alone holds the cable, with a free end on each side.
bool is_held_between_ends(const std::vector<HeldNode>& held, const CableState& state);

/// Where a cable that hangs may be folded. A fold has no side to which it falls open: what is to settle from there has none.
enum class Folds {
  anywhere,
  at_holders,  ///< where clamps turn it
  nowhere      ///< one that is held in between its ends alone is spread out to both sides
};

/// Puts a cable, whose `state` has its lengths and masses, into its initial shape and motion (`desc.initial`), its held nodes
/// where their holders are (`held`, ascending), its lengths kept if it is inextensible; velocities are those given, not
/// projected. `gravity` [m/s^2] says where cables hang. False if a shape that was given could not be brought to its lengths
/// there, so that it hangs instead.
bool set_initial_state(const InitialShapeDesc& initial, Folds folds, const CableModel& model, const std::vector<HeldNode>& held,
                       const Vector3& gravity, CableState& state);

/// Carries a cable along with holders that have jumped: each node by the jump of its neighbouring holders, in proportion to the
/// arc length between them. Where that leaves no shape of the right lengths nearby, the cable hangs from them anew: false. With
/// a free end it keeps its directions instead.
bool carry_along(const CableModel& model, const std::vector<HeldNode>& held, const Vector3& gravity, CableState& state);

/// The same after a jump of holders: elastic cables are as long as before, too, where that is possible.
void carry_with_targets(const CableModel& model, const std::vector<HeldNode>& held, const Vector3& gravity, CableState& state);

/// Hangs a cable from its holders, whatever its shape was.
void hang_anew(const CableModel& model, const std::vector<HeldNode>& held, const Vector3& gravity, CableState& state);

/// Whether a cable starts in static equilibrium: also if it is given no shape, and a clamp turns it away from its catenary, or
/// what holds it in between its ends alone would fold it.
bool settles_at_start(const CableDesc& desc, const CableModel& model, const CableState& state);

/// Gives the segments of an inextensible cable the lengths that its holders allow, after a holder that had lengthened it let go:
/// from the first holder on, or the middle of a free cable, along the directions that they have.
void restore_lengths(const CableModel& model, const std::vector<HeldNode>& held, const Vector3& gravity, CableState& state);

}  // namespace verlet_cable
