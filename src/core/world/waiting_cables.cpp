#include <algorithm>

#include "world/island_stepper.h"
#include "world/loads.h"

namespace verlet_cable {

/// False if the island is not one for lanes; the contacts of the whole step may be known then.
bool IslandStepper::wait_for_others(Island& island, IslandOutcome& found, bool& contacts_known) {
  if (island.cables.size() != 1 || !island.bodies.empty()) return false;
  const int cable = island.cables.front();
  CableProgress& memory = state_.cable_progress[cable];
  if (memory.level > 0 || memory.drive || slides(memory.targets) || is_loaded(cable, state_)) return false;
  const CableState& state = state_.cables[cable].state;
  Boundary unknown;
  const Substep substep = whole_step(cable, unknown);
  if (!fits_lanes(substep, state, !memory.targets.nodes.empty())) return false;
  begin(island);
  find_contacts(island, 0, 1);
  contacts_known = true;
  if (!workspace_.contacts.touches().empty() || !workspace_.contacts.intrusions().empty()) return false;
  WaitingCables& waiting = waiting_of(law_of(substep, state));
  if (waiting.boundaries.size() == waiting.cables.size()) waiting.boundaries.emplace_back();
  Boundary& boundary = waiting.boundaries[waiting.cables.size()];
  boundary.growing.clear();
  hold_at(0, 1, memory.targets, boundary);
  if (is_overstretched(whole_step(cable, boundary), state)) return false;
  waiting.cables.push_back({this, &island, &found});
  if (2 * static_cast<int>(waiting.cables.size()) == waiting.lanes) step_together(waiting);
  return true;
}

/// Of a cable that touches nothing.
Substep IslandStepper::whole_step(int cable, Boundary& boundary) {
  Substep substep{*state_.cables[cable].model, environment_, boundary, state_.cable_progress[cable].spans,
                  state_.scene->time_step};
  substep.middle = middle_of(0, 1);
  substep.scheme = scheme_of(cable);
  substep.tolerance = state_.scene->tolerance;
  if (state_.scene->numerical_damping) substep.treatment = Treatment::cleaning;
  return substep;
}

WaitingCables& IslandStepper::waiting_of(const LaneLaw& law) {
  std::vector<WaitingCables>& all = workspace_.waiting;
  auto same = std::find_if(all.begin(), all.end(), [&](const WaitingCables& w) { return w.law == law && w.lanes == lanes_; });
  if (same == all.end()) same = std::find_if(all.begin(), all.end(), [](const WaitingCables& w) { return w.cables.empty(); });
  if (same == all.end()) same = all.emplace(all.end());
  same->law = law;
  same->lanes = lanes_;
  return *same;
}

void IslandStepper::finish() {
  for (WaitingCables& waiting : workspace_.waiting)
    if (!waiting.cables.empty()) step_together(waiting);
}

void IslandStepper::step_together(WaitingCables& waiting) {
  std::vector<LaneMember>& members = workspace_.lane_members;
  members.clear();
  for (std::size_t k = 0; k < waiting.cables.size(); ++k) {
    const WaitingCable& w = waiting.cables[k];
    const int cable = w.island->cables.front();
    members.push_back({w.stepper->whole_step(cable, waiting.boundaries[k]), &w.stepper->state_.cables[cable].state, {}});
  }
  workspace_.lane_stepper.advance(members, waiting.lanes, workspace_.cables.front().stepper);
  for (std::size_t k = 0; k < members.size(); ++k) {
    const WaitingCable& w = waiting.cables[k];
    if (members[k].result.converged)
      w.stepper->complete_whole_step(*w.island, waiting.boundaries[k], members[k].result);
    else
      w.stepper->step_alone(*w.island, *w.found, false);
  }
  waiting.cables.clear();
}

void IslandStepper::complete_whole_step(const Island& island, Boundary& boundary, const SubstepResult& result) {
  const int cable = island.cables.front();
  CableProgress& memory = state_.cable_progress[cable];
  memory.contacts.clear();
  keep_lasting_forces(boundary, memory.targets);
  note_substep(cable, boundary, result, 1);
  outcomes_[cable].balance.dissipated.unresolved += std::max(0.0, unresolved_of(boundary, result));
  complete_cable(cable, boundary, 1);
}

}  // namespace verlet_cable
