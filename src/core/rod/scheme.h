#pragma once

namespace verlet_cable {

/// How a substep of h leads from places x, velocities v and accelerations a to x' = x + u, v' and a'. Motion that is much faster
/// than substeps only alternates in one that conserves energy; it needs some that damp.
///   conserving:  2 m (u / h - v) / h = forces in the middle,  v' = 2 u / h - v
///   first_order: m (u / h - v) / h = forces at the end,  v' = u / h: backward Euler, right after something abrupt
///   damped:      2 m (u / h - v) / h = forces at the end,  v' = 3/2 u / h - v / 2 + h a / 4,  a' = (u / h - v) / h + a / 2: the
///                generalised-alpha method (Chung and Hulbert 1993) with a spectral radius of 0, of second order
enum class Scheme { conserving, first_order, damped };

/// v' = displacement u / h + velocity v + acceleration h a
struct VelocityWeights {
  double displacement, velocity, acceleration;
};
inline VelocityWeights velocity_weights(Scheme scheme) {
  switch (scheme) {
    case Scheme::first_order:
      return {1, 0, 0};
    case Scheme::damped:
      return {1.5, -0.5, 0.25};
    case Scheme::conserving:
      break;
  }
  return {2, -1, 0};
}

/// The mean over a substep of what a force does to velocities. Those of damped substeps go on from the accelerations at the
/// start: `lasting` is the force that these come of, and then that of the accelerations at the end.
template <class Vector>
Vector mean_force(Scheme scheme, const Vector& force, Vector& lasting) {
  if (scheme != Scheme::damped) return lasting = force;
  // Of u / h - v = h force / (2 m) and a = lasting / m.
  const VelocityWeights weights = velocity_weights(scheme);
  const Vector mean = 0.5 * weights.displacement * force + weights.acceleration * lasting;
  lasting = 0.5 * (force + lasting);
  return mean;
}

}  // namespace verlet_cable
