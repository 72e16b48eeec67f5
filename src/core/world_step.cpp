#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "initial_shape.h"
#include "length_projection.h"
#include "verlet_cable/core/world.h"
#include "world_implementation.h"

namespace verlet_cable {

namespace {

/// After so many substeps in one step a cable is not split further: whoever waits for it has waited long enough.
constexpr int maximum_substeps = 4096;
/// A substep that took no more iterations than this may be doubled; with contacts it always takes some more.
constexpr int easy_iterations = 6;
constexpr int easy_contact_iterations = 12;
/// Less [segments] is not worth another core.
constexpr int least_share = 500;

bool finite(const std::vector<Vector3>& vectors) {
  return std::all_of(vectors.begin(), vectors.end(), [](const Vector3& v) { return v.allFinite(); });
}

}  // namespace

StepResult World::step(const BoundaryInputs& inputs) {
  Implementation& w = *implementation_;
  StepResult result;
  result.ignored_frame = w.follow_frames(inputs);
  ++w.steps;
  for (Attachment& attachment : w.attachments) attachment.force = attachment.torque = Vector3::Zero();
  w.breaks.clear();
  w.jumps.clear();
  w.intrusions.clear();
  w.results.assign(w.cables.size(), StepResult{});
  w.step_groups();
  const int cables = static_cast<int>(w.cables.size());
  for (int cable = 0; cable < cables; ++cable) {
    const StepResult& of_cable = w.results[cable];
    note_status(of_cable.status, of_cable.cable, of_cable.node, result);
    result.substeps = std::max(result.substeps, of_cable.substeps);
    result.iterations += of_cable.iterations;
    result.max_strain = std::max(result.max_strain, of_cable.max_strain);
    const int segment = w.breaking_segment(cable, of_cable);
    if (segment < 0) continue;
    if (!cut(cable, segment).ok) continue;
    const int rest = static_cast<int>(w.cables.size()) - 1;
    w.breaks.push_back({cable, segment, rest});
    if (result.cable != cable || result.node <= segment) continue;
    result.cable = rest;
    result.node -= segment + 1;
  }
  w.step_nets_and_particles(result);
  return result;
}

void World::step_one_by_one(bool one_by_one) {
  implementation_->one_by_one = one_by_one;
}

/// Groups do not know of each other: the result is the same whether one after the other or all at once. Only winches and joints
/// that close number attachments anew, which others read.
void World::Implementation::step_groups() {
  std::size_t segments = 0;
  bool alone = one_by_one;
  for (std::size_t i = 0; i < cables.size(); ++i) {
    segments += cables[i].model.segments();
    alone = alone || scratch[i].reel;
  }
  if (alone || groups.size() < 2 || segments < 2 * least_share) {
    for (std::size_t i = 0; i < groups.size(); ++i) step_group(groups[i]);
  } else {
    const std::size_t share = std::max<std::size_t>(1, least_share * groups.size() / segments);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, groups.size(), share), [&](const auto& some) {
      for (std::size_t i = some.begin(); i < some.end(); ++i) step_group(groups[i]);
    });
  }
  for (const CableScratch& s : scratch) jumps.insert(jumps.end(), s.jumps.begin(), s.jumps.end());
  for (const ContactGroup& group : groups)
    intrusions.insert(intrusions.end(), group.scratch.intrusions.begin(), group.scratch.intrusions.end());
}

/// Steps cables in as many substeps as they need: halved where the solver does not converge, doubled where it does easily.
void World::Implementation::step_group(ContactGroup& group) {
  using Status = StepResult::Status;
  const double dt = scene.time_step;
  group.scratch.intrusions.clear();
  for (const int cable : group.cables) aim(cable);

  const int finest = std::max(0, static_cast<int>(std::ceil(std::log2(dt / shortest_substep))));
  const std::int64_t whole = std::int64_t{1} << finest;
  const double part = 1 / static_cast<double>(whole);
  std::int64_t done = 0;
  int substeps = 0;
  bool stopped = false;
  while (done < whole) {
    const std::int64_t ticks = whole >> group.level;
    const bool splits = group.level < finest && substeps < maximum_substeps;
    const bool converged = advance(group, part * static_cast<double>(done), part * static_cast<double>(done + ticks), !splits);
    if (!converged) {
      if (splits) {
        ++group.level;
      } else if (!stopped) {
        for (std::size_t k = 0; k < group.cables.size(); ++k) {
          if (group.scratch.results[k].converged) continue;
          CableState& state = cables[group.cables[k]].state;
          bring_to_rest(state);
          std::fill(state.axial_multiplier.begin(), state.axial_multiplier.end(), 0.0);
          note_status(Status::degraded, group.cables[k], 0, results[group.cables[k]]);
        }
        stopped = true;
      } else {
        for (std::size_t k = 0; k < group.cables.size(); ++k)
          if (!group.scratch.results[k].converged) give_up(group.cables[k]);
        break;
      }
      continue;
    }
    done += ticks;
    ++substeps;
    const bool touches = !group.scratch.participants.empty();
    const bool easy = std::all_of(group.scratch.results.begin(), group.scratch.results.end(), [&](const SubstepResult& substep) {
      return substep.iterations <= (touches ? easy_contact_iterations : easy_iterations);
    });
    for (std::size_t k = 0; k < group.cables.size(); ++k)
      note_substep(group.cables[k], group.scratch.results[k], static_cast<double>(ticks) * part);
    if (group.level > 0 && easy && done % (2 * ticks) == 0) --group.level;
  }
  for (const int cable : group.cables) {
    if (scratch[cable].reel) complete_reel_step(cable);
    follow_material(cable);
    results[cable].substeps = substeps;
    complete_step(dt, scratch[cable].holders);
    show_velocities(scratch[cable].holders, cables[cable].state.velocities);
  }
}

