#include "contact/contact_solver.h"

#include <algorithm>
#include <cmath>

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
/// Conjugate gradients end when the energy of what is missing is less than this, relative to that of the whole correction and
/// of the substep's largest.
constexpr double coupling_tolerance = 1e-2;
constexpr double coupling_precision = 1e-10;
/// Or when it is this part of what moves a segment by no more than is tolerated.
constexpr double negligible_part = 0.1;
constexpr int maximum_coupling_iterations = 60;
/// Friction has followed the normal forces when displacements at the contacts change by less than this, relatively, or by this
/// part of what is tolerated.
constexpr double followed = 0.1;
constexpr double followed_part = 0.2;
/// In radii: what is no deeper in each other than by one and moves by less passes through nothing.
constexpr double short_way = 0.5;
constexpr int maximum_followings = 20;

/// Adds a force at a point to the nodes that carry it.
inline void share(const Vector3& force, const CablePoint& point, VectorArray& nodes) {
  share_force(point, force, [&](int i, const Vector3& part) {
    nodes.x[i] += part.x();
    nodes.y[i] += part.y();
    nodes.z[i] += part.z();
  });
}

template <typename Operation>
void each_component(const Operation& operation) {
  for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z}) operation(component);
}

double dot(const std::vector<double>& a, const std::vector<double>& b, int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

double dot(const VectorArray& a, const VectorArray& b, int count) {
  double sum = 0;
  each_component([&](auto component) {
    for (int i = 0; i < count; ++i) sum += (a.*component)[i] * (b.*component)[i];
  });
  return sum;
}

/// place += step * direction
void advance(double step, const std::vector<double>& direction, std::vector<double>& place) {
  const double* p = direction.data();
  double* x = place.data();
  const std::size_t count = place.size();
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) x[i] += step * p[i];
}

/// The same; then direction = found + ratio * direction
void turn(double step, double ratio, const std::vector<double>& found, std::vector<double>& direction,
          std::vector<double>& place) {
  const double* z = found.data();
  double *p = direction.data(), *x = place.data();
  const std::size_t count = place.size();
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    x[i] += step * p[i];
    p[i] = z[i] + ratio * p[i];
  }
}

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
  most_work_ = most_work;
  begin(participants);
  return iterate(participants, touches);
}

void ContactSolver::begin(std::vector<Participant>& participants) {
  if (work_.size() < participants.size()) work_.resize(participants.size());
  size_ = spent_ = 0;
  for (std::size_t k = 0; k < participants.size(); ++k) {
    Participant& p = participants[k];
    if (static_cast<int>(index_.size()) <= p.cable) index_.resize(p.cable + 1);
    index_[p.cable] = static_cast<int>(k);
    *p.result = {};
    p.stepper->begin(p.substep, *p.state, *p.result);
    size_ += work_of_visiting(p);
  }
  largest_energy_ = 0;
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
  const bool passes_momentum = std::any_of(touches.begin(), touches.end(), [](const Touch& touch) { return touch.body >= 0; });
  const double tolerance = velocity_tolerance * std::min(h, longest_tolerated);
  negligible_energy_ = tolerated_ = infinity;
  for (const Participant& p : participants) {
    const double moved = tolerance * p.state->rest_lengths.front();
    tolerated_ = std::min(tolerated_, moved);
    const double mass = p.state->rest_lengths.front() * CableMaterials(p.substep.model, *p.state)[0].linear_density;
    negligible_energy_ = std::min(negligible_energy_, negligible_part * mass * moved * moved / (h * h));
  }
  double told = 0;      // [J] if that much is missing, beside a part of the work
  double expected = 0;  // [J] to be missing, after the last iterate
  for (const Participant& p : participants) told += p.stepper->told_energy(p.substep, *p.state);
  double last = 0;
  bool stale = true;
  for (int i = 0; i < contact_iterations && spent_ < most_work_; ++i) {
    spend(budget::heavy, touches.size());
    if (i == following_iterations) hold_bounds(touches);
    const bool changed = i == 0 ? press(participants, touches) : shorten(participants, touches);
    const double missing = missing_energy(participants), work = work_from_outside(participants, touches);
    const bool factored = stale || changed || std::any_of(participants.begin(), participants.end(), [](const Participant& p) {
                            return p.stepper->calls_for_matrix();
                          });
    if (factored) factor(participants, touches);
    for (Participant& p : participants) p.stepper->solve_linear();
    if (couplings_.empty())
      follow_friction(participants, touches);
    else
      couple(participants);
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
    const double tolerated = untold_part * (told + accountable_part * work) + negligible_energy_;
    const bool is_accounted = left * larger(missing, expected) <= tolerated;
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
    share(touch.force, point, stepper.system().load);
    if (other_stepper != nullptr) share(-touch.force, other, other_stepper->system().load);
  }
  return changed;
}

