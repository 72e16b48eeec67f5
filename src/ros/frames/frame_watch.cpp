#include "frames/frame_watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

/// Less is not worth a word.
constexpr double least_distance = 5e-4;  // [m]
constexpr double least_degrees = 0.05;
/// Between reports of a frame's jumps.
constexpr Nanoseconds jump_period = 1000000000;
/// Between warnings of a frame whose poses are ignored.
const ros::WallDuration ignored_period(10.0);

std::vector<Attachment> attachments_of(int frame, const World& world) {
  std::vector<Attachment> attachments;
  for (const Attachment& attachment : world.attachments()) {
    if (attachment.frame == frame) attachments.push_back(attachment);
  }
  return attachments;
}

/// One event for each attachment of the frame, or one without if there is none.
void publish_for_frame(const EventPublisher& events, std::uint8_t type, int frame, Nanoseconds stamp, const World& world,
                       const std::string& message) {
  std::vector<EventSubject> subjects;
  for (const Attachment& attachment : attachments_of(frame, world)) subjects.push_back(subject_of(world, attachment));
  if (subjects.empty()) subjects.push_back({{}, {}, 0, world.frames()[frame]});
  events.publish_each(type, stamp, subjects, message);
}

std::string rounded(const char* format, double number) {
  char text[64];
  std::snprintf(text, sizeof text, format, number);
  return text;
}

/// How far a frame is from where it was held [m], [rad], and how fast that is made good [m/s].
std::string gap_words(double distance, double angle, double speed) {
  const double degrees = angle * 180 / M_PI;
  const bool is_away = distance >= least_distance, is_turned = degrees >= least_degrees;
  if (!is_away && !is_turned) return " where it was lost";
  std::string words = ", ";
  if (is_away) words += rounded("%.3g m", distance);
  if (is_away && is_turned) words += " and ";
  if (is_turned) words += rounded("%.3g degrees", degrees);
  words += " from where it was lost: what it holds goes there at ";
  if (is_away) words += rounded("%.3g m/s", speed);
  if (is_away && is_turned) words += " and ";
  if (is_turned) words += rounded("%.3g degrees/s", FrameGap::turn_speed * 180 / M_PI);
  return words;
}

const char* consequence(LostFramePolicy policy) {
  switch (policy) {
    case LostFramePolicy::hold:
      return "its attachments stay where they are until it is back (on_lost_frame: hold)";
    case LostFramePolicy::release:
      return "its attachments are released until reset (on_lost_frame: release)";
    default:
      return "the simulation waits until it is back (on_lost_frame: pause)";
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
  jumped_.clear();
  ignored_.clear();
}

bool FrameWatch::react(const std::vector<FrameChange>& changes, Nanoseconds stamp, World& world) {
  bool wait = false;
  for (const FrameChange& change : changes) {
    const std::string name = in_quotes(world.frames()[change.frame]);
    const bool needed = !attachments_of(change.frame, world).empty();
    switch (change.kind) {
      case FrameChange::Kind::seen:
        ROS_INFO("frame %s has appeared on tf and is followed", name.c_str());
        break;
      case FrameChange::Kind::too_fast:
        if (needed)
          ROS_WARN_THROTTLE(5, "frame %s moves faster than max_frame_speed, %g m/s: it is followed at that speed", name.c_str(),
                            max_frame_speed_);
        break;
      case FrameChange::Kind::lost:
        if (!needed && !has_obstacles(change.frame, world)) break;
        report_lost(change.frame, stamp, world);
        if (policy_ == LostFramePolicy::release) release(change.frame, stamp, world);
        wait |= needed && policy_ == LostFramePolicy::pause;
        break;
      case FrameChange::Kind::back:
        report_back(change, stamp, world);
        break;
    }
  }
  return wait;
}

void FrameWatch::report_jumps(Nanoseconds stamp, const World& world) {
  for (const Jump& jump : world.findings().jumps) {
    if (std::abs(jump.time - skipped_) < 0.5 * world.time_step()) continue;
    const Attachment& attachment = world.attachments()[jump.attachment];
    const auto [reported, is_new] = jumped_.emplace(attachment.frame, stamp);
    if (!is_new && stamp > reported->second && stamp - reported->second < jump_period) continue;
    reported->second = stamp;
    events_.publish(jump_event(world, jump), stamp);
  }
}

void FrameWatch::warn_of_ignored(const World& world, const BoundaryInputs& inputs) {
  const ros::WallTime now = ros::WallTime::now();
  for (std::size_t i = 1; i < inputs.size(); ++i) {
    const Vector3& position = inputs[i].pose.position;
    if (!inputs[i].known || is_sound(inputs[i].pose)) continue;
    ros::WallTime& last = ignored_[world.frames()[i]];
    if (now - last < ignored_period) continue;
    last = now;
    ROS_WARN("frame %s is at (%g, %g, %g): it is not followed there, and what it holds stays where it was; allowed: %s",
             in_quotes(world.frames()[i]).c_str(), position.x(), position.y(), position.z(), coordinate.text("m").c_str());
  }
}

void FrameWatch::report_lost(int frame, Nanoseconds stamp, const World& world) {
  lost_.insert(frame);
  publish_for_frame(
      events_, CableEvent::FRAME_LOST, frame, stamp, world,
      "frame " + in_quotes(world.frames()[frame]) + " is lost: nothing new on tf for longer than tf_timeout, " +
          number_text(timeout_) + " s; " +
          (attachments_of(frame, world).empty() ? "its obstacles stay where they are until it is back" : consequence(policy_)));
}

void FrameWatch::report_back(const FrameChange& change, Nanoseconds stamp, const World& world) {
  if (lost_.erase(change.frame) == 0) return;
  std::string message = "frame " + in_quotes(world.frames()[change.frame]) + " is back";
  if (policy_ != LostFramePolicy::release)
    message += gap_words(change.distance, change.angle, std::min(FrameGap::speed, max_frame_speed_));
  publish_for_frame(events_, CableEvent::FRAME_BACK, change.frame, stamp, world, message);
}

void FrameWatch::release(int frame, Nanoseconds stamp, World& world) const {
  for (const Attachment& attachment : attachments_of(frame, world)) {
    if (attachment.guide >= 0) continue;  // the cable goes on through it
    const EventSubject subject = subject_of(world, attachment);
    world.apply(edit::Unpin{attachment.name});
    events_.publish(CableEvent::UNPINNED, stamp, subject,
                    "attachment " + in_quotes(attachment.name) + " is released, as its frame is lost; reset restores it");
  }
}

bool has_obstacles(int frame, const World& world) {
  const auto follows = [&](const Obstacle& obstacle) { return obstacle.frame == frame; };
  return std::any_of(world.obstacles().begin(), world.obstacles().end(), follows);
}

std::vector<bool> awaited_frames(const World& world) {
  std::vector<bool> awaited = needed_frames(world);
  for (const Obstacle& obstacle : world.obstacles()) awaited[obstacle.frame] = true;
  for (const SimulatedGuide& guide : world.guides()) awaited[guide.frame] = true;  // open clips, too
  return awaited;
}

std::vector<bool> needed_frames(const World& world) {
  std::vector<bool> needed(world.frames().size(), false);
  for (const Attachment& attachment : world.attachments()) needed[attachment.frame] = true;
  return needed;
}

}  // namespace verlet_cable
