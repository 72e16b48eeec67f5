#include "contact/contact_solver.h"

#include <algorithm>
#include <cmath>

#include "chain/node_sums.h"
#include "chain/point_motion.h"
#include "geometry/segment_geometry.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

constexpr int contact_iterations = 60;
/// Error of a node's velocity at which an iteration ends, in segment lengths per second.
constexpr double velocity_tolerance = 4e-3;
/// Less where cables and bodies exchange momentum.
constexpr double passing_part = 1e-2;
/// Bodies are as much more accurate, in parts of their sizes.
constexpr double body_accuracy = 30;
constexpr double fastest_convergence = 0.1;
constexpr double slow_convergence = 0.2;
/// Where friction turns round slowly, a larger error is as good after so many iterations.
constexpr int patient_iterations = 6;
constexpr double impatience = 20;
/// Normal forces that friction has not followed by then bound it as they are.
constexpr int following_iterations = 20;
/// A correction may turn the forces along it round to this part of what they were.
constexpr double turned_round = 0.5;
constexpr int maximum_shortenings = 8;
/// Energy is negligible where it is this part of what moves a segment by no more than is tolerated.
constexpr double negligible_part = 0.1;
/// In radii: what is no deeper in each other than by one and moves by less passes through nothing.
constexpr double short_way = 0.5;

int nodes(const Participant& p) {
  return p.state->nodes();
}

int segments(const Participant& p) {
  return p.state->segments();
}

/// Of solving for a cable once, see `budget`.
double work_of_visiting(const Participant& p) {
  return visiting_work(segments(p), static_cast<double>(p.substep.boundary.flows.size()));
}

bool joins_cables(const Touch& touch) {
  return touch.other.cable >= 0;
}

}  // namespace

inline Participant& ContactSolver::at(std::vector<Participant>& participants, const CablePoint& point) const {
  return participants[index_[point.cable]];
}

/// w of the present iterate [m].
inline Vector3 ContactSolver::displacement_of(Touch& touch, std::vector<Participant>& participants) const {
  const Participant& p = at(participants, touch.point);
  const VectorArray& displacement = p.stepper->displacement();
  const Vector3 own = at_point(touch.point, displacement);
  if (touch.body >= 0) {
    const auto displaced = [&](int i) { return get(displacement, i); };
    touch.turning =
        turning_arm(touch.point, [&](int i) -> Vector3 { return p.state->positions[i] + p.substep.part() * displaced(i); });
    return bodies_->contacts().follow(own, on_centre_line(touch.point, displaced), touch);
  }
  if (!joins_cables(touch)) return own;
  return own - at_point(touch.other, at(participants, touch.other).stepper->displacement());
}

bool ContactSolver::solve(std::vector<Participant>& participants, std::vector<Touch>& touches, BodySystem* bodies,
                          double most_work) {
  bodies_ = bodies;
  work_ = {};
  work_.most = most_work;
  begin(participants);
  return iterate(participants, touches);
}

void ContactSolver::begin(std::vector<Participant>& participants) {
  coupled_.begin(participants.size());
  for (std::size_t k = 0; k < participants.size(); ++k) {
    Participant& p = participants[k];
    if (static_cast<int>(index_.size()) <= p.cable) index_.resize(p.cable + 1);
    index_[p.cable] = static_cast<int>(k);
    *p.result = {};
    p.stepper->begin(p.substep, *p.state, *p.result);
    work_.size += work_of_visiting(p);
  }
}

void ContactSolver::finish(std::vector<Participant>& participants, std::vector<Touch>& touches) const {
  // After the last correction: what is left out at each substep would be creep.
  for (Touch& touch : touches)
    if (touch.mode != Touch::Mode::open) follow_correction(displacement_of(touch, participants), touch);
  if (bodies_ != nullptr) {
    bodies_->contacts().follow_obstacles();
    bodies_->place_at_end(participants);
  }
  for (Participant& p : participants) p.stepper->finish(p.substep, true, *p.state, *p.result);
}

bool ContactSolver::crosses(const std::vector<Participant>& participants, const std::vector<Touch>& touches) const {
  return std::any_of(touches.begin(), touches.end(), [&](const Touch& touch) {
    if (!joins_cables(touch)) return false;
    const Participant &a = participants[index_[touch.point.cable]], &b = participants[index_[touch.other.cable]];
    const int i = touch.point.segment, j = touch.other.segment;
    const auto way = [](const Participant& p, int segment) {
      const VectorArray& u = p.stepper->displacement();
      return std::sqrt(std::max(get(u, segment).squaredNorm(), get(u, segment + 1).squaredNorm()));
    };
    if (way(a, i) + way(b, j) < short_way * touch.radius && !touch.inside && touch.gap > -touch.radius) return false;
    const auto end = [](const Participant& p, int node) -> Vector3 {
      return p.state->positions[node] + get(p.stepper->displacement(), node);
    };
    const Vector3 a0 = end(a, i), b0 = end(b, j);
    return closest_points(a0, end(a, i + 1) - a0, b0, end(b, j + 1) - b0).between.dot(touch.normal) < 0;
  });
}

