#pragma once

#include "scene/scene_errors.h"

namespace verlet_cable {

inline bool is_sound(const CableDesc& cable, const PlaceDesc& place) {
  return place.at != PlaceDesc::At::arc_length || (place.arc_length >= 0 && place.arc_length <= cable.length);
}

/// False where a place is beyond the cable's ends, which is an error then.
inline bool check_place(const std::string& key, const CableDesc& cable, const PlaceDesc& place, Errors& errors) {
  if (is_sound(cable, place) || !cable_fields[0].range.contains(cable.length)) return true;
  errors.add(key, number_text(place.arc_length),
             "start, end, or an arc length [m] from 0 to the cable's length " + number_text(cable.length));
  return false;
}

}  // namespace verlet_cable
