#include "verlet_cable/ros/frame_watch.h"

#include <algorithm>
#include <string>

#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

std::vector<Attachment> attachments_of(int frame, const World& world) {
  std::vector<Attachment> attachments;
  for (const Attachment& attachment : world.attachments()) {
    if (attachment.frame == frame) attachments.push_back(attachment);
  }
  return attachments;
}

bool has_obstacles(int frame, const World& world) {
  const auto follows = [&](const Obstacle& obstacle) { return obstacle.frame == frame; };
  return std::any_of(world.obstacles().begin(), world.obstacles().end(), follows);
}

/// One event for each attachment of the frame, or one without if there is none.
void publish_for_frame(const EventPublisher& events, std::uint8_t type, int frame, Nanoseconds stamp, const World& world,
                       const std::string& message) {
  std::vector<EventSubject> subjects;
  for (const Attachment& attachment : attachments_of(frame, world)) subjects.push_back(subject_of(world, attachment));
  if (subjects.empty()) subjects.push_back({{}, {}, 0, world.frames()[frame]});
  events.publish_each(type, stamp, subjects, message);
}

const char* consequence(LostFramePolicy policy) {
  switch (policy) {
    case LostFramePolicy::hold:
      return "its attachments stay where they are";
    case LostFramePolicy::release:
      return "its attachments are undone";
    default:
      return "the simulation waits";
  }
}

}  // namespace

FrameWatch::FrameWatch(const SceneDesc& scene, const EventPublisher& events)
    : policy_(scene.on_lost_frame), max_frame_speed_(scene.max_frame_speed), timeout_(scene.tf_timeout), events_(events) {}

void FrameWatch::watch(const SceneDesc& scene) {
  policy_ = scene.on_lost_frame;
  max_frame_speed_ = scene.max_frame_speed;
  timeout_ = scene.tf_timeout;
  lost_.clear();
}

bool FrameWatch::react(const std::vector<FrameChange>& changes, Nanoseconds stamp, World& world) {
  bool wait = false;
  for (const FrameChange& change : changes) {
    const std::string name = quoted(world.frames()[change.frame]);
    const bool needed = !attachments_of(change.frame, world).empty();
    switch (change.kind) {
      case FrameChange::Kind::seen:
        ROS_INFO("frame %s is there: it is followed", name.c_str());
        break;
      case FrameChange::Kind::too_fast:
        if (needed)
          ROS_WARN_THROTTLE(5, "frame %s is faster than max_frame_speed, %g m/s: followed at that", name.c_str(),
                            max_frame_speed_);
        break;
      case FrameChange::Kind::lost:
        if (!needed && !has_obstacles(change.frame, world)) break;
        report_lost(change.frame, stamp, world);
        if (policy_ == LostFramePolicy::release) release(change.frame, stamp, world);
        wait |= needed && policy_ == LostFramePolicy::pause;
        break;
      case FrameChange::Kind::back:
        report_back(change.frame, stamp, world);
        break;
    }
  }
  return wait;
}

void FrameWatch::report_unseen(const BoundaryInputs& inputs, const std::vector<FrameReport>& frames) const {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].status != FrameStatus::never_seen) continue;
    ROS_INFO(
        "frame %s was never seen: %s", quoted(frames[i].name).c_str(),
        inputs[i].known ? "its attachments wait at its initial_pose" : "its cables wait for it, its obstacles are not there");
  }
}

void FrameWatch::report_lost(int frame, Nanoseconds stamp, const World& world) {
  lost_.insert(frame);
  publish_for_frame(events_, CableEvent::FRAME_LOST, frame, stamp, world,
                    "frame " + quoted(world.frames()[frame]) + " is lost, tf has had nothing for more than tf_timeout, " +
                        number_text(timeout_) + " s: " +
                        (attachments_of(frame, world).empty() ? "its obstacles stay where they are" : consequence(policy_)));
}

void FrameWatch::report_back(int frame, Nanoseconds stamp, const World& world) {
  if (lost_.erase(frame) == 0) return;
  publish_for_frame(events_, CableEvent::FRAME_BACK, frame, stamp, world, "frame " + quoted(world.frames()[frame]) + " is back");
}

void FrameWatch::release(int frame, Nanoseconds stamp, World& world) const {
  for (const Attachment& attachment : attachments_of(frame, world)) {
    const EventSubject subject = subject_of(world, attachment);
    world.unpin(attachment.name);
    events_.publish(CableEvent::UNPINNED, stamp, subject,
                    "attachment " + quoted(attachment.name) + " is undone: its frame is lost");
  }
}

std::vector<bool> awaited_frames(const World& world) {
  std::vector<bool> awaited = needed_frames(world);
  for (const Obstacle& obstacle : world.obstacles()) awaited[obstacle.frame] = true;
  return awaited;
}

std::vector<bool> needed_frames(const World& world) {
  std::vector<bool> needed(world.frames().size(), false);
  for (const Attachment& attachment : world.attachments()) needed[attachment.frame] = true;
  return needed;
}

}  // namespace verlet_cable
