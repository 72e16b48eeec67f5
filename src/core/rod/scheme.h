#pragma once

namespace verlet_cable {

/// How a substep of h leads from places x, velocities v and accelerations a to x' = x + u, v' and a'. Motion that is much faster
/// than substeps only alternates in one that conserves energy; it needs some that damp.
///   conserving:  2 m (u / h - v) / h = forces in the middle,  v' = 2 u / h - v
///   first_order: m (u / h - v) / h = forces at the end,  v' = u / h: backward Euler, right after something abrupt
///   dissipative: b m (u / h - v) / h = forces at the end,  v' = b u / h + (1 - b) v: from forces of convex potentials it takes
///                energy, (1 / b - 1 / 2) m |v' - v|^2 and more, whatever begins or ends meanwhile, for any b from 1
///                (first_order) to 2; of what is much faster than substeps it leaves b - 1
///   damped:      2 m (u / h - v) / h = forces at the end,  v' = 3/2 u / h - v / 2 + h a / 4,  a' = (u / h - v) / h + a / 2: the
///                generalised-alpha method (Chung and Hulbert 1993) with a spectral radius of 0, of second order; it makes energy
///                of forces that begin or end within a substep
/// Where bodies and contacts join cables that would go by different ones, all go by the last of these.
enum class Scheme { conserving, damped, dissipative, first_order };

/// b of the equations of motion.
inline double inertia_of(Scheme scheme) {
  switch (scheme) {
    case Scheme::first_order:
      return 1;
    case Scheme::dissipative:
      return 1.75;
    case Scheme::conserving:
    case Scheme::damped:
      break;
  }
  return 2;
}

/// v' = displacement u / h + velocity v + acceleration h a
struct VelocityWeights {
  double displacement, velocity, acceleration;
};
inline VelocityWeights velocity_weights(Scheme scheme) {
  if (scheme == Scheme::damped) return {1.5, -0.5, 0.25};
  const double inertia = inertia_of(scheme);
  return {inertia, 1 - inertia, 0};
}

/// [m/s] In the end, of what is carried along by a surface that is displaced by `way` [m] and ends with `velocity`: it lags by
/// (1 / b - 1 / 2) h a.
template <class Vector>
Vector lagging_velocity(Scheme scheme, double h, const Vector& way, const Vector& velocity) {
  if (scheme == Scheme::damped) return velocity;
  const double lag = 2 / inertia_of(scheme) - 1;
  return (1 - lag) * velocity + lag / h * way;
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
