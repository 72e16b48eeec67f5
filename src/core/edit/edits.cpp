#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "chain/node_arrays.h"
#include "edit/numbered_name.h"
#include "edit/used_names.h"
#include "guide/node_passing.h"
#include "rod/rod_frames.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/pin_rules.h"
#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/core/world.h"
#include "world/implementation.h"
#include "world/invariant.h"

namespace verlet_cable {

namespace {

/// Index of the body that joins a node to other cables, -1 if there is none.
int junction_at(const std::vector<Attachment>& attachments, const BodyId& body, int node) {
  const auto joint = std::find_if(attachments.begin(), attachments.end(),
                                  [&](const Attachment& a) { return a.body == body && a.node == node && a.is_junction; });
  return joint == attachments.end() ? -1 : joint->holder;
}

/// The nodes `first` to `last` of a cable as a cable of their own.
CableState piece(const CableState& whole, int first, int last) {
  CableState cable = whole;
  slice(first, last, cable);
  cable.reference_node = 0;
  cable.reference_orientation = segment_orientations(whole)[first];
  return cable;
}

/// Removes what belongs to an attachment, and renumbers the attachments of the rest.
template <typename Item>
void forget_attachment(int attachment, std::vector<Item>& items) {
  items.erase(std::remove_if(items.begin(), items.end(), [&](const Item& item) { return item.attachment == attachment; }),
              items.end());
  for (Item& item : items)
    if (item.attachment > attachment) --item.attachment;
}

/// Moves the holders from node `first_node` on to the second piece, whose nodes count from there.
template <typename HolderType>
void split_targets(int first_node, std::vector<HolderType>& first, std::vector<HolderType>& second) {
  for (HolderType h : first) {
    if (h.node < first_node) continue;
    h.node -= first_node;
    second.push_back(h);
  }
  first.erase(std::remove_if(first.begin(), first.end(), [&](const HolderType& h) { return h.node >= first_node; }), first.end());
}

}  // namespace

/// Whether an attachment has that name, or will have it when its frame is seen.
bool World::Implementation::is_attachment(const std::string& name) const {
  const auto has_name = [&](const auto& attachment) { return attachment.name == name; };
  const auto any = [&](const auto& list) { return std::any_of(list.begin(), list.end(), has_name); };
  return any(state.attachments) ||
         std::any_of(state.waiting_cables.begin(), state.waiting_cables.end(),
                     [&](int i) { return any(state.scene->cables[i].attachments); }) ||
         std::any_of(state.waiting_nets.begin(), state.waiting_nets.end(),
                     [&](int i) { return any(state.scene->nets[i].attachments); });
}

EditResult World::apply(const Edit& edit) {
  // Moves nothing: the energy stays.
  if (const auto* load = std::get_if<edit::ApplyLoad>(&edit)) return implementation_->apply(*load);
  const double energy = this->energy().total();
  EditResult result = std::visit([&](const auto& of_kind) { return implementation_->apply(of_kind); }, edit);
  if (result.ok) implementation_->account_for_edit_since(energy);
  assert_no_violation(implementation_->state);
  return result;
}

namespace {

std::string out_of_range(const char* what, int index) {
  return std::string(what) + ": " + std::to_string(index) + "; must be the index of a " + what;
}

}  // namespace

std::string node_problem(const State& state, const BodyId& body, int node) {
  if (body.is_rigid_body()) {
    if (body.index < 0 || body.index >= static_cast<int>(state.bodies.size())) return out_of_range("body", body.index);
    if (!state.body_progress[body.index].is_placed)
      return "body: " + std::to_string(body.index) + "; does not exist until the frames that hold it are known";
    return node == 0 ? "" : "node: " + std::to_string(node) + "; must be 0, the origin of the body's frame";
  }
  const bool is_net = body.is_net();
  const int bodies = static_cast<int>(is_net ? state.nets.size() : state.cables.size());
  if (body.index < 0 || body.index >= bodies) return out_of_range(is_net ? "net" : "cable", body.index);
  const int last = is_net ? state.nets[body.index].model.nodes() - 1 : state.cables[body.index].state.segments();
  if (node < 0 || node > last) return "node: " + std::to_string(node) + "; must be from 0 to " + std::to_string(last);
  return "";
}

namespace {

/// The other node at a joint that is closing, -1 if there is none.
int joining_node(const std::optional<LengthDrive>& drive, int node) {
  if (!drive || drive->is_winch()) return -1;
  return node == drive->segment ? node + 1 : node == drive->segment + 1 ? node - 1 : -1;
}

}  // namespace

EditResult World::Implementation::apply(const edit::Pin& pin) {
  if (const std::string problem = node_problem(state, pin.body, pin.node); !problem.empty()) return refused(problem);
  if (pin.frame < 0 || pin.frame >= static_cast<int>(state.frames.names.size()))
    return refused("frame: " + std::to_string(pin.frame) + "; must be the id of a frame");
  const int holder = state.body_of_frame(pin.frame);
  if (holder >= 0 && (!pin.body.is_cable() || pin.type != AttachmentType::hinge))
    return refused("frame: " + state.frames.names[pin.frame] +
                   "; belongs to a body, to which a pin can hold only nodes of cables, by a hinge");
  if (const std::string problem = pose_problem("offset", pin.pose); !problem.empty()) return refused(problem);
  if (!pin.name.empty() && is_attachment(pin.name)) return refused("name: " + pin.name + "; is taken by another attachment");
  const std::string node = "node: " + std::to_string(pin.node) + " of " +
                           (pin.body.is_rigid_body() ? "body " + state.bodies[pin.body.index].name
                            : pin.body.is_net()      ? "net " + state.nets[pin.body.index].model.name
                                                     : "cable " + state.cables[pin.body.index].model->name);
  if (const int other = holder_of(pin.body, pin.node, state.attachments); other >= 0)
    return refused(node + "; is already held by " + state.attachments[other].name);
  const int junction = junction_at(state.attachments, pin.body, pin.node);
  if (junction >= 0 && pin.type != AttachmentType::hinge)
    return refused(node + "; is at a junction, which a pin can hold only by a hinge");
  if (pin.body.is_cable()) {
    const int other = joining_node(state.cable_progress[pin.body.index].drive, pin.node);
    if (other >= 0 && holder_of(pin.body, other, state.attachments) >= 0)
      return refused(node + "; is being joined to node " + std::to_string(other) + ", which is held by an attachment");
    const SimulatedCable& cable = state.cables[pin.body.index];
    if (const NearGuide near = guide_near(pin.body, pin.node, cable, state.attachments); near.attachment >= 0)
      return refused(node + "; is " + rounded_text(near.distance) + " m of cable from guide " +
                     state.attachments[near.attachment].name + ", must be at least " +
                     rounded_bound_text(guide_room * cable.model->segment_length, 1) + " m from it");
  }
  Attachment attachment;
  attachment.name = pin.name.empty() ? numbered("pin", 1, [&](const std::string& n) { return is_attachment(n); }) : pin.name;
  attachment.body = pin.body;
  attachment.node = pin.node;
  attachment.frame = pin.frame;
  attachment.holder = holder;
  attachment.held_junction = junction;
  if (pin.body.is_cable()) attachment.type = pin.type;
  attachment.pose.position = pin.pose.position;
  if (pin.body.is_cable()) attachment.pose.orientation = pin.pose.orientation.normalized();
  state.attachments.push_back(attachment);
  if (pin.body.is_net()) update_net(pin.body.index);
  if (pin.body.is_cable()) {
    find_targets_of(pin.body.index);
    stop_at_pin(static_cast<int>(state.attachments.size()) - 1, state);
  }
  return {true, "", attachment.name};
}

EditResult World::Implementation::apply(const edit::Unpin& unpin) {
  const int index = find(state.attachments, unpin.name);
  if (index < 0) return refused("name: " + unpin.name + "; there is no such attachment");
  if (state.attachments[index].guide >= 0) return refused("name: " + unpin.name + "; is a guide, which cannot be unpinned");
  if (state.attachments[index].is_junction) return refused("name: " + unpin.name + "; is a junction, which cannot be unpinned");
  erase_attachment(index);
  return {true, "", unpin.name};
}

void World::Implementation::erase_attachment(int index) {
  const BodyId body = state.attachments[index].body;
  if (body.is_cable())
    for (const DirectionTarget& clamp : state.cable_progress[body.index].targets.directions)
      if (clamp.attachment == index) release_joint_twist(clamp, state.cables[body.index].state);
  state.attachments.erase(state.attachments.begin() + index);
  forget_attachment(index, findings.jumps);
  for (CableProgress& s : state.cable_progress) {
    forget_attachment(index, s.targets.nodes);
    forget_attachment(index, s.targets.directions);
  }
  for (NetProgress& s : state.net_progress) forget_attachment(index, s.targets.nodes);
  for (BodyProgress& s : state.body_progress) {
    const auto gone = std::find_if(s.holders.begin(), s.holders.end(),
                                   [&](const KinematicTarget& target) { return target.attachment == index; });
    if (gone != s.holders.end()) s.holder_spins.erase(s.holder_spins.begin() + (gone - s.holders.begin()));
    forget_attachment(index, s.holders);
    forget_attachment(index, s.joints);
    for (std::size_t k = 0; k < s.holders.size(); ++k) s.holders[k].node = static_cast<int>(k);
  }
  if (body.is_net()) update_net(body.index);
  if (!body.is_cable()) return;
  end_loose_winch(body.index);
  find_targets_of(body.index);
}

EditResult World::Implementation::apply(const edit::MoveAttachment& move) {
  const int index = find(state.attachments, move.name);
  if (index < 0) return refused("name: " + move.name + "; there is no such attachment");
  if (state.attachments[index].guide >= 0) return refused("name: " + move.name + "; is a guide, which only its frame can move");
  if (state.attachments[index].is_junction) return refused("name: " + move.name + "; is a junction, which only cables can move");
  if (const std::string problem = pose_problem("offset", move.pose); !problem.empty()) return refused(problem);
  state.attachments[index].pose = {move.pose.position, move.pose.orientation.normalized()};
  return {true, "", move.name};
}

EditResult World::Implementation::apply(const edit::Cut& cut) {
  return cut.body.is_net() ? cut_link(cut.body.index, cut.element) : cut_cable(cut.body.index, cut.element);
}

EditResult World::Implementation::cut_cable(int cable, int segment) {
  if (cable < 0 || cable >= static_cast<int>(state.cables.size()))
    return refused("cable: " + std::to_string(cable) + "; must be the index of a cable");
  const int segments = state.cables[cable].state.segments();
  const std::string& name = state.cables[cable].model->name;
  if (segments < 3) return refused("cable: " + name + "; has " + std::to_string(segments) + " segments, a cut needs 3");
  if (segment < 1 || segment > segments - 2)
    return refused("segment: " + std::to_string(segment) + " of cable " + name + "; must be from 1 to " +
                   std::to_string(segments - 2) + ", so that each piece keeps one");
  if (const std::optional<LengthDrive>& joint = state.cable_progress[cable].drive; joint && !joint->is_winch()) {
    if ((segment == 1 && joint->segment == 0) || (segment == segments - 2 && joint->segment == segments - 1))
      return refused("segment: " + std::to_string(segment) + " of cable " + name + "; this leaves only segment " +
                     std::to_string(joint->segment) + ", which is still being drawn in by join");
  }

  const auto taken = [&](const std::string& n) {
    return kind_with_name(n, state) != nullptr || any_has_name(n, state.bodies) || any_has_name(n, state.guides) ||
           any_has_name(n, state.obstacles);
  };
  release_wheels_on(cable, segment);
  CableModel model = *state.cables[cable].model;
  model.name = numbered(name + "_", 2, taken);

  const int new_cable = static_cast<int>(state.cables.size());
  const std::string new_name = model.name;
  const CableState& whole = state.cables[cable].state;
  CableState first = piece(whole, 0, segment), second = piece(whole, segment + 1, segments);
  state.cables[cable].state = std::move(first);
  state.cables.push_back({std::make_shared<const CableModel>(std::move(model)), std::move(second)});
  follow_cut(cable, segment, new_cable);
  const std::uint32_t id = state.new_cable_id();
  state.cable_progress.emplace_back().id = id;
  state.cable_progress[cable].level = 0;
  KinematicTargets &of_first = state.cable_progress[cable].targets, &of_second = state.cable_progress[new_cable].targets;
  split_targets(segment + 1, of_first.nodes, of_second.nodes);
  split_targets(segment + 1, of_first.directions, of_second.directions);
  std::optional<LengthDrive>&drive = state.cable_progress[cable].drive, &drive_of_second = state.cable_progress[new_cable].drive;
  if (drive && drive->segment > segment) {
    drive_of_second = drive;
    drive_of_second->segment -= segment + 1;
  }
  if (drive && drive->segment >= segment) drive.reset();
  for (const int piece : {cable, new_cable}) after_remeshing(piece);
  release_bare_guides();
  return {true, "", new_name};
}

/// What names places of a cable names those of its pieces.
void World::Implementation::follow_cut(int cable, int segment, int new_cable) {
  for (Attachment& a : state.attachments) {
    if (a.body != cable_id(cable) || a.node <= segment) continue;
    a.body = cable_id(new_cable);
    a.node -= segment + 1;
  }
  for (Load& load : state.loads) {
    if (load.body != cable_id(cable) || load.node <= segment) continue;
    load.body = cable_id(new_cable);
    load.node -= segment + 1;
  }
  for (Intrusion& intrusion : findings.intrusions) {
    if (intrusion.cable != cable || intrusion.segment < segment) continue;
    if (intrusion.segment == segment) {
      --intrusion.segment;
      continue;
    }
    intrusion.cable = new_cable;
    intrusion.segment -= segment + 1;
  }
  for (StatusFinding& found : findings.statuses) {
    if (found.body != cable_id(cable) || found.node <= segment) continue;
    found.body = cable_id(new_cable);
    found.node -= segment + 1;
  }
  for (Excursion& excursion : findings.excursions) {
    if (excursion.cable != cable || excursion.node < segment) continue;
    if (excursion.node == segment) {
      if (excursion.kind == Excursion::Kind::tension) --excursion.node;  // of the segment that is gone
      continue;
    }
    excursion.cable = new_cable;
    excursion.node -= segment + 1;
  }
}

int World::add_frame(const std::string& name, const std::optional<Pose>& pose) {
  Implementation& w = *implementation_;
  const int frame = w.state.frames.find(name);
  if (frame == static_cast<int>(w.state.frames.names.size())) {
    w.state.frames.names.push_back(name);
    w.state.frames.poses.emplace_back();
    w.state.frames.previous_poses.emplace_back();
    w.state.frames.earlier_poses.emplace_back();
    w.state.frames.known.push_back(false);
    if (w.state.scene->robot) w.find_obstacle_anchors();
  }
  if (pose && is_sound(*pose) && !w.state.frames.known[frame]) {
    const Pose sound{pose->position, pose->orientation.normalized()};
    w.state.frames.poses[frame] = w.state.frames.previous_poses[frame] = w.state.frames.earlier_poses[frame] = sound;
    w.state.frames.known[frame] = true;
  }
  return frame;
}

}  // namespace verlet_cable