void ContactSolver::factor(std::vector<Participant>& participants, std::vector<Touch>& touches) {
  for (Participant& p : participants) p.stepper->assemble(p.substep.part());
  couplings_.clear();
  if (bodies_ != nullptr) bodies_->clear_cable_contacts();
  for (const Touch& touch : touches) {
    if (touch.mode == Touch::Mode::open) continue;
    const Eigen::Matrix3d stiffness = slope(touch);
    at(participants, touch.point).stepper->system().add_stiffness(touch.point, stiffness);
    if (touch.body >= 0) bodies_->add_cable_contact(index_[touch.point.cable], touch);
    if (!joins_cables(touch)) continue;
    at(participants, touch.other).stepper->system().add_stiffness(touch.other, stiffness);
    couplings_.push_back({side_at(touch.point), side_at(touch.other), stiffness});
  }
  for (Participant& p : participants) p.stepper->factor();
}

/// The matrix has no part of the friction that follows the normal force of what slides, since that is not symmetric. Improves the
/// solutions until it follows all the same: along a capstan it takes as many times as the cable's tension has to be handed on.
void ContactSolver::follow_friction(std::vector<Participant>& participants, std::vector<Touch>& touches) {
  slips_.clear();
  for (std::size_t k = 0; k < participants.size(); ++k) work_[k].slips = false;
  for (Touch& touch : touches) {
    if (touch.mode == Touch::Mode::open || !(touch.friction > 0)) continue;
    Slip slip;
    slip.touch = &touch;
    slip.participant = index_[touch.point.cable];
    slip.normal = touch.normal;
    slip.friction = following_friction(touch);
    if (slip.friction.isZero(0)) continue;
    slip.normal_force = touch.normal_force;
    slip.stiffness = touch.rate * touch.normal_stiffness;
    slips_.push_back(slip);
    work_[slip.participant].slips = true;
  }
  if (slips_.empty()) return;
  for (std::size_t k = 0; k < participants.size(); ++k)
    if (work_[k].slips) work_[k].kept_load = participants[k].stepper->system().load;
  double last = follow_slips(participants);
  bool follows = true;
  for (int i = 0; i < maximum_followings && follows && last > 0; ++i) {
    solve_slipping(participants);
    const double way = follow_slips(participants);
    if (!(way > 0)) break;
    follows = way < last;
    last = way;
  }
  for (std::size_t k = 0; k < participants.size(); ++k)
    if (work_[k].slips) std::swap(participants[k].stepper->system().load, work_[k].kept_load);
  if (follows) return;
  // Where it gets away from them, without.
  solve_slipping(participants);
  for (const Slip& slip : slips_) slip.touch->followed.setZero();
}

/// Adds to the loads what friction changes with the normal forces in the present solution. How far that has come since the last
/// time [m], 0 if no distance.
double ContactSolver::follow_slips(std::vector<Participant>& participants) {
  double way = 0, largest = 0;
  for (Slip& slip : slips_) {
    CableStepper& stepper = *participants[slip.participant].stepper;
    const Vector3 displacement = at_point(slip.touch->point, stepper.correction());
    way = std::max(way, (displacement - slip.displacement).squaredNorm());
    largest = std::max(largest, displacement.squaredNorm());
    slip.displacement = displacement;
    const double change = std::max(-slip.stiffness * slip.normal.dot(displacement), -slip.normal_force);
    share((change - slip.change) * slip.friction, slip.touch->point, stepper.system().load);
    slip.change = change;
  }
  way = std::sqrt(way);
  return way > std::max(followed * std::sqrt(largest), followed_part * tolerated_) ? way : 0;
}