/// Newton's method on the places, tensions and contacts of all. Contacts are stiff on one side and nothing on the other, so that
/// whole corrections may jump to and fro between them: each is shortened until the forces along it have no more than half turned
/// round.
bool ContactSolver::iterate(std::vector<Participant>& participants, std::vector<Touch>& touches) {
  const double h = participants.empty() ? bodies_->substep() : participants.front().substep.h;
  const bool passes_momentum =
      std::any_of(touches.begin(), touches.end(), [](const Touch& touch) { return touch.body >= 0 || joins_cables(touch); });
  const double tolerance = velocity_tolerance * std::min(h, longest_tolerated);
  double tolerated = infinity;          // [m] of a node
  double negligible_energy = infinity;  // [J] moves no node by more than that
  for (const Participant& p : participants) {
    const double moved = tolerance * p.state->rest_lengths.front();
    tolerated = std::min(tolerated, moved);
    const double mass = p.state->rest_lengths.front() * CableMaterials(p.substep.model, *p.state)[0].linear_density;
    negligible_energy = std::min(negligible_energy, negligible_part * mass * moved * moved / (h * h));
  }
  double told = 0;      // [J] if that much is missing, beside a part of the work
  double expected = 0;  // [J] to be missing, after the last iterate
  for (const Participant& p : participants) told += p.stepper->told_energy(p.substep, *p.state);
  double last = 0;
  bool stale = true;
  for (int i = 0; i < contact_iterations && work_.is_left(); ++i) {
    work_.spend(budget::heavy, touches.size());
    if (i == following_iterations) hold_bounds(touches);
    const bool changed = i == 0 ? press(participants, touches) : shorten(participants, touches);
    const double missing = missing_energy(participants), work = work_from_outside(participants, touches);
    const bool factored = stale || changed || std::any_of(participants.begin(), participants.end(), [](const Participant& p) {
                            return p.stepper->calls_for_matrix();
                          });
    if (factored) factor(participants, touches);
    for (Participant& p : participants) p.stepper->solve_linear();
    if (coupled_.empty())
      friction_.solve(touches, index_, tolerated, participants);
    else
      coupled_.solve(negligible_energy, work_, participants);
    if (bodies_ != nullptr) bodies_->solve(participants, factored);
    work_along_ = work_along(participants);
    double largest = 0;
    for (Participant& p : participants) {
      ++p.result->iterations;
      const double size = p.stepper->correct();
      if (!(size < largest_correction)) return false;
      largest = std::max(largest, size);
    }
    if (bodies_ != nullptr) {
      const double size = bodies_->correct();
      if (!(size < largest_correction)) return false;
      largest = std::max(largest, body_accuracy * size);
    }
    // After a change the next correction may be as large as this one; else it is about that much smaller.
    const double ratio = i == 0 || changed ? 1 : largest / last;
    const double strict = passes_momentum ? passing_part * tolerance : tolerance;
    const double enough = i < patient_iterations ? strict : impatience * tolerance;
    const bool consistent = std::all_of(participants.begin(), participants.end(),
                                        [](const Participant& p) { return p.stepper->flows_are_consistent(p.substep); });
    const double left = std::clamp(ratio, fastest_convergence, 1.0);
    const double untold = untold_part * (told + accountable_part * work) + negligible_energy;
    const bool is_accounted = left * larger(missing, expected) <= untold;
    expected = left * missing;
    if (largest * left < enough && is_accounted && consistent) {
      for (Participant& p : participants) p.result->converged = true;
      return true;
    }
    stale = i > 0 && ratio > slow_convergence;
    last = largest;
  }
  return false;
}

/// Friction that follows the normal forces is bounded by what they are now.
void ContactSolver::hold_bounds(std::vector<Touch>& touches) const {
  const auto hold = [](std::vector<Touch>& of) {
    for (Touch& touch : of)
      if (touch.mode != Touch::Mode::open && !touch.bound_is_held) hold_bound(touch.normal_force, touch);
  };
  hold(touches);
  if (bodies_ != nullptr) hold(bodies_->contacts().touches());
}

