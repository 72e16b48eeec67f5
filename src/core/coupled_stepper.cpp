#include "coupled_stepper.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {

namespace {

constexpr int maximum_iterations = 60;
/// Error of a node's velocity at which an iteration ends, in segment lengths per second.
constexpr double velocity_tolerance = 1e-3;
constexpr double longest_tolerated = 1e-3;  // [s]; beyond, the error of the place counts
constexpr double largest_correction = 2;    // segment lengths
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
constexpr double coupling_tolerance = 1e-4;
constexpr double coupling_precision = 1e-10;
constexpr int maximum_coupling_iterations = 60;

Vector3 at_point(const VectorArray& nodes, const CablePoint& point) {
  return (1 - point.fraction) * get(nodes, point.segment) + point.fraction * get(nodes, point.segment + 1);
}

void add_to(VectorArray& nodes, int i, const Vector3& v) {
  nodes.x[i] += v.x();
  nodes.y[i] += v.y();
  nodes.z[i] += v.z();
}

/// A force at a point is shared by the nodes next to it like its place.
void add_at_point(VectorArray& nodes, const CablePoint& point, const Vector3& v) {
  add_to(nodes, point.segment, (1 - point.fraction) * v);
  add_to(nodes, point.segment + 1, point.fraction * v);
}

template <typename Operation>
void each_component(const Operation& operation) {
  for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z}) operation(component);
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
  return p.substep.model.nodes();
}

int segments(const Participant& p) {
  return p.substep.model.segments();
}

bool joins_cables(const Touch& touch) {
  return touch.other.cable >= 0;
}

}  // namespace

void CoupledStepper::Work::resize(std::size_t nodes) {
  for (VectorArray* a : {&load, &residual, &direction, &own_image, &image, &correction}) a->assign(nodes, 0.0);
  for (std::vector<double>* a : {&gap, &direction_multiplier, &correction_multiplier}) a->assign(nodes, 0.0);
}

