#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "edit_requests/checked_pin.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

// Edits of what requests name. Those that are refused change nothing, and say why; those that are done say what they did.

/// An edit, and where it was.
struct PlacedEdit {
  EditResult result;
  int node = 0;  ///< cut: the segment of a cable, or the node of a net; join: where the cables meet
};

/// The frame is added where the world does not know it. No name: one is made.
EditResult apply_pin(World& world, const std::string& name, const CheckedPin& pin, AttachmentType type);

EditResult apply_unpin(World& world, const std::string& name);

/// The attachment's new pose in its frame, a quaternion of zeros for no rotation: the next step takes what it holds there.
EditResult apply_move(World& world, const std::string& name, const Pose& offset);

/// Removes a segment of a cable, or links of a net, which `locate_cut` has found.
PlacedEdit apply_cut(World& world, const Location& place);

/// The length in m, the speed in m/s, the tension in N.
EditResult apply_set_length(World& world, const std::string& cable, bool at_end, double length, double speed,
                            double max_tension = 0, const RequestWords& words = service_words());

/// See edit::SetTension, whose index of the cable `cable` stands for.
EditResult apply_set_tension(World& world, const std::string& cable, edit::SetTension change,
                             const RequestWords& words = service_words());

/// What is asked for of a cable, a body or a guide; see edit::SetState.
struct NamedState {
  std::string name;
  std::optional<std::vector<Vector3>> positions, velocities;  ///< of a cable
  std::optional<Pose> pose;                                   ///< of a body
  std::optional<std::array<Vector3, 2>> twist;                ///< likewise: [m/s], [rad/s]
  std::optional<double> arc_length;                           ///< of a guide
};

/// All at once. `unknown`: set where only names that nothing has are wrong.
EditResult apply_set_state(World& world, const std::vector<NamedState>& states, bool& unknown,
                           const RequestWords& words = service_words());

PlacedEdit apply_join(World& world, const std::string& first, bool first_at_end, const std::string& second, bool second_at_end,
                      const RequestWords& words = service_words());

/// The refusal of a name that no attachment has.
EditResult refused_attachment(const World& world, const std::string& name);

}  // namespace verlet_cable