void ContactSolver::solve_slipping(std::vector<Participant>& participants) {
  for (std::size_t k = 0; k < participants.size(); ++k)
    if (work_[k].slips) participants[k].stepper->solve_linear();
  for (const Slip& slip : slips_) slip.touch->followed = slip.change * slip.friction;
}

/// Improves the solutions that the cables have found alone until they heed each other. The matrix differs from the cables' own by
/// what joins the two sides of contacts, so that all residuals are forces on their points.
void ContactSolver::couple(std::vector<Participant>& participants) {
  double whole = 0;
  for (std::size_t k = 0; k < participants.size(); ++k) {
    CableStepper& stepper = *participants[k].stepper;
    whole += std::abs(dot(stepper.system().load, stepper.correction(), nodes(participants[k])));
    work_[k].coupled = false;
  }
  const auto displacement_of = [&](const Side& side) {
    return at_point(side.point, participants[side.participant].stepper->correction());
  };
  for (Coupling& c : couplings_) {
    c.first.residual = c.matrix * displacement_of(c.second);
    c.second.residual = c.matrix * displacement_of(c.first);
    work_[c.first.participant].coupled = work_[c.second.participant].coupled = true;
  }
  begin_solutions(participants);
  exchange_loads(participants);
  largest_energy_ = std::max(largest_energy_, whole);
  const double enough = std::max({coupling_tolerance * whole, coupling_precision * largest_energy_, negligible_energy_});

  double energy = 0, step = 0;
  for (int i = 0; i < maximum_coupling_iterations; ++i) {
    const double next_energy = precondition(participants);
    spend(budget::coupling, couplings_.size());
    if (!(next_energy > enough) || spent_ > most_work_) break;
    const double ratio = i == 0 ? 0 : next_energy / energy;
    energy = next_energy;
    turn_directions(step, ratio, participants);
    step = 0;
    double curvature = 0;
    for (Coupling& c : couplings_) {
      for (Side* side : {&c.first, &c.second}) {
        side->direction = side->displacement + ratio * side->direction;
        side->image = side->residual + ratio * side->image;
      }
      curvature += c.first.direction.dot(c.first.image) + c.second.direction.dot(c.second.image) -
                   2 * c.first.direction.dot(c.matrix * c.second.direction);
    }
    if (!(curvature > 0)) break;
    step = energy / curvature;
    for (Coupling& c : couplings_) {
      c.first.residual -= step * (c.first.image - c.matrix * c.second.direction);
      c.second.residual -= step * (c.second.image - c.matrix * c.first.direction);
      for (Side* side : {&c.first, &c.second}) side->correction += step * side->image;
    }
  }
  clear_loads(participants);
  exchange_loads(participants);
  put_solutions(step, participants);
  solve_whole_rods(participants);
}

/// Solves the cables' own systems for the residuals; their energy.
double ContactSolver::precondition(std::vector<Participant>& participants) {
  clear_loads(participants);
  load_residuals(participants);
  for (std::size_t k = 0; k < participants.size(); ++k)
    if (work_[k].coupled) participants[k].stepper->solve_linear();
  double energy = 0;
  for (Coupling& c : couplings_)
    for (Side* side : {&c.first, &c.second}) {
      side->displacement = at_point(side->point, participants[side->participant].stepper->correction());
      energy += side->residual.dot(side->displacement);
    }
  return energy;
}

/// Takes the last step along the directions and turns them: the new one is what the cables have just found and `ratio` times the
/// last one.
void ContactSolver::turn_directions(double last_step, double ratio, const std::vector<Participant>& participants) {
  for (std::size_t k = 0; k < participants.size(); ++k) {
    if (!work_[k].coupled || participants[k].stepper->is_whole_rod()) continue;
    Work& work = work_[k];
    const CableStepper& stepper = *participants[k].stepper;
    each_component([&](auto component) {
      turn(last_step, ratio, stepper.correction().*component, work.direction.*component, work.correction.*component);
    });
    turn(last_step, ratio, stepper.multiplier_correction(), work.multiplier_direction, work.multiplier);
  }
}

