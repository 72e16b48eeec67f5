#include <algorithm>
#include <cmath>
#include <utility>

#include "chain/direction.h"
#include "edit/problems.h"
#include "guide/node_passing.h"
#include "rod/unresolved_motion.h"
#include "scene/scene_size.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "world/energy.h"
#include "world/implementation.h"
#include "world/island_stepper.h"

namespace verlet_cable {

namespace {

/// Of a segment's length: the segment at a winch is split when longer, takes in its neighbour when shorter, and no segment gets
/// shorter than the last.
constexpr double longest_segment = 1.5, shortest_segment = 0.5, least_segment = 0.1;
/// A joint closes when its ends are this close, of a segment's length.
constexpr double closing_distance = 0.25;

/// The segments beside a node that is to go become one, of the longer one's material: the other weighs as much as that from now
/// on.
void take_on_material(int node, SimulatedCable& cable) {
  CableState& state = cable.state;
  const bool first_goes = state.rest_lengths[node - 1] < state.rest_lengths[node];
  const int going = first_goes ? node - 1 : node, kept = first_goes ? node : node - 1;
  const CableMaterials materials(cable);
  const double change = materials[kept].linear_density - materials[going].linear_density;
  if (change == 0) return;
  for (const int side : {0, 1}) state.masses[going + side] += 0.5 * change * state.rest_lengths[going];
}

/// At a winch the material moves through the end node. Adds (`side` 1) this motion to the node's velocity, or takes it away (-1).
void add_material_motion(const LengthDrive& drive, double side, CableState& cable) {
  if (!drive.is_winch()) return;
  const int n = cable.segments(), node = drive.end_node(n), i = drive.segment;
  const Vector3 along = segment_direction(cable, i);
  cable.velocities[node] += (node == 0 ? side : -side) * drive.fed_rate() * along;
}

/// [m/s] At which cable comes through a winch that gives way: where it cannot stretch, as fast as the nodes beside the winch
/// part; where it can, and waves shake them, as in the mean of the last step.
double rate_at_winch(const SimulatedCable& cable, const LengthDrive& drive) {
  if (is_elastic(CableMaterials(cable)[drive.segment])) return drive.rate + drive.slip;
  const int i = drive.segment;
  const Vector3 parting = cable.state.velocities[i + 1] - cable.state.velocities[i];
  return parting.dot(segment_direction(cable.state, i)) + drive.debt_rate;
}

LengthDrive::Place winch_place(bool at_end) {
  return at_end ? LengthDrive::Place::end : LengthDrive::Place::start;
}

/// What counts towards `limits.segments` beside a cable, with all that the other winches have been told to let out.
double size_beside(int index, const State& state) {
  double size = size_beside_cables(*state.scene);
  for (int i = 0; i < static_cast<int>(state.cables.size()); ++i) {
    if (i == index) continue;
    const std::optional<LengthDrive>& drive = state.cable_progress[i].drive;
    size += state.cables[i].state.segments();
    if (drive && drive->is_winch()) size += std::ceil(std::max(drive->left, 0.0) / state.cables[i].model->segment_length);
  }
  return size;
}

}  // namespace

/// What forbids a winch there; empty if nothing does.
std::string World::Implementation::refused_winch(int index, bool at_end) const {
  if (index < 0 || index >= static_cast<int>(state.cables.size()))
    return "cable: " + std::to_string(index) + "; must be the index of a cable";
  const CableModel& model = *state.cables[index].model;
  const std::optional<LengthDrive>& drive = state.cable_progress[index].drive;
  if (drive && !drive->is_winch())
    return "cable: " + model.name + " is still being drawn together with another by join; wait until they have met";
  if (drive && drive->place != winch_place(at_end))
    return "at_end: the winch at the other end of cable " + model.name + " " +
           (drive->heeds_tension() ? "goes by its tension; set a length there first, without max_tension"
                                   : "is still winding; wait until it is done");
  return {};
}

/// [m/s] One segment a step can be taken in, and is to be left over.
double World::Implementation::fastest_winch(int index) const {
  return shortest_segment * state.cables[index].model->segment_length / state.scene->time_step;
}

/// That which runs there, or a new one.
LengthDrive World::Implementation::winch_at(int index, bool at_end, double speed) const {
  const CableState& cable = state.cables[index].state;
  LengthDrive drive = state.cable_progress[index].drive.value_or(LengthDrive{});
  drive.place = winch_place(at_end);
  drive.segment = at_end ? cable.segments() - 1 : 0;
  drive.speed = speed;
  drive.acceleration = state.scene->winch_acceleration;
  drive.motor_speed = std::abs(drive.rate);
  drive.slip = 0;
  drive.left = 0;
  return drive;
}

/// [m] As limits.segments allows.
double World::Implementation::longest_cable(int index) const {
  return (state.scene->limits.segments - size_beside(index, state)) * state.cables[index].model->segment_length;
}

EditResult World::Implementation::apply(const edit::SetLength& change) {
  const auto [index, at_end, length, speed, max_tension] = change;
  if (const std::string reason = refused_winch(index, at_end); !reason.empty()) return refused(reason);
  const CableModel& model = *state.cables[index].model;
  const CableState& cable = state.cables[index].state;
  CableProgress& s = state.cable_progress[index];
  const double fastest = fastest_winch(index), longest = longest_cable(index);
  Problems problems;
  problems.require(length > 0 && length <= longest, "length", length,
                   "must be above 0, and at most " + rounded_bound_text(longest, -1) + " m, as limits.segments allows");
  problems.require(speed > 0 && speed <= fastest, "speed", speed,
                   "must be above 0, and at most " + rounded_bound_text(fastest, -1) + " m/s");
  problems.require(winch_tension.contains(max_tension), "max_tension", max_tension,
                   "allowed: " + winch_tension.text("N") + "; 0: none");
  if (!problems.text().empty()) return refused(problems.text());

  LengthDrive drive = winch_at(index, at_end, speed);
  drive.left = length - (cable.length() + drive.debt);
  drive.keeps_tension = false;
  drive.tension = max_tension > 0 ? max_tension : infinity;
  drive.min_length = 0;
  drive.max_length = infinity;
  const std::optional<LengthDrive> before = std::exchange(s.drive, drive);
  const double shortest = cable.length() - available_length(index);
  // A winch that slips does not pull the cable further than it reaches.
  const double needed = drive.heeds_tension() ? 0 : cable.length() - slack_at_winch(index);
  if (length >= shortest && length >= needed) {
    open_clamp(drive, state.attachments, cable.segments(), s.targets);
    return {true, "", model.name};
  }
  s.drive = before;
  return refused(
      "length: " + number_text(length) + "; must be at least " + rounded_bound_text(std::max(shortest, needed), 1) + " m, " +
      (needed > shortest ? "the distance of its attachments"
                         : "so that a part of a segment is left between the winch and the next attachment, payload or end"));
}

EditResult World::Implementation::apply(const edit::SetTension& change) {
  const auto [index, at_end, tension, max_speed, min_length, max_length] = change;
  if (const std::string reason = refused_winch(index, at_end); !reason.empty()) return refused(reason);
  const CableModel& model = *state.cables[index].model;
  const double fastest = fastest_winch(index);
  Problems problems;
  problems.require(winch_tension.contains(tension), "tension", tension, "allowed: " + winch_tension.text("N"));
  problems.require(max_speed > 0 && max_speed <= fastest, "max_speed", max_speed,
                   "must be above 0, and at most " + rounded_bound_text(fastest, -1) + " m/s");
  problems.require(not_negative.contains(min_length), "min_length", min_length, "allowed: " + not_negative.text("m"));
  problems.require(max_length > 0 && !(max_length < min_length), "max_length", max_length,
                   "must be above 0, and at least min_length, or .inf");
  if (!problems.text().empty()) return refused(problems.text());

  CableProgress& s = state.cable_progress[index];
  LengthDrive drive = winch_at(index, at_end, max_speed);
  drive.keeps_tension = true;
  drive.tension = tension;
  drive.min_length = min_length;
  drive.max_length = max_length;
  s.drive = drive;
  open_clamp(drive, state.attachments, state.cables[index].state.segments(), s.targets);
  return {true, "", model.name};
}

/// A winch that goes by its tension is gone where nothing holds it any longer: what leaves it moves on with the cable.
void World::Implementation::end_loose_winch(int index) {
  std::optional<LengthDrive>& drive = state.cable_progress[index].drive;
  CableState& cable = state.cables[index].state;
  if (!drive || !drive->is_winch() || !drive->heeds_tension() || is_attached(state, index, drive->end_node(cable.segments())))
    return;
  add_material_motion(*drive, 1, cable);
  drive.reset();
}

/// [m] That can be taken in: up to the next node that is attached or carries a payload, or to the other end.
double World::Implementation::available_length(int index) const {
  const SimulatedCable& cable = state.cables[index];
  const bool from_start = state.cable_progress[index].drive->place == LengthDrive::Place::start;
  const int n = cable.state.segments();
  int stop = from_start ? n : 0;
  for (const Attachment& a : state.attachments) {
    if (a.body != cable_id(index) || a.node == (from_start ? 0 : n) || a.guide >= 0) continue;
    stop = from_start ? std::min(stop, a.node) : std::max(stop, a.node);
  }
  const int step = from_start ? 1 : -1;
  double length = 0;
  for (int node = from_start ? 0 : n; node != stop; node += step) {
    length += cable.state.rest_lengths[from_start ? node : node - 1];
    if (node + step != stop && carries_payload(cable, node + step)) break;
  }
  return length - least_segment * cable.model->segment_length;
}

/// [m] That the cable between the winch and the next attachment is longer than they are apart; infinite where there are no two,
/// or where a body may follow.
double World::Implementation::slack_at_winch(int index) const {
  const SimulatedCable& cable = state.cables[index];
  const bool from_start = state.cable_progress[index].drive->place == LengthDrive::Place::start;
  const int end = from_start ? 0 : cable.state.segments();
  const Attachment *winch = nullptr, *next = nullptr;
  for (const Attachment& a : state.attachments) {
    if (a.body != cable_id(index) || a.guide >= 0) continue;
    if (a.node == end) {
      winch = &a;
    } else if (!next || std::abs(a.node - end) < std::abs(next->node - end)) {
      next = &a;
    }
  }
  if (!winch || !next || winch->holder != next->holder) return infinity;
  const auto place = [&](const Attachment& a) { return (state.frames.poses[a.frame] * a.pose).position; };
  return cable.state.length(std::min(end, next->node), std::max(end, next->node)) - (place(*winch) - place(*next)).norm();
}

void World::Implementation::plan_drive_step(int index) {
  CableProgress& s = state.cable_progress[index];
  SimulatedCable& cable = state.cables[index];
  if (!s.drive->is_winch() && cable.state.rest_lengths[s.drive->segment] <= closing_distance * cable.model->segment_length) {
    close_joint(index);
    account_for_edit(follow_energy_of_cable(index, state), state.ledger.balance);
    return;
  }
  plan_drive_of(index);
  if (s.drive->is_winch()) remesh_winch(index);
  LengthDrive& drive = *s.drive;
  if (drive.is_winch())
    stall(cable.state.rest_lengths[drive.segment] - least_segment * cable.model->segment_length, state.scene->time_step, drive);
  drive.start_length = cable.state.rest_lengths[drive.segment];
  for (const int side : {0, 1}) drive.start_masses[side] = cable.state.masses[drive.segment + side];
}

void World::Implementation::plan_drive_of(int index) {
  LengthDrive& drive = *state.cable_progress[index].drive;
  const double time_step = state.scene->time_step;
  if (!drive.is_winch()) return plan_drive(infinity, time_step, drive);
  const double available = available_length(index), length = state.cables[index].state.length() + drive.debt;
  if (!drive.heeds_tension()) return plan_drive(available, time_step, drive);
  const double most_out = std::min(drive.max_length, longest_cable(index)) - length;
  if (drive.keeps_tension)
    return plan_kept_tension(rate_at_winch(state.cables[index], drive), std::min(available, length - drive.min_length), most_out,
                             time_step, drive);
  plan_drive(available, time_step, drive);
  drive.fastest_out = std::max(most_out, 0.0) / time_step;
  if (!(drive.slip > 0)) return;
  // What slips goes on as it goes, however the motor is to wind meanwhile: what bends is to have the length that is found.
  const double going = rate_at_winch(state.cables[index], drive);
  drive.slip = going - drive.rate;
  drive.carried = std::clamp(going - drive.wound / time_step, 0.0, drive.fastest_out);
}

/// Segments appear and vanish at the winch, so that the one there stays about as long as the others.
void World::Implementation::remesh_winch(int index) {
  const SimulatedCable& cable = state.cables[index];
  const LengthDrive& drive = *state.cable_progress[index].drive;
  while (cable.state.rest_lengths[drive.segment] > longest_segment * cable.model->segment_length) add_winch_node(index);
  const auto too_short = [&] {
    return cable.state.rest_lengths[drive.segment] + std::min(drive.change, 0.0) < shortest_segment * cable.model->segment_length;
  };
  const auto is_free = [&](int node) {
    return node > 0 && node < cable.state.segments() && !carries_payload(cable, node) && !is_attached(state, index, node);
  };
  while (too_short() && is_free(drive.place == LengthDrive::Place::start ? 1 : cable.state.segments() - 1))
    take_in_winch_node(index);
}

void World::Implementation::add_winch_node(int index) {
  SimulatedCable& cable = state.cables[index];
  LengthDrive& drive = *state.cable_progress[index].drive;
  const double whole = cable.state.rest_lengths[drive.segment], regular = cable.model->segment_length;
  const int node = drive.segment + 1;
  add_material_motion(drive, 1, cable.state);
  insert_node(drive.segment, drive.place == LengthDrive::Place::start ? whole - regular : regular, *cable.model, cable.state);
  if (drive.place == LengthDrive::Place::end) ++drive.segment;
  add_material_motion(drive, -1, cable.state);
  renumber(index, node, 1);
  after_remeshing(index);
}

void World::Implementation::take_in_winch_node(int index) {
  SimulatedCable& cable = state.cables[index];
  CableProgress& s = state.cable_progress[index];
  LengthDrive& drive = *s.drive;
  const int node = drive.place == LengthDrive::Place::start ? 1 : cable.state.segments() - 1;
  add_material_motion(drive, 1, cable.state);
  take_on_material(node, cable);
  end_loads_of(index, node);
  // The step is planned already.
  const double lost = remove_node(node, cable.state);
  drive.debt += lost;
  drive.next_debt += lost;
  if (drive.place == LengthDrive::Place::end) --drive.segment;
  auto& held = s.targets.nodes;
  held.erase(std::remove_if(held.begin(), held.end(), [&](const KinematicTarget& h) { return h.node == node; }), held.end());
  renumber(index, node, -1);
  after_remeshing(index);
  add_material_motion(drive, -1, cable.state);
  move_with_holders(index, state);
}

/// The nodes of a cable from `first` on have moved by `shift`.
void World::Implementation::renumber(int index, int first, int shift) {
  const auto follow = [&](int& node) {
    if (node >= first) node += shift;
  };
  renumber_held(index, follow, state);
  for (Intrusion& intrusion : findings.intrusions)
    if (intrusion.cable == index) follow(intrusion.segment);
  for (StatusFinding& found : findings.statuses)
    if (found.body == cable_id(index)) follow(found.node);
  for (Excursion& excursion : findings.excursions)
    if (excursion.cable == index) follow(excursion.node);
}

void World::Implementation::after_remeshing(int index) {
  begin_anew(state.cables[index].state.unresolved);
  find_targets_of(index);
  forget_contacts(index);
}

/// What of the cable has come to its guides goes through.
void World::Implementation::pass_nodes_of(int index) {
  if (!pass_nodes(index, true, state)) return;
  keep_flow_at_drive(index, 0, state);  // the step is planned already
  findings.intrusions.erase(std::remove_if(findings.intrusions.begin(), findings.intrusions.end(),
                                           [&](const Intrusion& intrusion) { return intrusion.cable == index; }),
                            findings.intrusions.end());
  after_remeshing(index);
  move_with_holders(index, state);
  hold_gain(index, energy_of_cable(state, index).total() - state.cable_progress[index].energy, state);
  account_for_blow(index);
}

/// What names segments of a cable names others now.
void World::Implementation::forget_contacts(int index) {
  const std::uint32_t id = state.cable_progress[index].id;
  state.cable_progress[index].contacts.clear();
  for (CableProgress& progress : state.cable_progress) forget_cable(id, progress.contacts);
  findings.contacts.clear();
  findings.body_contacts.clear();
  islands.value.invalidate();
}

}  // namespace verlet_cable
