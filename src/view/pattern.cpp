#include "pattern.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable::view {
double stripes_at(const Look& look, double angle, double width) {
  if (look.stripes == 0) return 0;
  const double period = 2 * M_PI / look.stripes;
  const double from_middle = std::abs(angle - period * std::round(angle / period));
  const double part = std::min(1.0, look.stripe_width / period);
  if (width >= period) return part;
  return std::clamp((0.5 * look.stripe_width - from_middle) / std::max(width, 1e-6) + 0.5, 0.0, 1.0);
}

}  // namespace verlet_cable::view
