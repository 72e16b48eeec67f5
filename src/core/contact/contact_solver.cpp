#include "contact/contact_solver.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {

namespace {

constexpr int maximum_iterations = 60;
/// Error of a node's velocity at which an iteration ends, in segment lengths per second.
constexpr double velocity_tolerance = 4e-3;
constexpr double fastest_convergence = 0.1;
constexpr double slow_convergence = 0.2;
/// Where friction turns round slowly, a larger error is as good after so many iterations.
constexpr int patient_iterations = 10;
constexpr double impatience = 30;
/// A correction may turn the forces along it round to this part of what they were.
constexpr double turned_round = 0.5;
constexpr int maximum_shortenings = 8;
/// Conjugate gradients end when the energy of what is missing is less than this, relative to that of the whole correction and
/// of the substep's largest.
constexpr double coupling_tolerance = 1e-3;
constexpr double coupling_precision = 1e-10;
/// Or when it is this part of what moves a segment by no more than is tolerated.
constexpr double negligible_part = 0.1;
constexpr int maximum_coupling_iterations = 60;

inline Vector3 between(const VectorArray& nodes, int i, double fraction) {
  return (1 - fraction) * get(nodes, i) + fraction * get(nodes, i + 1);
}

/// Adds a force at a point of a segment to the nodes next to it, in the shares of its place.
inline void share(const Vector3& v, int i, double fraction, VectorArray& nodes) {
  const Vector3 next = fraction * v, here = v - next;
  nodes.x[i] += here.x();
  nodes.y[i] += here.y();
  nodes.z[i] += here.z();
  nodes.x[i + 1] += next.x();
  nodes.y[i + 1] += next.y();
  nodes.z[i + 1] += next.z();
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

/// to += scale from
void add_scaled(double scale, const std::vector<double>& from, std::vector<double>& to, int count) {
  for (int i = 0; i < count; ++i) to[i] += scale * from[i];
}

void add_scaled(double scale, const VectorArray& from, VectorArray& to, int count) {
  each_component([&](auto component) { add_scaled(scale, from.*component, to.*component, count); });
}

/// to = from + scale to
void scale_and_add(double scale, const std::vector<double>& from, std::vector<double>& to, int count) {
  for (int i = 0; i < count; ++i) to[i] = from[i] + scale * to[i];
}

void scale_and_add(double scale, const VectorArray& from, VectorArray& to, int count) {
  each_component([&](auto component) { scale_and_add(scale, from.*component, to.*component, count); });
}

int nodes(const Participant& p) {
  return p.state->nodes();
}

int segments(const Participant& p) {
  return p.state->segments();
}

bool joins_cables(const Touch& touch) {
  return touch.other.cable >= 0;
}

}  // namespace

void ContactSolver::Work::resize(std::size_t nodes) {
  for (VectorArray* a : {&load, &correction, &direction, &own_image, &image}) a->assign(nodes, 0.0);
  for (std::vector<double>* a :
       {&gap, &correction_multiplier, &direction_multiplier, &torque, &correction_twist, &direction_twist})
    a->assign(nodes, 0.0);
}

bool ContactSolver::advance(std::vector<Participant>& participants, std::vector<Touch>& touches) {
  if (work_.size() < participants.size()) work_.resize(participants.size());
  for (std::size_t k = 0; k < participants.size(); ++k) {
    Participant& p = participants[k];
    if (static_cast<int>(index_.size()) <= p.cable) index_.resize(p.cable + 1);
    index_[p.cable] = static_cast<int>(k);
    work_[k].resize(nodes(p) + 1);
    p.result = {};
    p.stepper->begin(p.substep, *p.state, p.result);
  }
  largest_energy_ = 0;
  if (!solve(participants, touches)) return false;
  for (Participant& p : participants) p.stepper->finish(p.substep, true, *p.state, p.result);
  return true;
}

/// Newton's method on the places, tensions and contacts of all. Contacts are stiff on one side and nothing on the other, so that
/// whole corrections may jump to and fro between them: each is shortened until the forces along it have no more than half turned
/// round.
bool ContactSolver::solve(std::vector<Participant>& participants, std::vector<Touch>& touches) {
  const Substep& first = participants.front().substep;
  const double tolerance = velocity_tolerance * std::min(first.h, longest_tolerated);
  negligible_energy_ = infinity;
  for (const Participant& p : participants) {
    const double moved = tolerance * p.state->rest_lengths.front();
    const double mass = p.state->rest_lengths.front() * p.substep.model.material.linear_density;
    negligible_energy_ = std::min(negligible_energy_, negligible_part * mass * moved * moved / (first.h * first.h));
  }
  double last = 0;
  bool stale = true;
  for (int i = 0; i < maximum_iterations; ++i) {
    const bool changed = i == 0 ? press(participants, touches) : shorten(participants, touches);
    if (stale || changed) factor(participants, touches);
    for (Participant& p : participants) p.stepper->solve_linear();
    couple(participants);
    work_along_ = work_along(participants);
    double largest = 0;
    for (Participant& p : participants) {
      ++p.result.iterations;
      const double size = p.stepper->correct();
      if (!(size < largest_correction)) return false;
      largest = std::max(largest, size);
    }
    // After a change the next correction may be as large as this one; else it is about that much smaller.
    const double ratio = i == 0 || changed ? 1 : largest / last;
    const double enough = i < patient_iterations ? tolerance : impatience * tolerance;
    if (largest * std::clamp(ratio, fastest_convergence, 1.0) < enough) {
      for (Participant& p : participants) p.result.converged = true;
      return true;
    }
    stale = i > 0 && ratio > slow_convergence;
    last = largest;
  }
  return false;
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
  return work;
}

/// Evaluates the loads, with the contacts' forces. True if one has changed its way to touch.
bool ContactSolver::press(std::vector<Participant>& participants, std::vector<Touch>& touches) {
  for (Participant& p : participants) p.stepper->evaluate(p.substep, *p.state);
  bool changed = false;
  for (Touch& touch : touches) {
    const CablePoint &point = touch.point, &other = touch.other;
    CableStepper& stepper = *at(participants, point).stepper;
    CableStepper* other_stepper = joins_cables(touch) ? at(participants, other).stepper : nullptr;
    Vector3 displacement = between(stepper.displacement(), point.segment, point.fraction);
    if (other_stepper != nullptr) displacement -= between(other_stepper->displacement(), other.segment, other.fraction);
    changed = evaluate_touch(displacement, touch) || changed;
    if (touch.mode == Touch::Mode::open) continue;
    share(touch.force, point.segment, point.fraction, stepper.system().load);
    if (other_stepper != nullptr) share(-touch.force, other.segment, other.fraction, other_stepper->system().load);
  }
  return changed;
}

void ContactSolver::factor(std::vector<Participant>& participants, std::vector<Touch>& touches) {
  for (Participant& p : participants) p.stepper->assemble(p.substep.part());
  couplings_.clear();
  for (const Touch& touch : touches) {
    if (touch.mode == Touch::Mode::open) continue;
    const Eigen::Matrix3d stiffness = slope(touch);
    at(participants, touch.point).stepper->system().add_stiffness(touch.point.segment, touch.point.fraction, stiffness);
    if (!joins_cables(touch)) continue;
    at(participants, touch.other).stepper->system().add_stiffness(touch.other.segment, touch.other.fraction, stiffness);
    couplings_.push_back({index_[touch.point.cable], index_[touch.other.cable], touch.point.segment, touch.other.segment,
                          touch.point.fraction, touch.other.fraction, stiffness});
  }
  for (Participant& p : participants) p.stepper->factor();
}

/// Improves the solutions that the cables have found alone until they heed each other.
void ContactSolver::couple(std::vector<Participant>& participants) {
  if (couplings_.empty()) return;
  const std::size_t count = participants.size();
  const auto residual = [&](int k) -> VectorArray& { return participants[k].stepper->system().load; };
  double whole = 0;
  for (std::size_t k = 0; k < count; ++k) {
    Participant& p = participants[k];
    Work& w = work_[k];
    w.correction = p.stepper->correction();
    w.correction_multiplier = p.stepper->multiplier_correction();
    w.correction_twist = p.stepper->twist_correction();
    whole += std::abs(dot(residual(k), w.correction, nodes(p)));
    std::swap(w.load, residual(k));
    std::swap(w.gap, p.stepper->system().gap);
    std::swap(w.torque, p.stepper->torque());
    residual(k).assign(w.load.x.size(), 0.0);
    p.stepper->system().gap.assign(w.gap.size(), 0.0);
    p.stepper->torque().assign(w.torque.size(), 0.0);
  }
  add_coupling(
      -1, [&](int k) -> const VectorArray& { return work_[k].correction; }, residual);
  largest_energy_ = std::max(largest_energy_, whole);
  const double enough = std::max({coupling_tolerance * whole, coupling_precision * largest_energy_, negligible_energy_});

  double energy = 0;
  for (int i = 0; i < maximum_coupling_iterations; ++i) {
    double next_energy = 0;
    for (std::size_t k = 0; k < count; ++k) {
      CableStepper& stepper = *participants[k].stepper;
      stepper.solve_linear();
      next_energy += dot(residual(k), stepper.correction(), nodes(participants[k]));
    }
    if (!(next_energy > enough)) break;
    const double ratio = i == 0 ? 0 : next_energy / energy;
    energy = next_energy;
    for (std::size_t k = 0; k < count; ++k) {
      const Participant& p = participants[k];
      Work& w = work_[k];
      scale_and_add(ratio, p.stepper->correction(), w.direction, nodes(p));
      scale_and_add(ratio, p.stepper->multiplier_correction(), w.direction_multiplier, segments(p));
      if (p.stepper->is_whole_rod()) scale_and_add(ratio, p.stepper->twist_correction(), w.direction_twist, segments(p));
      scale_and_add(ratio, residual(k), w.own_image, nodes(p));
      w.image = w.own_image;
    }
    add_coupling(
        1, [&](int k) -> const VectorArray& { return work_[k].direction; },
        [&](int k) -> VectorArray& { return work_[k].image; });
    double curvature = 0;
    for (std::size_t k = 0; k < count; ++k) curvature += dot(work_[k].direction, work_[k].image, nodes(participants[k]));
    if (!(curvature > 0)) break;
    const double step = energy / curvature;
    for (std::size_t k = 0; k < count; ++k) {
      const Participant& p = participants[k];
      Work& w = work_[k];
      add_scaled(step, w.direction, w.correction, nodes(p));
      add_scaled(step, w.direction_multiplier, w.correction_multiplier, segments(p));
      if (p.stepper->is_whole_rod()) add_scaled(step, w.direction_twist, w.correction_twist, segments(p));
      add_scaled(-step, w.image, residual(k), nodes(p));
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    CableStepper& stepper = *participants[k].stepper;
    std::swap(work_[k].load, stepper.system().load);
    std::swap(work_[k].gap, stepper.system().gap);
    std::swap(work_[k].torque, stepper.torque());
    stepper.set_correction(work_[k].correction, work_[k].correction_multiplier, work_[k].correction_twist);
  }
}

/// to += sign * (the part of the matrix that joins the two sides of contacts) of
template <typename Of, typename To>
void ContactSolver::add_coupling(double sign, const Of& of, const To& to) const {
  for (const Coupling& c : couplings_) {
    const Vector3 first = c.matrix * between(of(c.first), c.first_segment, c.first_fraction);
    const Vector3 second = c.matrix * between(of(c.second), c.second_segment, c.second_fraction);
    share(-sign * second, c.first_segment, c.first_fraction, to(c.first));
    share(-sign * first, c.second_segment, c.second_fraction, to(c.second));
  }
}

Participant& ContactSolver::at(std::vector<Participant>& participants, const CablePoint& point) const {
  return participants[index_[point.cable]];
}

}  // namespace verlet_cable