/// Aims a cable's holders at where they will be at the end of the step. Where they jump, the cable is carried along with them before
/// it is stepped, and keeps its velocities.
void World::Implementation::aim(int index) {
  SimulatedCable& cable = cables[index];
  CableScratch& s = scratch[index];
  if (s.reel) plan_reel_step(index);
  aim_holders(cable.model, attachments, poses, time(), s.holders);
  s.jumps.clear();
  take_back_shown_velocities(s.holders, cable.state.velocities);
  const Following following = follow_aims(attachments, time(), scene.time_step, s.holders, s.jumps);
  const bool jumps = following.jumping_node >= 0;
  if (!following.started && !jumps) return;
  hold_at(0, 0, s.holders, s.boundary);
  if (jumps) {
    carry_along(cable.model, s.boundary.nodes, gravity_near(index), cable.state);
    note_status(StepResult::Status::jumped, index, following.jumping_node, results[index]);
  }
  project_velocities(cable.model, s.boundary.nodes, cable.state.positions, cable.state.velocities);
}

/// Not even from rest: the cable is put where its holders will be, and goes on from there.
void World::Implementation::give_up(int index) {
  SimulatedCable& cable = cables[index];
  CableScratch& s = scratch[index];
  hold_at(1, 1, s.holders, s.boundary);
  const std::vector<Vector3> before = cable.state.positions;
  carry_along(cable.model, s.boundary.nodes, gravity_near(index), cable.state);
  if (finite(cable.state.positions)) return;
  cable.state.positions = before;
  note_status(StepResult::Status::fault, index, 0, results[index]);
}

void World::Implementation::note_substep(int index, const SubstepResult& substep, double part) {
  StepResult& result = results[index];
  add_forces(index, part);
  result.max_strain = std::max(result.max_strain, substep.max_strain);
  result.iterations += substep.iterations;
  if (substep.overstretched_node >= 0) note_status(StepResult::Status::overstretched, index, substep.overstretched_node, result);
}

/// One substep of a group, from one part of the step to another. False if it has not converged or cables have passed through
/// each other (where that is not `tolerated`); the states are then as before.
bool World::Implementation::advance(ContactGroup& group, double from, double to, bool tolerated) {
  const Environment environment{scene.gravity, scene.fluid};
  const double h = (to - from) * scene.time_step;
  find_contacts(group, from, to);
  const bool touching = !group.contacts.touches().empty();
  group.scratch.results.assign(group.cables.size(), SubstepResult{});
  group.scratch.before.resize(group.cables.size());
  group.scratch.spans_before.resize(group.cables.size());
  group.scratch.participants.clear();
  bool converged = true;
  for (std::size_t k = 0; k < group.cables.size(); ++k) {
    const int cable = group.cables[k];
    SimulatedCable& c = cables[cable];
    CableScratch& s = scratch[cable];
    hold_at(from, to, s.holders, s.boundary);
    if (s.reel) wind_reel(cable, from, to);
    if (touching || group.cables.size() > 1) {
      group.scratch.before[k] = c.state;
      group.scratch.spans_before[k] = s.spans;
    }
    const Substep substep{c.model, environment, s.boundary, s.spans, h};
    if (group.contacts.touched(cable)) {
      group.scratch.participants.push_back({static_cast<int>(k), cable, &s.stepper, substep, &c.state, {}});
    } else {
      group.scratch.results[k] = s.stepper.advance(substep, c.state);
      converged = converged && group.scratch.results[k].converged;
    }
  }
  if (converged && touching) {
    converged = group.scratch.stepper.advance(group.scratch.participants, group.contacts.touches());
    for (const Participant& p : group.scratch.participants) group.scratch.results[p.place] = p.result;
    if (converged && !tolerated) converged = !group.contacts.crossed(cables);
  }
  if (converged) {
    note_intrusions(group);
    group.contacts.keep();
  } else if (touching || group.cables.size() > 1) {
    for (std::size_t k = 0; k < group.cables.size(); ++k) {
      cables[group.cables[k]].state = group.scratch.before[k];
      scratch[group.cables[k]].spans = group.scratch.spans_before[k];
    }
  }
  return converged;
}

}  // namespace verlet_cable
