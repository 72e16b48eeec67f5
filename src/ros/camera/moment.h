#pragma once

#include <verlet_cable/Appearance.h>
#include <verlet_cable/CableArray.h>

namespace verlet_cable {

/// What a cable node has published at one simulated time.
struct Moment {
  CableArrayConstPtr state;
  AppearanceConstPtr appearance;  ///< none where nobody publishes it: of a bag that does not have it
};

}  // namespace verlet_cable
