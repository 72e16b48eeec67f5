#include "interact/hands.h"

#include <utility>

#include "edit_requests/checked_pin.h"
#include "edit_requests/error_text.h"
#include "edit_requests/location.h"
#include "interact/reach.h"
#include "publish/conversions.h"
#include "publish/queue_size.h"
#include "requests/requested.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

using Feedback = visualization_msgs::InteractiveMarkerFeedback;

const ros::WallDuration show_period(0.05);
/// rviz is heard of four times a second while a handle is dragged, even where the mouse does not move.
const ros::WallDuration longest_silence(2);
constexpr std::size_t most_requests = 200;  // between two updates
constexpr double hand_log_period = 1;       // [s]

RequestedPlace place_of(const Handle& handle) {
  RequestedPlace place;
  place.cable = handle.cable;
  place.mode = RequestedPlace::at_node;
  place.node = handle.node;
  return place;
}

bool is_same(const Pose& a, const Pose& b) {
  return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
}

}  // namespace

Hands::Hands(ros::NodeHandle& private_node, Simulation& simulation)
    : simulation_(simulation),
      node_(private_node.getNamespace()),
      server_(private_node, "hands", [this](const Feedback& feedback) { receive(feedback); }) {}

void Hands::receive(const Feedback& feedback) {
  const bool drags = feedback.event_type == Feedback::POSE_UPDATE;
  const std::string& frame = feedback.header.frame_id;
  if (frame.size() > most_name_characters) {
    ROS_WARN_THROTTLE(hand_log_period, "hands: header.frame_id: %s; allowed: frames that tf knows", in_quotes(frame).c_str());
    return;
  }
  Request request{feedback.marker_name, feedback.event_type, feedback.menu_entry_id, frame, feedback.pose};
  if (drags && !requests_.empty() && requests_.back().type == request.type && requests_.back().handle == request.handle) {
    requests_.back() = std::move(request);
  } else if (requests_.size() < most_requests) {
    requests_.push_back(std::move(request));
  } else {
    ROS_WARN_THROTTLE(hand_log_period, "hands: more than %zu requests of rviz at once; the others are ignored", most_requests);
  }
}

std::deque<Hands::Request> Hands::take_requests() {
  return std::exchange(requests_, {});
}

void Hands::update() {
  for (const Request& request : take_requests()) apply(request);
  drop_lost_grabs();
  if (server_.viewers() == 0) return;
  const ros::WallTime now = ros::WallTime::now();
  if (now - last_shown_ < show_period) return;
  last_shown_ = now;
  show();
}

void Hands::apply(const Request& request) {
  const auto found = shown_.find(request.handle);
  if (found == shown_.end()) return;  // it has gone since
  const Handle& handle = found->second;
  EditResult result{true, {}, {}};
  if (request.type == Feedback::POSE_UPDATE) result = drag(handle, request);
  if (request.type == Feedback::MENU_SELECT) result = select(handle, request.menu_entry);
  if (request.type == Feedback::MOUSE_UP) let_go(handle.name);
  if (const auto grab = grabs_.find(handle.name); grab != grabs_.end()) grab->second.last = ros::WallTime::now();
  if (!result.ok) ROS_WARN_THROTTLE(hand_log_period, "hands: %s: %s", handle.name.c_str(), result.message.c_str());
}

EditResult Hands::drag(const Handle& handle, const Request& request) {
  std::vector<std::string> errors;
  const Pose pose = read_pose("pose", requested_pose(request.pose), errors);
  const std::string& fixed_frame = simulation_.scene().frame_id;
  const std::optional<Pose> frame = simulation_.find_frame(request.frame.empty() ? fixed_frame : request.frame);
  if (!frame) errors.push_back("header.frame_id: " + in_quotes(request.frame) + "; allowed: frames that tf knows, or empty");
  if (!errors.empty()) return refused(errors);
  const Pose place = *frame * pose;
  return handle.attachment.empty() ? drag_node(handle, place) : move(handle.attachment, place);
}

EditResult Hands::drag_node(const Handle& handle, Pose place) {
  const auto grab = grabs_.find(handle.name);
  if (grab != grabs_.end() && find(simulation_.world().attachments(), grab->second.attachment) >= 0)
    return move(grab->second.attachment, place);
  const EditResult pinned = pin(handle);
  if (!pinned.ok) return pinned;
  grabs_[handle.name] = {pinned.name, ros::WallTime::now()};
  return move(pinned.name, place);
}

