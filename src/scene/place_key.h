#pragma once

#include "keys.h"

namespace verlet_cable {

constexpr const char* place_words = "start, end, or an arc length [m] from 0 to the cable's length";

/// The key `at` of a place on a cable.
template <class Owner, class Place>
Key<Owner> place_key(Place Owner::*member, bool required) {
  return {"at", place_words, required, [member](const Value& value, Owner& owner) {
            PlaceDesc place;
            if (value.node.IsScalar() && value.node.Scalar() == "start") {
              place.at = PlaceDesc::At::start;
            } else if (value.node.IsScalar() && value.node.Scalar() == "end") {
              place.at = PlaceDesc::At::end;
            } else {
              place = {PlaceDesc::At::arc_length, read_number(value, place_words)};
            }
            owner.*member = place;
          }};
}

}  // namespace verlet_cable