bool CoupledStepper::advance(std::vector<Participant>& participants, std::vector<Touch>& touches) {
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
bool CoupledStepper::solve(std::vector<Participant>& participants, std::vector<Touch>& touches) {
  const Substep& first = participants.front().substep;
  const double tolerance = velocity_tolerance * std::min(first.h, longest_tolerated);
  double last = 0;
  bool stale = true;
  for (int i = 0; i < maximum_iterations; ++i) {
    const bool changed = i == 0 ? press(participants, touches) : shorten(participants, touches);
    if (stale || changed) factor(participants, touches);
    for (Participant& p : participants) p.stepper->solver().solve(p.stepper->system());
    couple(participants, touches);
    work_along_ = work_along(participants);
    double largest = 0;
    for (Participant& p : participants) {
      ++p.result.iterations;
      const double size = p.stepper->correct();
      if (!(size < largest_correction)) return false;
      largest = std::max(largest, size);
    }
    const double ratio = i == 0 ? 1 : largest / last;
    const double enough = i < patient_iterations ? tolerance : impatience * tolerance;
    if (!changed && largest * std::clamp(ratio, fastest_convergence, 1.0) < enough) {
      for (Participant& p : participants) p.result.converged = true;
      return true;
    }
    stale = i > 0 && ratio > slow_convergence;
    last = largest;
  }
  return false;
}

/// Takes back as much of the last correction as went too far. True if a contact has changed its way to touch.
bool CoupledStepper::shorten(std::vector<Participant>& participants, std::vector<Touch>& touches) {
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
double CoupledStepper::work_along(std::vector<Participant>& participants) const {
  double work = 0;
  for (Participant& p : participants) work += dot(p.stepper->system().load, p.stepper->solver().displacement(), nodes(p));
  return work;
}

/// Evaluates the loads, with the contacts' forces. True if one has changed its way to touch.
bool CoupledStepper::press(std::vector<Participant>& participants, std::vector<Touch>& touches) {
  for (Participant& p : participants) p.stepper->evaluate(p.substep);
  bool changed = false;
  for (Touch& touch : touches) {
    CableStepper& stepper = *at(participants, touch.point).stepper;
    Vector3 displacement = at_point(stepper.displacement(), touch.point);
    if (joins_cables(touch)) displacement -= at_point(at(participants, touch.other).stepper->displacement(), touch.other);
    changed = evaluate_touch(displacement, touch) || changed;
    add_at_point(stepper.system().load, touch.point, touch.force);
    if (joins_cables(touch)) add_at_point(at(participants, touch.other).stepper->system().load, touch.other, -touch.force);
  }
  return changed;
}

void CoupledStepper::factor(std::vector<Participant>& participants, std::vector<Touch>& touches) {
  for (Participant& p : participants) p.stepper->assemble(p.substep.part());
  for (Touch& touch : touches) {
    touch.matrix = touch.slope;
    at(participants, touch.point).stepper->system().add_stiffness(touch.point.segment, touch.point.fraction, touch.matrix);
    if (joins_cables(touch))
      at(participants, touch.other).stepper->system().add_stiffness(touch.other.segment, touch.other.fraction, touch.matrix);
  }
  for (Participant& p : participants) p.stepper->factor();
}

/// Improves the solutions that the cables have found alone until they heed each other.
void CoupledStepper::couple(std::vector<Participant>& participants, const std::vector<Touch>& touches) {
  if (std::none_of(touches.begin(), touches.end(), joins_cables)) return;
  const std::size_t count = participants.size();
  double whole = 0;
  for (std::size_t k = 0; k < count; ++k) {
    Participant& p = participants[k];
    Work& w = work_[k];
    SaddleSystem& system = p.stepper->system();
    w.load = system.load;
    w.gap = system.gap;
    w.correction = p.stepper->solver().displacement();
    w.correction_multiplier = p.stepper->solver().multiplier();
    w.residual.assign(w.load.x.size(), 0.0);
    whole += std::abs(dot(w.load, w.correction, nodes(p)));
    std::fill(system.gap.begin(), system.gap.end(), 0.0);
  }
  add_coupling(touches, -1, &Work::correction, &Work::residual);

  largest_energy_ = std::max(largest_energy_, whole);
  const double enough = std::max(coupling_tolerance * whole, coupling_precision * largest_energy_);
  double energy = 0;
  for (int i = 0; i < maximum_coupling_iterations; ++i) {
    double next_energy = 0;
    for (std::size_t k = 0; k < count; ++k) {
      CableStepper& stepper = *participants[k].stepper;
      stepper.system().load = work_[k].residual;
      stepper.solver().solve(stepper.system());
      next_energy += dot(work_[k].residual, stepper.solver().displacement(), nodes(participants[k]));
    }
    if (!(next_energy > enough)) break;
    const double ratio = i == 0 ? 0 : next_energy / energy;
    energy = next_energy;
    for (std::size_t k = 0; k < count; ++k) {
      const Participant& p = participants[k];
      Work& w = work_[k];
      scale_and_add(ratio, p.stepper->solver().displacement(), w.direction, nodes(p));
      scale_and_add(ratio, p.stepper->solver().multiplier(), w.direction_multiplier, segments(p));
      scale_and_add(ratio, w.residual, w.own_image, nodes(p));
      w.image = w.own_image;
    }
    add_coupling(touches, 1, &Work::direction, &Work::image);
    double curvature = 0;
    for (std::size_t k = 0; k < count; ++k) curvature += dot(work_[k].direction, work_[k].image, nodes(participants[k]));
    if (!(curvature > 0)) break;
    const double step = energy / curvature;
    for (std::size_t k = 0; k < count; ++k) {
      const Participant& p = participants[k];
      Work& w = work_[k];
      add_scaled(step, w.direction, w.correction, nodes(p));
      add_scaled(step, w.direction_multiplier, w.correction_multiplier, segments(p));
      add_scaled(-step, w.image, w.residual, nodes(p));
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    CableStepper& stepper = *participants[k].stepper;
    stepper.system().load = work_[k].load;
    stepper.system().gap = work_[k].gap;
    stepper.solver().set_solution(work_[k].correction, work_[k].correction_multiplier);
  }
}

/// to += sign * (the part of the matrix that joins the two sides of contacts) of
void CoupledStepper::add_coupling(const std::vector<Touch>& touches, double sign, VectorArray Work::*of, VectorArray Work::*to) {
  for (const Touch& touch : touches) {
    if (!joins_cables(touch)) continue;
    Work &a = work_[index_[touch.point.cable]], &b = work_[index_[touch.other.cable]];
    const Vector3 of_a = touch.matrix * at_point(a.*of, touch.point), of_b = touch.matrix * at_point(b.*of, touch.other);
    add_at_point(a.*to, touch.point, -sign * of_b);
    add_at_point(b.*to, touch.other, -sign * of_a);
  }
}

Participant& CoupledStepper::at(std::vector<Participant>& participants, const CablePoint& point) const {
  return participants[index_[point.cable]];
}

}  // namespace verlet_cable