EditResult Hands::select(const Handle& handle, std::uint32_t menu_entry) {
  switch (static_cast<HandleAction>(menu_entry)) {
    case HandleAction::pin:
      return pin(handle);
    case HandleAction::release:
      return simulation_.unpin(handle.attachment);
    case HandleAction::cut:
      return cut(handle);
    case HandleAction::reset:
      simulation_.reset([](const EditResult& result) {
        if (!result.ok) ROS_WARN_THROTTLE(hand_log_period, "hands: %s", result.message.c_str());
      });
      return {true, {}, {}};
  }
  return {false, "menu_entry_id: " + std::to_string(menu_entry) + "; allowed: 1 to 4", {}};
}

/// Where it is now, in the fixed frame.
EditResult Hands::pin(const Handle& handle) {
  RequestedPin request;
  request.place = place_of(handle);
  request.keep_offset = true;
  const CheckedPin pin =
      check_pin(request, simulation_.world(), [this](const std::string& frame) { return simulation_.find_frame(frame); });
  if (!pin.errors.empty()) return refused(pin.errors);
  return simulation_.pin("", pin, AttachmentType::hinge);
}

EditResult Hands::cut(const Handle& handle) {
  if (handle.cable.empty()) return refused({"menu_entry_id: 3; what holds a net or body has 2 and 4 only"});
  if (handle.is_body) return refused({"menu_entry_id: 3; a body has 1 and 4 only"});
  const Location location = locate_cut(place_of(handle), simulation_.world(), {});
  if (!location.errors.empty()) return refused(location.errors);
  return simulation_.cut(location);
}

/// Sends an attachment to a place in the fixed frame, as near as the cable allows.
EditResult Hands::move(const std::string& name, Pose place) {
  const World& world = simulation_.world();
  const int index = find(world.attachments(), name);
  if (index < 0) return refused({"attachment " + in_quotes(name) + " does not exist any more"});
  const Attachment& attachment = world.attachments()[index];
  if (attachment.body.is_cable())
    place.position = within_reach(world, attachment.body.index, attachment.node, name, place.position);
  return simulation_.move_attachment(name, world.frame_pose(attachment.frame).inverse() * place);
}

void Hands::let_go(const std::string& handle) {
  const auto grab = grabs_.find(handle);
  if (grab == grabs_.end()) return;
  // A reset has let go of it already.
  if (find(simulation_.world().attachments(), grab->second.attachment) >= 0) simulation_.unpin(grab->second.attachment);
  grabs_.erase(grab);
}

void Hands::drop_lost_grabs() {
  std::vector<std::string> lost;
  for (const auto& [handle, grab] : grabs_)
    if (ros::WallTime::now() - grab.last > longest_silence) lost.push_back(handle);
  for (const std::string& handle : lost) let_go(handle);
}

void Hands::show() {
  const DrawingFrame frame(simulation_.scene(), node_);
  if (!shown_frame_ || frame.name != shown_frame_->name || frame.origin != shown_frame_->origin) {
    server_.clear();
    shown_.clear();
    shown_frame_ = frame;
  }
  std::map<std::string, Handle> handles;
  for (Handle& handle : find_handles(simulation_, grabbed_attachments())) handles.emplace(handle.name, std::move(handle));
  for (const auto& [name, handle] : shown_)
    if (handles.count(name) == 0) server_.erase(name);
  for (const auto& [name, handle] : handles) {
    const auto before = shown_.find(name);
    if (before == shown_.end() || !look_alike(before->second, handle)) {
      server_.insert(interactive_marker(handle, frame));
    } else if (!is_same(before->second.pose, handle.pose) || server_.may_be_elsewhere(name)) {
      server_.set_pose(name, frame.pose(handle.pose));
    }
  }
  server_.apply_changes();
  shown_ = std::move(handles);
}

std::set<std::string> Hands::grabbed_attachments() const {
  std::set<std::string> attachments;
  for (const auto& [handle, grab] : grabs_) attachments.insert(grab.attachment);
  return attachments;
}

}  // namespace verlet_cable