/// Takes back as much of the last correction as went too far. True if a contact has changed its way to touch.
bool ContactSolver::shorten(std::vector<Participant>& participants, std::vector<Touch>& touches) {
  double taken = 1, low = 0, high = 1, low_work = work_along_, high_work = 0;

  bool changed = press(participants, touches);
  if (!(low_work > 0)) return changed;
  for (int i = 0; i < maximum_shortenings; ++i) {
    const double work = work_along(participants);
    if (work < 0) {
      high = taken;
      high_work = work;
    } else {
      low = taken;
      low_work = work;
    }
    if (std::abs(work) <= turned_round * work_along_ || high_work == 0) break;
    const double share = std::clamp(low_work / (low_work - high_work), 0.1, 0.9);
    const double next = low + share * (high - low);
    for (Participant& p : participants) p.stepper->take_back(taken - next);
    if (bodies_ != nullptr) bodies_->take_back(taken - next);
    taken = next;
    changed = press(participants, touches) || changed;
  }
  return changed;
}

/// Of the forces along the last correction [J].
double ContactSolver::work_along(std::vector<Participant>& participants) const {
  double work = 0;
  for (Participant& p : participants) {
    work += dot(p.stepper->system().load, p.stepper->correction(), nodes(p));
    if (p.stepper->is_whole_rod()) work += dot(p.stepper->torque(), p.stepper->twist_correction(), segments(p));
  }
  if (bodies_ != nullptr) work += bodies_->work_along(participants);
  return work;
}

/// [J] In the account of the present iterate: of tensions that are not what lengths call for. Of what hardly stretches the
/// smallest correction leaves some.
double ContactSolver::missing_energy(const std::vector<Participant>& participants) const {
  double missing = 0;
  for (const Participant& p : participants) missing += p.stepper->missing_work_of_tension(p.substep.part());
  return std::abs(missing);
}

/// [J] Of holders and of what is touched and moves, by their sizes.
double ContactSolver::work_from_outside(const std::vector<Participant>& participants, const std::vector<Touch>& touches) const {
  double work = 0;
  for (const Participant& p : participants)
    for (const HeldNode& held : p.substep.boundary.nodes)
      work += std::abs(get(p.stepper->system().load, held.node).dot(get(p.stepper->displacement(), held.node)));
  for (const Touch& touch : touches)
    if (touch.mode != Touch::Mode::open) work += std::abs(touch.force.dot(touch.other_motion.displacement));
  return work;
}

/// Evaluates the loads, with the contacts' forces. True if one has changed its way to touch.
bool ContactSolver::press(std::vector<Participant>& participants, std::vector<Touch>& touches) {
  if (bodies_ != nullptr) bodies_->place_holders(participants);
  for (Participant& p : participants) p.stepper->evaluate(p.substep, *p.state);
  bool changed = bodies_ != nullptr && bodies_->contacts().press();
  for (Touch& touch : touches) {
    const CablePoint &point = touch.point, &other = touch.other;
    CableStepper& stepper = *at(participants, point).stepper;
    CableStepper* other_stepper = joins_cables(touch) ? at(participants, other).stepper : nullptr;
    changed = evaluate_touch(displacement_of(touch, participants), touch) || changed;
    touch.followed.setZero();
    if (touch.mode == Touch::Mode::open) continue;
    if (touch.body >= 0) bodies_->contacts().add_load(touch);
    add_force(point, touch.force, stepper.system().load);
    if (other_stepper != nullptr) add_force(other, -touch.force, other_stepper->system().load);
  }
  return changed;
}

void ContactSolver::factor(std::vector<Participant>& participants, std::vector<Touch>& touches) {
  for (Participant& p : participants) p.stepper->assemble(p.substep.part());
  coupled_.clear();
  if (bodies_ != nullptr) bodies_->clear_cable_contacts();
  for (const Touch& touch : touches) {
    if (touch.mode == Touch::Mode::open) continue;
    const Eigen::Matrix3d stiffness = slope(touch);
    at(participants, touch.point).stepper->system().add_stiffness(touch.point, stiffness);
    if (touch.body >= 0) bodies_->add_cable_contact(index_[touch.point.cable], touch);
    if (!joins_cables(touch)) continue;
    at(participants, touch.other).stepper->system().add_stiffness(touch.other, stiffness);
    coupled_.add(touch, index_[touch.point.cable], index_[touch.other.cable], stiffness);
  }
  for (Participant& p : participants) p.stepper->factor();
}

}  // namespace verlet_cable
