#pragma once

#include <cmath>
#include <complex>

/// Buckling of a straight twisted rod of length 1 and EI = 1 between two clamps. (Love, A Treatise on the Mathematical Theory of
/// Elasticity, 1927, section 272; van der Heijden and Thompson, Helical and localised buckling in twisted rods, 2000.) With
/// w = y + i z the deflection: w'''' - i M w''' - T w'' = 0, so w = A + i B s + C exp(i a s) + D exp(i b s), where a and b are
/// the roots of a^2 - M a + T = 0. About the middle, s = 0, y is even and z is odd; w and w' vanish at s = 1/2.
namespace verlet_cable::analytic {

struct TwistedRod {
  double torque = 0;  ///< M at which it buckles
  double a = 0, b = 0;

  /// The buckled shape y + i z at s, -1/2 to 1/2, to a factor.
  std::complex<double> shape(double s) const {
    const double c = b * std::sin(0.5 * b), d = -a * std::sin(0.5 * a);
    const auto even = [&](double at) { return c * std::cos(a * at) + d * std::cos(b * at); };
    const auto odd = [&](double at) { return c * std::sin(a * at) + d * std::sin(b * at); };
    return {even(s) - even(0.5), odd(s) - 2 * s * odd(0.5)};
  }
};

/// `tension`: T > 0. The lowest torque, by bisection of the condition that B, C and D are not all zero.
inline TwistedRod twisted_rod(double tension) {
  const auto roots = [tension](double torque) {
    const double middle = 0.5 * torque, half_gap = std::sqrt(std::max(0.0, middle * middle - tension));
    return TwistedRod{torque, middle + half_gap, tension / (middle + half_gap)};
  };
  const auto determinant = [&roots](double torque) {
    const TwistedRod r = roots(torque);
    const double sine_a = std::sin(0.5 * r.a), sine_b = std::sin(0.5 * r.b);
    return r.a * sine_a * (sine_b - 0.5 * r.b * std::cos(0.5 * r.b)) - r.b * sine_b * (sine_a - 0.5 * r.a * std::cos(0.5 * r.a));
  };
  const double lowest = 2 * std::sqrt(tension), interval = 0.01;  // where a = b the condition is met by no shape
  double low = lowest * (1 + 1e-6), high = low + interval;
  while ((determinant(low) < 0) == (determinant(high) < 0)) {
    low = high;
    high += interval;
  }
  const bool sign = determinant(low) < 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    ((determinant(middle) < 0) == sign ? low : high) = middle;
  }
  return roots(low);
}

/// Torque at buckling without tension: the first root of tan(M / 2) = M / 2.
constexpr double untensioned_buckling_torque = 8.986818915818128;

}  // namespace verlet_cable::analytic
