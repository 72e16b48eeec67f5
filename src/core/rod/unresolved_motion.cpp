#include "rod/unresolved_motion.h"

#include <algorithm>
#include <cmath>

#include "rod/rigid_motion.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// Cosine of the phase a substep below which motion is not resolved: of a frequency times the substep of 2.7. From 3.5 on (-0.5)
/// taking out what alternates always lowers the energy; below, no more than that is taken out.
constexpr double least_cosine = -0.3;
/// The same where substeps will damp, of changes instead of turns: of a frequency times the substep of 2. A little less, as a
/// first blow has no phase, but what rounding makes of it.
constexpr double least_cosine_damped = -0.02;
/// How much of what was seen is remembered from one substep to the next: longer than a turning point of a motion lasts.
constexpr double memory = 0.8;
/// [m/s^2] Changes of less from one substep to the next go unnoticed: of the tension by a thousandth of the weight.
constexpr double noticed_change = 0.01;

}  // namespace

Scheme next_scheme(const CableModel& model, const CableState& state) {
  const UnresolvedMotion& motion = state.unresolved;
  if (motion.damped == 0) return Scheme::conserving;
  // The generalised-alpha method leads back to velocities of second order, but overshoots where an elastic cable is let go.
  if (motion.damped == damped_substeps || CableMaterials(model, state).any_elastic()) return Scheme::first_order;
  return motion.damped == 1 ? Scheme::damped : Scheme::dissipative;
}

void begin_anew(UnresolvedMotion& motion) {
  std::fill(motion.acceleration_changes.begin(), motion.acceleration_changes.end(), Vector3::Zero());
  std::fill(motion.turns.begin(), motion.turns.end(), Vector3::Zero());
  motion.changed = motion.turned = 0;
  motion.known = motion.damped = 0;
}

void MotionCleaner::resize(int nodes) {
  alternating_.assign(nodes, 0.0);
}

bool is_unresolved(Treatment treatment, const MotionSums& sums, UnresolvedMotion& motion) {
  if (motion.damped > 0) --motion.damped;
  if (motion.known < 2) {
    ++motion.known;
    return false;
  }
  motion.changed = memory * motion.changed + sums.square;
  motion.turned = memory * motion.turned + sums.product;
  const double least = treatment == Treatment::damping ? least_cosine_damped : least_cosine;
  const bool unresolved = motion.turned < least * motion.changed && motion.changed > noticed_change * noticed_change * sums.mass;
  if (unresolved) motion.changed = motion.turned = 0;
  return unresolved;
}

double losing_share(double known, double along, double square) {
  if (known + along >= square) return 1;
  const double root = std::sqrt(along * along + 4 * square * known);
  return along < 0 ? 2 * known / (root - along) : (along + root) / (2 * square);
}

bool MotionCleaner::finds_unresolved(Treatment treatment, const std::vector<double>& movable, const VectorArray& before,
                                     CableState& state) {
  UnresolvedMotion& motion = state.unresolved;
  const bool damps = treatment == Treatment::damping;
  const double known = known_part(motion);
  MotionSums sums;
  for (int i = 0; i < state.nodes(); ++i) {
    const Vector3 change = state.accelerations[i] - get(before, i);
    const Vector3 turn = known * (change - motion.acceleration_changes[i]);
    const double weight = movable[i] * state.masses[i];
    const Vector3 now = damps ? change : turn, last = damps ? motion.acceleration_changes[i] : motion.turns[i];
    sums.product += weight * now.dot(last);
    sums.square += 0.5 * weight * (now.squaredNorm() + last.squaredNorm());
    sums.mass += weight;
    motion.acceleration_changes[i] = change;
    motion.turns[i] = turn;
  }
  return is_unresolved(treatment, sums, motion);
}

void MotionCleaner::load(double h, const CableModel& model, const CableState& state, const std::vector<double>& inertia,
                         const VectorArray& segment, const VectorArray& end_velocity, const std::vector<double>& growth,
                         KktSystem& system) {
  for (int i = 0; i < state.nodes(); ++i) set(alternating_, i, system.movable[i] * 0.25 * h * state.unresolved.turns[i]);
  for (int i = 0; i < state.nodes(); ++i) set(system.load, i, inertia[i] * get(alternating_, i));
  const CableMaterials materials(model, state);
  for (int i = 0; i < state.segments(); ++i) {
    const Vector3 kept = get(end_velocity, i + 1) - get(end_velocity, i) - get(alternating_, i + 1) + get(alternating_, i);
    system.gap[i] = is_elastic(materials[i]) ? 0 : growth[i] - get(segment, i).dot(kept);
  }
}

double MotionCleaner::take_out(double h, double work, const std::vector<HeldNode>& held, const VectorArray& solution,
                               const VectorArray& place, CableState& state) {
  const int nodes = state.nodes();
  for (int i = 0; i < nodes; ++i) set(alternating_, i, get(alternating_, i) - get(solution, i));
  if (held.empty()) keep_momenta(state.masses, place);
  double along = work, square = 0;
  for (int i = 0; i < nodes; ++i) {
    const Vector3 w = get(alternating_, i);
    along += state.masses[i] * w.dot(state.velocities[i]);
    square += 0.5 * state.masses[i] * w.squaredNorm();
  }
  const double share = losing_share(0, along, square);
  for (int i = 0; i < nodes; ++i) {
    const Vector3 w = share * get(alternating_, i);
    state.velocities[i] -= w;
    state.accelerations[i] -= 2 / h * w;
    state.unresolved.acceleration_changes[i] -= 4 / h * w;
    state.unresolved.turns[i] -= 4 / h * w;
  }
  return share;
}

/// Takes what a rigid body's motion would be out of w.
void MotionCleaner::keep_momenta(const std::vector<double>& masses, const VectorArray& place) {
  const Vector3 center = center_of_mass(masses, place);
  Vector3 momentum = Vector3::Zero(), angular_momentum = Vector3::Zero();
  const int nodes = static_cast<int>(masses.size());
  for (int i = 0; i < nodes; ++i) {
    const Vector3 p = masses[i] * get(alternating_, i);
    momentum += p;
    angular_momentum += (get(place, i) - center).cross(p);
  }
  const RigidMotion rigid = rigid_motion(masses, place, momentum, angular_momentum);
  for (int i = 0; i < nodes; ++i) set(alternating_, i, get(alternating_, i) - rigid.at(get(place, i)));
}

}  // namespace verlet_cable
