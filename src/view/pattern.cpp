#include "pattern.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable::view {
namespace {

constexpr double far_too_fine = 50;  // [squares in a pixel]

/// The mean of a square wave of period 2, +1 and -1, over `width` around a place.
double mean_of_square_wave(double place, double width) {
  // The integral of the square wave is a triangular one.
  const auto integral = [](double at) { return std::abs(2 * (0.5 * at - std::floor(0.5 * at)) - 1); };
  return (integral(place - 0.5 * width) - integral(place + 0.5 * width)) / width;
}

}  // namespace

double checks_at(const Look& look, double x, double y, double width) {
  const double in_squares = std::max(width / look.check_size, 1e-6);
  if (in_squares >= far_too_fine) return 0.5;
  return 0.5 - 0.5 * mean_of_square_wave(x / look.check_size, in_squares) * mean_of_square_wave(y / look.check_size, in_squares);
}

double stripes_at(const Look& look, double angle, double width) {
  if (look.stripes == 0) return 0;
  const double period = 2 * M_PI / look.stripes;
  const double from_middle = std::abs(angle - period * std::round(angle / period));
  const double part = std::min(1.0, look.stripe_width / period);
  if (width >= period) return part;
  return std::clamp((0.5 * look.stripe_width - from_middle) / std::max(width, 1e-6) + 0.5, 0.0, 1.0);
}

}  // namespace verlet_cable::view
