#include <algorithm>
#include <numeric>

#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/world.h"
#include "world/energy.h"
#include "world/flush_denormals.h"
#include "world/implementation.h"
#include "world/invariant.h"
#include "world/island_stepper.h"
#include "world/limits.h"
#include "world/parallel_for.h"

namespace verlet_cable {

namespace {

/// Less [segments] is not worth another core.
constexpr int least_share = 500;

template <class T>
void append(const std::vector<T>& more, std::vector<T>& all) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

StepResult World::step(const BoundaryInputs& inputs) {
  const FlushDenormals flush_denormals;
  Implementation& w = *implementation_;
  StepResult result;
  w.begin_step(inputs, result);
  w.advance_islands();
  w.resume_islands(w.one_by_one);
  w.end_step(result);
  return result;
}

void World::Implementation::begin_step(const BoundaryInputs& inputs, StepResult& result) {
  count_step();
  result.ignored_frame = update_frames(inputs);
  advance_winches();
  advance_guides();
  wind_drives();
  assert_no_violation(state);
  build_islands();
}

FrameStep step_of_frames(const State& state) {
  return {state.scene->time_step, state.scene->jump_speed, state.frames.steps_unjudged == 0};
}

void World::note_left_out_time() {
  constexpr int unjudged = 2;  // in the second one the speed of frames changes back
  implementation_->state.frames.steps_unjudged = unjudged;
}

void World::Implementation::end_step(StepResult& result) {
  note_unsettled(told_unsettled);
  for (const StatusFinding& found : findings.statuses) note_status(found.status, found.body, found.node, result, found.cause);
  told_unsettled = findings.unsettled.size();
  collect_outcomes(result);
  close_ledger();
  find_excursions(findings.contacts, state, squeezes.value, findings.excursions);
  apply_breaks(result);
  end_loads();
  assert_no_violation(state);
  step_nets_and_particles(result);
  state.frames.steps_unjudged = std::max(state.frames.steps_unjudged - 1, 0);
}

void World::step_one_by_one(bool one_by_one) {
  implementation_->one_by_one = one_by_one;
}

void World::limit_lanes(int most) {
  implementation_->most_lanes = std::min(most < 4 ? 2 : most < 8 ? 4 : 8, widest_lanes());
}

void World::Implementation::count_step() {
  ++state.steps;
  forget_last_step();
  cable_outcomes.value.resize(state.cables.size());
  for (CableOutcome& outcome : cable_outcomes.value) {
    outcome.result = {};
    outcome.balance = {};
    outcome.change = 0;
    outcome.gave_way = false;
  }
}

void World::Implementation::forget_last_step() {
  findings.breaks.clear();
  findings.excursions.clear();
  findings.caught.clear();
  findings.released.clear();
  findings.ended_loads.clear();
  findings.jumps.clear();
  findings.intrusions.clear();
  findings.body_intrusions.clear();
  findings.statuses.clear();
  findings.contacts.clear();
  findings.body_contacts.clear();
  findings.unaccounted.clear();
}

/// Once of each body and status.
void World::Implementation::note(const StatusFinding& found, StepResult& result) {
  note_status(found.status, found.body, found.node, result, found.cause);
  std::vector<StatusFinding>& all = findings.statuses;
  const auto is_same = [&](const StatusFinding& other) { return other.body == found.body && other.status == found.status; };
  if (found.status != StepResult::Status::ok && std::none_of(all.begin(), all.end(), is_same)) all.push_back(found);
}

/// Of cables that found no equilibrium, from one of findings.unsettled on.
void World::Implementation::note_unsettled(std::size_t first) {
  StepResult none;
  for (std::size_t i = first; i < findings.unsettled.size(); ++i) {
    const int cable = find(state.cables, findings.unsettled[i]);
    if (cable >= 0) note({cable_id(cable), StepResult::Status::not_settled}, none);
  }
}

/// Winches and joints that close number nodes and attachments anew: one after the other.
void World::Implementation::advance_winches() {
  for (std::size_t i = 0; i < state.cables.size(); ++i)
    if (state.cable_progress[i].drive) plan_drive_step(static_cast<int>(i));
}

/// Once nodes are numbered anew, of segments as long as they are: where a clamp aims its second node depends on the length at the
/// end of the step.
void World::Implementation::wind_drives() {
  for (std::size_t i = 0; i < state.cables.size(); ++i) {
    const std::optional<LengthDrive>& drive = state.cable_progress[i].drive;
    if (!drive) continue;
    wind(*drive, 1, state.scene->time_step, *state.cables[i].model, state.cables[i].state);
    const double change = follow_energy_of_cable(static_cast<int>(i), state, workspaces.value.local().directions);
    cable_outcomes.value[i].change += change;
    cable_outcomes.value[i].balance.work.winches += change;
  }
}

/// Where cables may touch each other, that depends on where their targets take them.
void World::Implementation::build_islands() {
  if (are_islands_of_many(*state.scene)) {
    for (std::size_t i = 0; i < state.cables.size(); ++i)
      update_targets(static_cast<int>(i), state, cable_outcomes.value[i], workspaces.value.local().directions);
  }
  islands.value.build(state);
}

/// Islands do not know of each other: the result is the same whether one after the other or all at once.
void World::Implementation::advance_islands() {
  const auto advance = [&](std::size_t from, std::size_t to) {
    const FlushDenormals flush_denormals;
    IslandStepper stepper(state, workspaces.value.local(), cable_outcomes.value, most_lanes);
    step_islands(from, to, stepper);
    stepper.finish();
  };
  const std::size_t count = islands.value.all().size(), segments = islands.value.segments();
  island_outcomes.value.resize(count);
  if (one_by_one || count < 2 || segments < 2 * least_share) return advance(0, count);
  const std::size_t share = std::max<std::size_t>(1, least_share * count / segments);
  parallel_for(count, share, advance);
}

/// Islands that the first share of work was not enough for share what a step has for them by their sizes.
void World::Implementation::resume_islands(bool one_by_one) {
  std::vector<std::size_t> unfinished;
  for (std::size_t i = 0; i < island_outcomes.value.size(); ++i)
    if (island_outcomes.value[i].unfinished) unfinished.push_back(i);
  if (unfinished.empty()) return;
  std::vector<double> sizes;
  for (const std::size_t i : unfinished) sizes.push_back(size_of(islands.value.all()[i], state));
  const double size = std::accumulate(sizes.begin(), sizes.end(), 0.0);
  const auto resume = [&](std::size_t from, std::size_t to) {
    const FlushDenormals flush_denormals;
    IslandStepper stepper(state, workspaces.value.local(), cable_outcomes.value, most_lanes);
    for (std::size_t k = from; k < to; ++k) {
      Island& island = islands.value.all()[unfinished[k]];
      stepper.resume(island, SHARE_OF_STEP_BUDGET * budget::most * sizes[k] / size, island_outcomes.value[unfinished[k]]);
    }
  };
  if (one_by_one) return resume(0, unfinished.size());
  parallel_for(unfinished.size(), 1, resume);
}

void World::Implementation::step_islands(std::size_t from, std::size_t to, IslandStepper& stepper) {
  const bool updates_targets = !are_islands_of_many(*state.scene);
  for (std::size_t i = from; i < to; ++i) {
    if (updates_targets)
      for (const int cable : islands.value.all()[i].cables)
        update_targets(cable, state, cable_outcomes.value[cable], workspaces.value.local().directions);
    stepper.step(islands.value.all()[i], island_outcomes.value[i]);
  }
}

void World::Implementation::collect_outcomes(StepResult& result) {
  for (const CableOutcome& outcome : cable_outcomes.value) {
    note({outcome.result.body, outcome.result.status, outcome.result.node, outcome.result.max_strain, outcome.result.cause},
         result);
    result.substeps = std::max(result.substeps, outcome.result.substeps);
    result.iterations += outcome.result.iterations;
    result.max_strain = std::max(result.max_strain, outcome.result.max_strain);
    append(outcome.jumps, findings.jumps);
  }
  for (IslandOutcome& outcome : island_outcomes.value) {
    note({outcome.bodies.body, outcome.bodies.status, outcome.bodies.node, 0, outcome.bodies.cause}, result);
    result.exhausted = result.exhausted || outcome.exhausted;
    append(outcome.jumps, findings.jumps);
    append(outcome.intrusions, findings.intrusions);
    append(outcome.body_intrusions, findings.body_intrusions);
    outcome.contacts.collect(findings.contacts, findings.body_contacts);
  }
  for (const Intrusion& found : findings.intrusions) {
    const double strain = cable_outcomes.value[found.cable].result.max_strain;
    note({cable_id(found.cable), StepResult::Status::inside_obstacle, found.segment, strain}, result);
  }
  for (const BodyIntrusion& found : findings.body_intrusions)
    note({rigid_body_id(found.body), StepResult::Status::inside_obstacle}, result);
}

void World::Implementation::apply_breaks(StepResult& result) {
  for (int cable = 0; cable < static_cast<int>(cable_outcomes.value.size()); ++cable) {
    const int segment = cable_outcomes.value[cable].breaking_segment;
    if (segment < 0) continue;
    const double limit = CableMaterials(state.cables[cable])[segment].breaking_tension;
    const double before = state.cable_progress[cable].energy;
    if (!cut_cable(cable, segment).ok) continue;
    const int rest = static_cast<int>(state.cables.size()) - 1;
    follow_energy_of_cable(cable, state);
    follow_energy_of_cable(rest, state);
    account_for_edit(state.cable_progress[cable].energy + state.cable_progress[rest].energy - before, state.ledger.balance);
    findings.breaks.push_back({cable, segment, rest, limit});
    if (result.body != cable_id(cable) || result.node <= segment) continue;
    result.body = cable_id(rest);
    result.node -= segment + 1;
  }
}

}  // namespace verlet_cable
