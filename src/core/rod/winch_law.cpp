#include <algorithm>
#include <cmath>

#include "rod/cable_stepper.h"

namespace verlet_cable {

namespace {

/// A winch may change its mode so often in a substep; then it keeps it.
constexpr int most_changes = 8;
/// Of what inertia resists with in the substep: less is no stiffness.
constexpr double least_stiffness = 1e-6;
/// Of the segment's length: what is wanted beyond a bound by less is rounding.
constexpr double rounding_of_winch = 1e-7;
/// Of the tension; it is kept as well as this. And of what strains it by rounding.
constexpr double kept_part = 1e-5, rounding_strain = 1e-10;

/// The mode to go on with in an iteration. Tension at one bound says nothing of whether the other is reached.
WinchMode mode_after(const WinchLaw& law, WinchMode mode, double wanted) {
  const WinchMode next = mode_of(law, wanted);
  return mode == WinchMode::keeps || next == mode ? next : WinchMode::keeps;
}

}  // namespace

void CableStepper::start_winch(const GrowingSegment& growing) {
  const int i = growing.segment;
  winch_.segment = i;
  winch_.law = growing.law;
  winch_.planned_rest = target_length_[i];
  winch_.planned_way = growing.way;
  winch_.planned_left = growing.left;
  winch_.rounded_way = growing.way - rest_growth_[i];
  winch_.beyond = growing.law.guess;
  winch_.mode = WinchMode::keeps;
  winch_.changed = false;
  winch_.changes = 0;
  rest_growth_[i] += winch_.beyond;
  length_[i] = get(segment_, i).norm();
}

Resistance<double> CableStepper::strain_resistance(const Substep& s, int i) const {
  return {axial_stiffness_[i], axial_damping_[i] / s.damping_time()};
}

/// As planned; what flows through a guide beside it counts.
WoundLength CableStepper::wound_length(const Substep& s) const {
  WoundLength wound;
  wound.end_rest = winch_.planned_rest + winch_.planned_left;
  wound.start_rest = wound.end_rest - winch_.planned_way;
  // However it is planned to get there: the strains of what is strained alike at the start and the end have one mean.
  wound.rest = wound.start_rest + s.part() * winch_.planned_way;
  wound.start_length = length_[winch_.segment];
  return wound;
}

/// [N/m] With which the inertia of the segment's nodes resists their motion in the substep, about.
double CableStepper::winch_resistance() const {
  return std::max(inertia_[winch_.segment], inertia_[winch_.segment + 1]);
}

/// [N/m]
double CableStepper::least_winch_stiffness() const {
  return least_stiffness * winch_resistance();
}

/// [m] That the rest length is to grow by beyond what is planned where the segment is `end` [m] long at the end.
double CableStepper::wanted_by_winch(const Substep& s, double end) const {
  const int i = winch_.segment;
  if (is_elastic_at(i)) return wanted_growth(strain_resistance(s, i), wound_length(s), winch_.law.tension, end);
  const double tension = tension_density_[i] * (length_[i] + s.part() * (end - length_[i]));
  const bool is_still = std::find(both_held_.begin(), both_held_.end(), i) != both_held_.end();
  return wanted_growth(winch_.planned_rest, winch_.law.tension, tension, end, is_still ? 0 : 1 / winch_resistance());
}

void CableStepper::wind_beyond(const Substep& s, double wanted) {
  const int i = winch_.segment;
  winch_.beyond = growth_in(winch_.law, winch_.mode, wanted);
  target_length_[i] = is_elastic_at(i) ? wound_length(s).rest + s.part() * winch_.beyond : winch_.planned_rest + winch_.beyond;
  rest_growth_[i] = winch_.planned_way + winch_.beyond;
}

/// The segment's row is that of a tension that is given, or of a rest length at a bound.
void CableStepper::evaluate_winch(const Substep& s) {
  const int i = winch_.segment;
  if (grows(i)) {
    winch_.planned_rest = target_length_[i];
    winch_.planned_way = rest_growth_[i] + winch_.rounded_way;
  }
  const double part = s.part(), end = std::sqrt(end_square_[i]), mean = length_[i] + part * (end - length_[i]);
  const double wanted = wanted_by_winch(s, end);
  const WinchMode mode = winch_.changes < most_changes ? mode_after(winch_.law, winch_.mode, wanted) : winch_.mode;
  winch_.changed = mode != winch_.mode;
  if (winch_.changed) ++winch_.changes;
  winch_.mode = mode;
  const bool keeps = winch_.mode == WinchMode::keeps;
  const double least = least_winch_stiffness();
  if (is_elastic_at(i)) {
    wind_beyond(s, wanted);
    const WoundTension wound = wound_tension(strain_resistance(s, i), wound_length(s), winch_.mode, winch_.beyond, end, part);
    set_row(i, keeps ? kept_row(wound, tension_density_[i], mean, end, part, least)
                     : elastic_row(wound.tension, wound.rise, tension_density_[i], mean, end, part));
    return;
  }
  wind_beyond(s, end - winch_.planned_rest);
  if (keeps)
    set_row(i, kept_row({winch_.law.tension, 0}, tension_density_[i], mean, end, part, least));
  else
    set_row(i, inextensible_row(end_square_[i], target_length_[i], strain_compliance_[i], tension_density_[i]));
}

/// [N] By which the tension is not that of the law. What the winch pulls hardly moves by it where the cable can stretch, so that
/// small corrections do not tell.
double CableStepper::kept_tension_error(const Substep& s, double end, double wanted) const {
  const int i = winch_.segment;
  const double tension = tension_density_[i] * (length_[i] + s.part() * (end - length_[i]));
  double law = winch_.law.tension;
  if (is_elastic_at(i)) {
    const double growth = growth_in(winch_.law, winch_.mode, wanted);
    law = wound_tension(strain_resistance(s, i), wound_length(s), winch_.mode, growth, end, s.part()).tension;
  }
  return tension - law;
}

/// Whether the corrected iterate has the mode that it calls for, and a tension that is kept.
bool CableStepper::winch_is_consistent(const Substep& s) const {
  const int i = winch_.segment;
  const double end = (get(segment_, i) + get(displacement_, i + 1) - get(displacement_, i)).norm();
  const double wanted = wanted_by_winch(s, end), slack = rounding_of_winch * target_length_[i];
  const double rounded = is_elastic_at(i) ? rounding_strain * axial_stiffness_[i] : slack * winch_resistance();
  if (winch_.mode == WinchMode::keeps || is_elastic_at(i))
    if (!(std::abs(kept_tension_error(s, end, wanted)) <= kept_part * winch_.law.tension + rounded)) return false;
  if (winch_.changes >= most_changes) return true;
  if (winch_.mode == WinchMode::least) return wanted <= winch_.law.least + slack;
  if (winch_.mode == WinchMode::most) return wanted >= winch_.law.most - slack;
  return wanted >= winch_.law.least - slack && wanted <= winch_.law.most + slack;
}

/// Of the solution, whose lengths have been measured.
void CableStepper::finish_winch(const Substep& s) {
  const int i = winch_.segment;
  const double end = std::sqrt(end_square_[i]);
  wind_beyond(s, is_elastic_at(i) ? wanted_by_winch(s, end) : end - winch_.planned_rest);
  for (GrowingSegment& growing : s.boundary.growing) {
    growing.beyond = winch_.beyond;
    growing.keeps_tension = winch_.mode == WinchMode::keeps;
    growing.growth += winch_.mode == WinchMode::least  ? winch_.law.least_rate
                      : winch_.mode == WinchMode::most ? winch_.law.most_rate
                                                       : winch_.beyond / s.h;
  }
}

/// [J] Of an elastic segment.
double CableStepper::strain_energy(int i, double rest, double length) const {
  return rest * Resistance<double>{axial_stiffness_[i], 0}.energy(length / rest - 1);
}

/// [J] The state's rest length has been planned; with that which the winch found, an elastic segment takes in another energy as
/// it is strained. The winch brings the difference, as if it had wound to that first.
double CableStepper::work_of_winch_beyond() const {
  const int i = winch_.segment;
  const auto gain = [&](double rest) {
    return strain_energy(i, rest, std::sqrt(end_square_[i])) - strain_energy(i, rest, length_[i]);
  };
  return gain(winch_.planned_rest) - gain(target_length_[i]);
}

/// [J] Where forces are taken at the end of the substep, an elastic segment has been wound to its rest length there before it was
/// strained. This is missing to both at once: what comes in, or goes out, has the strain at the end, and is pulled by that, so
/// that what the substep loses is the energy of the change of strain, which never is negative.
double CableStepper::work_of_winding_at_once(const Substep& s, const GrowingSegment& growing) const {
  if (s.part() < 1) return 0;
  const int i = growing.segment;
  const double way = growing.way + (i == winch_.segment ? winch_.beyond : 0), end = target_length_[i];
  const Resistance<double> resistance{axial_stiffness_[i], 0};
  const double strain = std::sqrt(end_square_[i]) / end - 1;
  const double at_once = -way * (resistance.stress(strain, 0) + resistance.energy(strain));
  return at_once - (strain_energy(i, end, length_[i]) - strain_energy(i, end - way, length_[i]));
}

}  // namespace verlet_cable
