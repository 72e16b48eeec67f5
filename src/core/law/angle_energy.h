#pragma once

namespace verlet_cable {

/// The energy of a bend by an angle is angle² / 2 = psi(u), u = 1 - cos(angle):
///   psi(u) = u + u² / 6 + 2 u³ / 45 + u⁴ / 70 + ...
/// For numbers and pairs of numbers.

/// psi(u) / u
template <class Real>
Real relative_angle_energy(const Real& u) {
  return 1.0 + u * (1.0 / 6 + u * (2.0 / 45 + u * (1.0 / 70)));
}

/// psi(u)
template <class Real>
Real angle_energy(const Real& u) {
  return u + u * u / 6.0 + 2.0 / 45 * u * u * u + 1.0 / 70 * u * u * u * u;
}

/// psi''(u)
template <class Real>
Real angle_energy_curvature(const Real& u) {
  return 1.0 / 3 + u * (4.0 / 15 + u * (6.0 / 35));
}

/// (psi(b) - psi(a)) / (b - a)
template <class Real>
Real mean_slope(const Real& a, const Real& b) {
  const Real sum = a + b, product = a * b;
  return 1.0 + sum / 6.0 + 2.0 / 45 * (sum * sum - product) + 1.0 / 70 * sum * (sum * sum - 2.0 * product);
}

}  // namespace verlet_cable
