#pragma once

#include "verlet_cable/view/drawing.h"

namespace verlet_cable::view {

/// How much of the second color of stripes there is within a pixel, 0 to 1: what is finer than pixels would flicker. At an angle
/// [rad] around a tube of which a pixel shows `width` [rad].
double stripes_at(const Look& look, double angle, double width);

}  // namespace verlet_cable::view