void ContactSolver::load_residuals(std::vector<Participant>& participants) const {
  for (const Coupling& c : couplings_)
    for (const Side* side : {&c.first, &c.second})
      share(side->residual, side->point, participants[side->participant].stepper->system().load);
}

/// The solutions that the cables have found alone are where improvement begins.
void ContactSolver::begin_solutions(const std::vector<Participant>& participants) {
  for (std::size_t k = 0; k < participants.size(); ++k) {
    if (!work_[k].coupled) continue;
    Work& work = work_[k];
    CableStepper& stepper = *participants[k].stepper;
    const std::size_t count = stepper.system().load.x.size();
    if (work.load.x.size() != count) {
      work.load.assign(count, 0.0);
      work.gap.assign(stepper.system().gap.size(), 0.0);
    }
    if (work.torque.size() != stepper.torque().size()) work.torque.assign(stepper.torque().size(), 0.0);
    work.flow_load.assign(stepper.system().flow_load.size(), 0.0);
    if (stepper.is_whole_rod()) continue;
    work.correction = stepper.correction();
    work.multiplier = stepper.multiplier_correction();
    work.direction.assign(count, 0.0);
    work.multiplier_direction.assign(work.multiplier.size(), 0.0);
  }
}

/// Coupled cables are loaded by residuals alone, and by their own loads again.
void ContactSolver::exchange_loads(std::vector<Participant>& participants) {
  for (std::size_t k = 0; k < participants.size(); ++k) {
    if (!work_[k].coupled) continue;
    CableStepper& stepper = *participants[k].stepper;
    std::swap(stepper.system().load, work_[k].load);
    std::swap(stepper.system().gap, work_[k].gap);
    std::swap(stepper.torque(), work_[k].torque);
    std::swap(stepper.system().flow_load, work_[k].flow_load);
  }
}
void ContactSolver::clear_loads(std::vector<Participant>& participants) const {
  for (std::size_t k = 0; k < participants.size(); ++k) {
    VectorArray& load = participants[k].stepper->system().load;
    if (work_[k].coupled) load.assign(load.x.size(), 0.0);
  }
}

/// The improved solutions, which the cables have kept with a last step along the directions.
void ContactSolver::put_solutions(double last_step, std::vector<Participant>& participants) {
  for (std::size_t k = 0; k < participants.size(); ++k) {
    if (!work_[k].coupled || participants[k].stepper->is_whole_rod()) continue;
    Work& work = work_[k];
    each_component([&](auto component) { advance(last_step, work.direction.*component, work.correction.*component); });
    advance(last_step, work.multiplier_direction, work.multiplier);
    participants[k].stepper->set_correction(work.correction, work.multiplier);
  }
}

/// Whole rods have more unknowns than are kept: they are solved once more, with what the contacts add to their loads.
void ContactSolver::solve_whole_rods(std::vector<Participant>& participants) {
  const auto is_whole_rod = [&](std::size_t k) { return work_[k].coupled && participants[k].stepper->is_whole_rod(); };
  for (std::size_t k = 0; k < participants.size(); ++k)
    if (is_whole_rod(k)) work_[k].kept_load = participants[k].stepper->system().load;
  for (const Coupling& c : couplings_)
    for (const Side* side : {&c.first, &c.second})
      if (is_whole_rod(side->participant))
        share(side->correction, side->point, participants[side->participant].stepper->system().load);
  for (std::size_t k = 0; k < participants.size(); ++k) {
    if (!is_whole_rod(k)) continue;
    participants[k].stepper->solve_linear();
    std::swap(participants[k].stepper->system().load, work_[k].kept_load);
  }
}

ContactSolver::Side ContactSolver::side_at(const CablePoint& point) const {
  Side side;
  side.participant = index_[point.cable];
  side.point = point;
  return side;
}

}  // namespace verlet_cable
