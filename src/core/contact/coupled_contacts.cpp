#include "contact/coupled_contacts.h"

#include <algorithm>
#include <cmath>

#include "chain/node_sums.h"
#include "chain/point_motion.h"

namespace verlet_cable {

namespace {

/// Conjugate gradients end when the energy of what is missing is less than this, relative to that of the whole correction and
/// of the substep's largest.
constexpr double coupling_tolerance = 1e-2;
constexpr double coupling_precision = 1e-10;
constexpr int maximum_coupling_iterations = 60;

template <typename Operation>
void each_component(const Operation& operation) {
  for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z}) operation(component);
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

}  // namespace

void CoupledContacts::begin(std::size_t participants) {
  if (cables_.size() < participants) cables_.resize(participants);
  largest_energy_ = 0;
}

void CoupledContacts::add(const Touch& touch, int first, int second, const Eigen::Matrix3d& stiffness) {
  couplings_.push_back({side_at(touch.point, first), side_at(touch.other, second), stiffness});
}

void CoupledContacts::solve(double negligible_energy, WorkCount& work, std::vector<Participant>& participants) {
  double whole = 0;
  for (std::size_t k = 0; k < participants.size(); ++k) {
    CableStepper& stepper = *participants[k].stepper;
    whole += std::abs(dot(stepper.system().load, stepper.correction(), participants[k].state->nodes()));
    cables_[k].coupled = false;
  }
  const auto displacement_of = [&](const Side& side) {
    return at_point(side.point, participants[side.participant].stepper->correction());
  };
  for (Coupling& c : couplings_) {
    c.first.residual = c.matrix * displacement_of(c.second);
    c.second.residual = c.matrix * displacement_of(c.first);
    cables_[c.first.participant].coupled = cables_[c.second.participant].coupled = true;
  }
  begin_solutions(participants);
  exchange_loads(participants);
  largest_energy_ = std::max(largest_energy_, whole);
  const double enough = std::max({coupling_tolerance * whole, coupling_precision * largest_energy_, negligible_energy});

  double energy = 0, step = 0;
  for (int i = 0; i < maximum_coupling_iterations; ++i) {
    const double next_energy = precondition(participants);
    work.spend(budget::coupling, couplings_.size());
    if (!(next_energy > enough) || !work.is_left()) break;
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
double CoupledContacts::precondition(std::vector<Participant>& participants) {
  clear_loads(participants);
  load_residuals(participants);
  for (std::size_t k = 0; k < participants.size(); ++k)
    if (cables_[k].coupled) participants[k].stepper->solve_linear();
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
void CoupledContacts::turn_directions(double last_step, double ratio, const std::vector<Participant>& participants) {
  for (std::size_t k = 0; k < participants.size(); ++k) {
    if (!cables_[k].coupled || participants[k].stepper->is_whole_rod()) continue;
    Cable& cable = cables_[k];
    const CableStepper& stepper = *participants[k].stepper;
    each_component([&](auto component) {
      turn(last_step, ratio, stepper.correction().*component, cable.direction.*component, cable.correction.*component);
    });
    turn(last_step, ratio, stepper.multiplier_correction(), cable.multiplier_direction, cable.multiplier);
  }
}

void CoupledContacts::load_residuals(std::vector<Participant>& participants) const {
  for (const Coupling& c : couplings_)
    for (const Side* side : {&c.first, &c.second})
      add_force(side->point, side->residual, participants[side->participant].stepper->system().load);
}

/// The solutions that the cables have found alone are where improvement begins.
void CoupledContacts::begin_solutions(const std::vector<Participant>& participants) {
  for (std::size_t k = 0; k < participants.size(); ++k) {
    if (!cables_[k].coupled) continue;
    Cable& cable = cables_[k];
    CableStepper& stepper = *participants[k].stepper;
    const std::size_t count = stepper.system().load.x.size();
    if (cable.load.x.size() != count) {
      cable.load.assign(count, 0.0);
      cable.gap.assign(stepper.system().gap.size(), 0.0);
    }
    if (cable.torque.size() != stepper.torque().size()) cable.torque.assign(stepper.torque().size(), 0.0);
    cable.flow_load.assign(stepper.system().flow_load.size(), 0.0);
    if (stepper.is_whole_rod()) continue;
    cable.correction = stepper.correction();
    cable.multiplier = stepper.multiplier_correction();
    cable.direction.assign(count, 0.0);
    cable.multiplier_direction.assign(cable.multiplier.size(), 0.0);
  }
}

/// Coupled cables are loaded by residuals alone, and by their own loads again.
void CoupledContacts::exchange_loads(std::vector<Participant>& participants) {
  for (std::size_t k = 0; k < participants.size(); ++k) {
    if (!cables_[k].coupled) continue;
    CableStepper& stepper = *participants[k].stepper;
    std::swap(stepper.system().load, cables_[k].load);
    std::swap(stepper.system().gap, cables_[k].gap);
    std::swap(stepper.torque(), cables_[k].torque);
    std::swap(stepper.system().flow_load, cables_[k].flow_load);
  }
}

void CoupledContacts::clear_loads(std::vector<Participant>& participants) const {
  for (std::size_t k = 0; k < participants.size(); ++k) {
    VectorArray& load = participants[k].stepper->system().load;
    if (cables_[k].coupled) load.assign(load.x.size(), 0.0);
  }
}

/// The improved solutions, which the cables have kept with a last step along the directions.
void CoupledContacts::put_solutions(double last_step, std::vector<Participant>& participants) {
  for (std::size_t k = 0; k < participants.size(); ++k) {
    if (!cables_[k].coupled || participants[k].stepper->is_whole_rod()) continue;
    Cable& cable = cables_[k];
    each_component([&](auto component) { advance(last_step, cable.direction.*component, cable.correction.*component); });
    advance(last_step, cable.multiplier_direction, cable.multiplier);
    participants[k].stepper->set_correction(cable.correction, cable.multiplier);
  }
}

/// Whole rods have more unknowns than are kept: they are solved once more, with what the contacts add to their loads.
void CoupledContacts::solve_whole_rods(std::vector<Participant>& participants) {
  const auto is_whole_rod = [&](std::size_t k) { return cables_[k].coupled && participants[k].stepper->is_whole_rod(); };
  for (std::size_t k = 0; k < participants.size(); ++k)
    if (is_whole_rod(k)) cables_[k].kept_load = participants[k].stepper->system().load;
  for (const Coupling& c : couplings_)
    for (const Side* side : {&c.first, &c.second})
      if (is_whole_rod(side->participant))
        add_force(side->point, side->correction, participants[side->participant].stepper->system().load);
  for (std::size_t k = 0; k < participants.size(); ++k) {
    if (!is_whole_rod(k)) continue;
    participants[k].stepper->solve_linear();
    std::swap(participants[k].stepper->system().load, cables_[k].kept_load);
  }
}

CoupledContacts::Side CoupledContacts::side_at(const CablePoint& point, int participant) {
  Side side;
  side.participant = participant;
  side.point = point;
  return side;
}

}  // namespace verlet_cable
