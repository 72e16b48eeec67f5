#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>

#include "verlet_cable/core/world.h"
#include "world/implementation.h"

namespace verlet_cable {

namespace {

EditResult refused(const std::string& message) {
  return {false, message, {}};
}

bool holds_something(const std::vector<Attachment>& attachments, int cable, int node) {
  return std::any_of(attachments.begin(), attachments.end(),
                     [&](const Attachment& a) { return a.cable == cable && a.node == node; });
}

/// `base` followed by the lowest number for which `taken` is false.
template <typename Taken>
std::string numbered(const std::string& base, int first, const Taken& taken) {
  for (int i = first;; ++i) {
    const std::string name = base + std::to_string(i);
    if (!taken(name)) return name;
  }
}

/// The nodes `first` to `last` of a cable as a cable of their own.
SimulatedCable piece(const SimulatedCable& whole, int first, int last) {
  const auto part = [&](auto& v, int end) { v = std::decay_t<decltype(v)>(v.begin() + first, v.begin() + end); };
  SimulatedCable cable = whole;
  cable.state.reference_node = 0;
  cable.state.reference_orientation = segment_orientations(whole)[first];
  for (auto* of_segments : {&cable.model.rest_lengths, &cable.state.tension, &cable.state.axial_multiplier, &cable.state.twist})
    part(*of_segments, last);
  part(cable.model.masses, last + 1);
  if (!cable.model.rest_curvature.empty()) part(cable.model.rest_curvature, last + 1);
  if (!cable.model.flexible_fraction.empty()) part(cable.model.flexible_fraction, last + 1);
  for (auto* of_nodes : {&cable.state.positions, &cable.state.velocities, &cable.state.accelerations}) part(*of_nodes, last + 1);
  return cable;
}

template <typename HolderType>
void forget_attachment(int attachment, std::vector<HolderType>& targets) {
  targets.erase(std::remove_if(targets.begin(), targets.end(), [&](const HolderType& h) { return h.attachment == attachment; }),
                targets.end());
  for (HolderType& h : targets)
    if (h.attachment > attachment) --h.attachment;
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

EditResult World::pin(const std::string& name, int cable, int node, int frame, const Pose& pose, AttachmentType type) {
  Implementation& w = *implementation_;
  if (cable < 0 || cable >= static_cast<int>(w.state.cables.size()))
    return refused("cable: " + std::to_string(cable) + "; must be the index of a cable");
  SimulatedCable& held = w.state.cables[cable];
  if (node < 0 || node > held.model.segments())
    return refused("node: " + std::to_string(node) + "; must be from 0 to " + std::to_string(held.model.segments()));
  if (frame < 0 || frame >= static_cast<int>(w.state.frames.names.size()))
    return refused("frame: " + std::to_string(frame) + "; must be the id of a frame");
  if (const std::string problem = pose_problem("offset", pose); !problem.empty()) return refused(problem);
  if (!name.empty() && w.is_attachment(name)) return refused("name: " + name + "; is taken by another attachment");
  if (holds_something(w.state.attachments, cable, node))
    return refused("node: " + std::to_string(node) + " of cable " + held.model.name + "; is already held by an attachment");
  if (const std::optional<LengthDrive>& drive = w.state.cable_progress[cable].drive; drive && !drive->is_winch()) {
    const int other = node == drive->segment ? node + 1 : node == drive->segment + 1 ? node - 1 : -1;
    if (other >= 0 && holds_something(w.state.attachments, cable, other))
      return refused("node: " + std::to_string(node) + " of cable " + held.model.name + "; is being joined to node " +
                     std::to_string(other) + ", which is held by an attachment");
  }

  Attachment attachment;
  attachment.name = name.empty() ? numbered("pin", 1, [&](const std::string& n) { return w.is_attachment(n); }) : name;
  attachment.cable = cable;
  attachment.node = node;
  attachment.frame = frame;
  attachment.type = type;
  attachment.pose = {pose.position, pose.orientation.normalized()};
  w.state.attachments.push_back(attachment);
  w.find_targets_of(cable);
  return {true, "", attachment.name};
}

EditResult World::pin_net(const std::string& name, int net, int node, int frame, const Vector3& offset) {
  Implementation& w = *implementation_;
  if (net < 0 || net >= static_cast<int>(w.state.nets.size()))
    return refused("net: " + std::to_string(net) + "; must be the index of a net");
  const NetModel& model = w.state.nets[net].model;
  if (node < 0 || node >= model.nodes())
    return refused("node: " + std::to_string(node) + "; must be from 0 to " + std::to_string(model.nodes() - 1));
  if (frame < 0 || frame >= static_cast<int>(w.state.frames.names.size()))
    return refused("frame: " + std::to_string(frame) + "; must be the id of a frame");
  if (const std::string problem = pose_problem("offset", Pose{offset, Quaternion::Identity()}); !problem.empty())
    return refused(problem);
  if (!name.empty() && w.is_attachment(name)) return refused("name: " + name + "; is taken by another attachment");
  for (const Attachment& a : w.state.attachments)
    if (a.net == net && a.node == node)
      return refused("node: " + std::to_string(node) + " of net " + model.name + "; is already held by an attachment");
  Attachment attachment;
  attachment.name = name.empty() ? numbered("pin", 1, [&](const std::string& n) { return w.is_attachment(n); }) : name;
  attachment.cable = -1;
  attachment.net = net;
  attachment.node = node;
  attachment.frame = frame;
  attachment.pose.position = offset;
  w.state.attachments.push_back(attachment);
  w.update_net(net);
  return {true, "", attachment.name};
}

EditResult World::unpin(const std::string& name) {
  Implementation& w = *implementation_;
  const int index = find_attachment(name);
  if (index < 0) return refused("name: " + name + "; there is no such attachment");
  const int cable = w.state.attachments[index].cable, net = w.state.attachments[index].net;
  w.state.attachments.erase(w.state.attachments.begin() + index);
  for (CableProgress& s : w.state.cable_progress) {
    forget_attachment(index, s.targets.nodes);
    forget_attachment(index, s.targets.directions);
  }
  for (NetProgress& s : w.state.net_progress) forget_attachment(index, s.targets.nodes);
  if (net < 0)
    w.find_targets_of(cable);
  else
    w.update_net(net);
  return {true, "", name};
}

EditResult World::move_attachment(const std::string& name, const Pose& pose) {
  const int index = find_attachment(name);
  if (index < 0) return refused("name: " + name + "; there is no such attachment");
  if (const std::string problem = pose_problem("offset", pose); !problem.empty()) return refused(problem);
  implementation_->state.attachments[index].pose = {pose.position, pose.orientation.normalized()};
  return {true, "", name};
}

EditResult World::cut(int cable, int segment) {
  return implementation_->cut(cable, segment);
}

EditResult World::Implementation::cut(int cable, int segment) {
  if (cable < 0 || cable >= static_cast<int>(state.cables.size()))
    return refused("cable: " + std::to_string(cable) + "; must be the index of a cable");
  const int segments = state.cables[cable].model.segments();
  const std::string& name = state.cables[cable].model.name;
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
    const auto has_name = [&](const auto& desc) { return desc.name == n; };
    const auto any = [&](const auto& descs) { return std::any_of(descs.begin(), descs.end(), has_name); };
    const bool in_use =
        std::any_of(state.cables.begin(), state.cables.end(), [&](const SimulatedCable& c) { return c.model.name == n; });
    return in_use || any(state.scene->cables) || any(state.scene->nets) || any(state.scene->particles);
  };
  const SimulatedCable& whole = state.cables[cable];
  SimulatedCable first = piece(whole, 0, segment), second = piece(whole, segment + 1, segments);
  second.model.name = numbered(name + "_", 2, taken);

  const int new_cable = static_cast<int>(state.cables.size());
  const std::string new_name = second.model.name;
  state.cables[cable] = std::move(first);
  state.cables.push_back(std::move(second));
  follow_cut(cable, segment, new_cable);
  state.cable_progress.emplace_back();
  state.cable_progress.back().id = state.next_cable_id++;
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
  return {true, "", new_name};
}

/// What names places of a cable names those of its pieces.
void World::Implementation::follow_cut(int cable, int segment, int new_cable) {
  for (Attachment& a : state.attachments) {
    if (a.cable != cable || a.node <= segment) continue;
    a.cable = new_cable;
    a.node -= segment + 1;
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
}

int World::add_frame(const std::string& name, const std::optional<Pose>& pose) {
  Implementation& w = *implementation_;
  const int frame = w.state.frames.find(name);
  if (frame == static_cast<int>(w.state.frames.names.size())) {
    w.state.frames.names.push_back(name);
    w.state.frames.poses.emplace_back();
    w.state.frames.previous_poses.emplace_back();
    w.state.frames.known.push_back(false);
    w.find_obstacle_anchors();
  }
  if (pose && is_sound(*pose) && !w.state.frames.known[frame]) {
    w.state.frames.poses[frame] = w.state.frames.previous_poses[frame] = {pose->position, pose->orientation.normalized()};
    w.state.frames.known[frame] = true;
  }
  return frame;
}

}  // namespace verlet_cable
