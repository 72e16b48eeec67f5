#include <algorithm>
#include <cmath>
#include <utility>

#include "guide/guides.h"
#include "guide/node_passing.h"
#include "rod/initial_shape.h"
#include "rod/work_budget.h"
#include "world/balance.h"
#include "world/energy.h"
#include "world/island_stepper.h"
#include "world/step_progress.h"

namespace verlet_cable {

namespace {

using Status = StepResult::Status;

/// A substep that took no more iterations than this may be doubled; with contacts it always takes some more.
constexpr int easy_iterations = 6;
constexpr int easy_contact_iterations = 12;

int finest_level(double time_step) {
  return std::max(0, static_cast<int>(std::ceil(std::log2(time_step / shortest_substep))));
}

}  // namespace

double size_of(const Island& island, const State& state) {
  double size = budget::body * static_cast<double>(island.bodies.size());
  for (const int cable : island.cables)
    size += budget::heavy * visiting_work(state.cables[cable].state.segments(), count_flows(cable, state));
  return size;
}

/// `contacts_known`: those of the whole step have been found, and it is not split yet.
void IslandStepper::step_alone(Island& island, IslandOutcome& found, bool contacts_known) {
  begin(island);
  if (!island.bodies.empty()) update_body_targets(island, found);
  StepProgress progress;
  for (const int cable : island.cables) progress.level = std::max(progress.level, state_.cable_progress[cable].level);
  if (advance_within(budget::first_share * size_of(island, state_), island, progress, found, contacts_known))
    complete(island, progress, found);
  else
    found.unfinished = progress;
}

void IslandStepper::resume(Island& island, double allowance, IslandOutcome& found) {
  StepProgress progress = *found.unfinished;
  found.unfinished.reset();
  begin(island);
  if (!advance_within(progress.work + allowance, island, progress, found, false)) end_from_rest(island, progress, found);
  complete(island, progress, found);
}

/// As far as `most_work` goes; true at the end of the step.
bool IslandStepper::advance_within(double most_work, Island& island, StepProgress& progress, IslandOutcome& found,
                                   bool contacts_known) {
  const int finest = finest_level(state_.scene->time_step);
  const std::int64_t whole = std::int64_t{1} << finest;
  // An attempt that has begun may take as much more as a first share is.
  const double overrun = budget::first_share * size_of(island, state_);
  while (progress.done < whole) {
    if (progress.work >= most_work) return false;
    most_contact_work_ = most_work - progress.work + overrun;
    const std::int64_t ticks = whole >> progress.level;
    const bool splits = progress.level < finest;
    if (advance_part(island, {progress.done, progress.done + ticks, whole}, !splits, contacts_known, progress, found)) {
      if (progress.level > 0 && was_easy() && progress.done % (2 * ticks) == 0) --progress.level;
    } else if (splits) {
      if (!bends_columns_) ++progress.level;
    } else if (!progress.stopped) {
      stop(island, DegradedCause::no_solution, found);
      progress.stopped = true;
    } else {
      give_up(island, found);
      progress.done = whole;
    }
    contacts_known = false;
  }
  return true;
}

/// What is left of a step that took too much work: from rest, in one substep. The next step begins where this one was, in
/// substeps that may come somewhere.
void IslandStepper::end_from_rest(Island& island, StepProgress& progress, IslandOutcome& found) {
  const std::int64_t whole = std::int64_t{1} << finest_level(state_.scene->time_step);
  for (std::size_t k = 0; k < island.cables.size(); ++k) workspace_.cables[k].result.converged = false;
  stop(island, DegradedCause::too_much_work, found);
  most_contact_work_ = budget::last_share * size_of(island, state_);
  if (!advance_part(island, {progress.done, whole, whole}, true, false, progress, found)) give_up(island, found);
  found.exhausted = true;
}

/// One substep and what it found. False if it has not converged; the states are then as before.
bool IslandStepper::advance_part(Island& island, const PartOfStep& part, bool tolerated, bool contacts_known,
                                 StepProgress& progress, IslandOutcome& found) {
  if (!contacts_known) find_contacts(island, part.from(), part.to());
  note_intrusions(found.intrusions);
  const bool is_damped = damps(island);
  const double before = is_damped ? energy_at(island, part.from()) - accounted(island, found) : 0;
  const bool converged = advance(island, part.from(), part.to(), tolerated);
  progress.work += work_of_attempt(island);
  if (!converged) return false;
  progress.done = part.last;
  ++progress.substeps;
  double unresolved = std::exchange(substep_.dissipated.unresolved, 0.0);
  for (std::size_t k = 0; k < island.cables.size(); ++k) {
    CableWorkspace& of_cable = workspace_.cables[k];
    note_substep(island.cables[k], of_cable.boundary, of_cable.result, part.to() - part.from());
    unresolved += unresolved_of(of_cable.boundary, of_cable.result);
  }
  found.contacts.add(workspace_.contacts.touches(), workspace_.body_system.contacts().touches(), state_.cables,
                     part.to() - part.from());
  found.balance += substep_;
  // Of a substep that damps it is known what its laws do; the rest of what goes is what it is to take.
  if (is_damped) unresolved = before + accounted(island, found) - energy_at(island, part.to());
  found.balance.dissipated.unresolved += std::max(0.0, unresolved);
  return true;
}

/// [J] Motion of a cable that a substep has taken: none is made.
double IslandStepper::unresolved_of(const Boundary& boundary, const SubstepResult& substep) {
  return substep.balance.dissipated.unresolved + unresolved_work_of_holders(boundary);
}

/// Whether substeps damp what they do not resolve.
bool IslandStepper::damps(const Island& island) const {
  return std::any_of(island.cables.begin(), island.cables.end(),
                     [&](int cable) { return scheme_of(cable) != Scheme::conserving; });
}

/// [J]
double IslandStepper::energy_at(const Island& island, double part) {
  return energy_of(island, state_, part, workspace_.directions);
}

/// [J] That the step has brought, as far as it has come.
double IslandStepper::accounted(const Island& island, const IslandOutcome& found) const {
  double sum = found.balance.net();
  for (const int cable : island.cables) sum += outcomes_[cable].balance.net();
  return sum;
}

double IslandStepper::work_of_attempt(const Island& island) const {
  double work = contact_work_;
  if (!island.bodies.empty())
    work += budget::body * static_cast<double>(island.bodies.size()) * workspace_.body_system.solutions();
  for (std::size_t k = 0; k < island.cables.size(); ++k) {
    const CableWorkspace& of_cable = workspace_.cables[k];
    const bool on_bodies = of_cable.boundary.is_on_bodies();
    if (touches() && (workspace_.contacts.touched(k) || on_bodies)) continue;  // the contact solver has counted it
    const double visit =
        visiting_work(state_.cables[island.cables[k]].state.segments(), static_cast<double>(of_cable.boundary.flows.size()));
    work += (of_cable.stepper.is_whole_rod() || on_bodies ? budget::heavy : 1) * of_cable.result.iterations * visit;
  }
  return work;
}

/// What did not converge is stopped: its next step starts from rest.
void IslandStepper::stop(const Island& island, DegradedCause cause, IslandOutcome& found) {
  const double before = energy_at(island, 0);
  stop_bodies(island);
  if (!island.bodies.empty()) note_status(Status::degraded, rigid_body_id(island.bodies.front()), 0, found.bodies, cause);
  for (std::size_t k = 0; k < island.cables.size(); ++k) {
    if (workspace_.cables[k].result.converged) continue;
    CableState& state = state_.cables[island.cables[k]].state;
    bring_to_rest(state);
    stop_flows(island.cables[k], state_);
    std::fill(state.axial_multiplier.begin(), state.axial_multiplier.end(), 0.0);
    note_status(Status::degraded, cable_id(island.cables[k]), 0, outcomes_[island.cables[k]].result, cause);
  }
  account_for_unfollowed(energy_at(island, 0) - before, found.balance);
}

void IslandStepper::give_up(const Island& island, IslandOutcome& found) {
  const double before = energy_at(island, 1);
  const bool touching = touches();
  workspace_.contacts.touches().clear();  // their forces are of what was no solution, and may not even be numbers
  bool stuck = true;
  for (std::size_t k = 0; k < island.cables.size(); ++k)
    if (!workspace_.cables[k].result.converged)
      stuck = give_up(island.cables[k], workspace_.contacts.touched(k), workspace_.cables[k].boundary) && stuck;
  if (stuck && !touching && !island.bodies.empty()) hang_on_bodies_anew(island);
  account_for_unfollowed(energy_at(island, 1) - before, found.balance);
}

/// Not even from rest: the cable is put where its holders will be, and goes on from there; or hangs from them anew, where it
/// would be stuck with nothing around it. Whether it was there already.
bool IslandStepper::give_up(int index, bool touches, Boundary& boundary) {
  SimulatedCable& cable = state_.cables[index];
  hold_at(1, 1, state_.cable_progress[index].targets, boundary);
  hold_on_bodies(cable.state, state_.attachments, state_.bodies, state_.time(), state_.cable_progress[index].targets, boundary);
  const CableState before = cable.state;
  carry_along(*cable.model, boundary.nodes, gravity_near(state_, index), cable.state);
  const bool stuck = cable.state.positions == before.positions;
  const bool is_free = boundary.nodes.empty();
  if (!touches && stuck && !is_free) hang_anew(*cable.model, boundary.nodes, gravity_near(state_, index), cable.state);
  if (finite(cable.state.positions)) return stuck;
  cable.state = before;
  note_status(Status::fault, cable_id(index), 0, outcomes_[index].result);
  return false;
}

/// Whether the last substep may be doubled.
bool IslandStepper::was_easy() const {
  const int most = workspace_.participants.empty() ? easy_iterations : easy_contact_iterations;
  const auto end = workspace_.cables.begin() + static_cast<std::ptrdiff_t>(workspace_.members.size());
  return std::all_of(workspace_.cables.begin(), end,
                     [&](const CableWorkspace& of_cable) { return of_cable.result.iterations <= most; });
}

void IslandStepper::note_substep(int index, const Boundary& boundary, const SubstepResult& substep, double part) {
  StepResult& result = outcomes_[index].result;
  add_forces(boundary, state_.cable_progress[index].targets, state_.frames.poses, part, state_.attachments);
  EnergyBalance balance = substep.balance;
  balance.work.attachments += work_of_holders(boundary);
  balance.dissipated.unresolved = 0;  // is known of all that is stepped together
  outcomes_[index].balance += balance;
  result.max_strain = std::max(result.max_strain, substep.max_strain);
  result.iterations += substep.iterations;
  if (substep.overstretched_node >= 0) note_status(Status::overstretched, cable_id(index), substep.overstretched_node, result);
}

}  // namespace verlet_cable
