#pragma once

#include "keys.h"

namespace verlet_cable {

constexpr const char* pose_words = "six numbers: x, y, z [m], roll, pitch, yaw [rad]";

/// The key of a pose, or of one that may be missing.
template <class Owner, class Pose>
Key<Owner> pose_key(const std::string& name, Pose Owner::*member) {
  return {name, pose_words, false,
          [member](const Value& value, Owner& owner) { owner.*member = read_numbers<6>(value, pose_words); }};
}

/// Of a shape: its type, where it is, and the dimensions of all types.
const Keys<ShapeDesc>& shape_keys();

/// Dimensions go with their type: others are errors, and those that the type has are required, but for `scale`, `sheet` and
/// `thickness`. `given`: the keys of the map `value` that are there.
void check_dimensions(const Value& value, const std::set<std::string>& given, ShapeType type);

}  // namespace verlet_cable
