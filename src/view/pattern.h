#pragma once

#include "verlet_cable/view/drawing.h"

namespace verlet_cable::view {

/// How much of the second color of a pattern there is within a pixel, 0 to 1: what is finer than pixels would flicker.

/// At (x, y) [m] of a surface of which a pixel shows `width` [m].
double checks_at(const Look& look, double x, double y, double width);

/// At an angle [rad] around a tube of which a pixel shows `width` [rad].
double stripes_at(const Look& look, double angle, double width);

}  // namespace verlet_cable::view
