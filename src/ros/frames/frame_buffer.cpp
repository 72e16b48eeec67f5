#include "frames/frame_buffer.h"

#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "time/ros_time.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

const ros::Duration cache_time = ros::Duration().fromNSec(FrameBuffer::memory);
const ros::WallDuration source_memory(1.0);
const ros::WallDuration log_period(5.0);  // of each frame
/// tf2 never forgets a name: nobody's robot has so many, and a flood of names must not take all memory.
constexpr std::size_t most_frames = 20000;
constexpr std::size_t most_refused = 100;  // that are remembered

Pose to_pose(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const auto& r = transform.rotation;
  return {Vector3(t.x, t.y, t.z), Quaternion(r.w, r.x, r.y, r.z).normalized()};
}

geometry_msgs::Transform to_transform(const Pose& pose) {
  geometry_msgs::Transform transform;
  transform.translation.x = pose.position.x();
  transform.translation.y = pose.position.y();
  transform.translation.z = pose.position.z();
  transform.rotation.x = pose.orientation.x();
  transform.rotation.y = pose.orientation.y();
  transform.rotation.z = pose.orientation.z();
  transform.rotation.w = pose.orientation.w();
  return transform;
}

}  // namespace

std::string without_slash(const std::string& frame) {
  return frame.substr(frame.find('/') == 0 ? 1 : 0);
}

std::string transform_problem(const ReceivedTransform& received, Nanoseconds now) {
  // The tolerance that tf2 has on the squared length; it would refuse the same without saying so to us.
  constexpr double tolerance = 1e-2;
  const geometry_msgs::TransformStamped& transform = received.transform;
  const auto& t = transform.transform.translation;
  const auto& r = transform.transform.rotation;
  const double squared_length = r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w;
  const Nanoseconds stamp = from_ros_time(transform.header.stamp);
  const Nanoseconds latest = FrameBuffer::latest(now);
  std::ostringstream problem;
  if (without_slash(transform.child_frame_id).empty() || without_slash(transform.header.frame_id).empty()) {
    problem << "a frame without a name";
  } else if (!FrameBuffer::has_room_for_names(transform)) {
    problem << "a frame's name of " << std::max(transform.child_frame_id.size(), transform.header.frame_id.size())
            << " characters; allowed: at most " << most_name_characters;
  } else if (without_slash(transform.child_frame_id) == without_slash(transform.header.frame_id)) {
    problem << "a frame cannot be its own parent";
  } else if (!coordinate.contains(t.x) || !coordinate.contains(t.y) || !coordinate.contains(t.z)) {
    problem << "translation (" << t.x << ", " << t.y << ", " << t.z << "); allowed: " << coordinate.text("m");
  } else if (!(std::abs(squared_length - 1) <= tolerance)) {
    problem << "rotation (" << r.x << ", " << r.y << ", " << r.z << ", " << r.w << "); allowed: quaternions of length 1";
  } else if (!received.is_static && transform.header.stamp.isZero()) {
    problem << "stamp 0; allowed: the ROS time at which it holds";
  } else if (!is_normal(transform.header.stamp)) {
    problem << "stamp with " << transform.header.stamp.nsec << " ns after the second; allowed: less than 1000000000";
  } else if (!received.is_static && stamp > latest) {
    problem << "stamp " << transform.header.stamp.sec << " s";
    if (now > 0) problem << std::fixed << std::setprecision(3) << ", " << seconds(stamp - now) << " s ahead of ROS time";
    problem << "; allowed: up to " << latest / 1'000'000'000 << " s";
    if (now > 0) problem << ", " << FrameBuffer::most_ahead / 1'000'000'000 << " s ahead";
  }
  return problem.str();
}

FrameBuffer::FrameBuffer(std::string fixed_frame, std::size_t most_stored)
    : fixed_frame_(std::move(fixed_frame)), buffer_(cache_time), stored_(memory, most_stored) {}

bool FrameBuffer::has_room_for_names(const geometry_msgs::TransformStamped& transform) {
  return std::max(transform.child_frame_id.size(), transform.header.frame_id.size()) <= most_name_characters;
}

Nanoseconds FrameBuffer::latest(Nanoseconds now) {
  // What tf2 adds to a stamp stays a ROS time.
  const Nanoseconds last = last_ros_time - memory;
  return now > 0 ? std::min(now + most_ahead, last) : last;
}

bool FrameBuffer::reaches_beyond(Nanoseconds time) const {
  return std::any_of(newest_.begin(), newest_.end(), [time](const auto& newest) { return newest.second > time; });
}

void FrameBuffer::follow(double jump_speed, Nanoseconds longest_gap) {
  jump_speed_ = jump_speed;
  longest_gap_ = longest_gap;
  tracks_.clear();
}

std::vector<Nanoseconds> FrameBuffer::insert(const ReceivedTransform& received, Nanoseconds now,
                                             const std::vector<Vector3>& carried) {
  const std::string child = without_slash(received.transform.child_frame_id);
  if (!accept(received, child, now)) return {};
  if (received.is_static)
    return buffer_.setTransform(received.transform, "verlet_cable", true) ? std::vector<Nanoseconds>{0}
                                                                          : std::vector<Nanoseconds>{};
  const PoseSample sample{from_ros_time(received.transform.header.stamp), to_pose(received.transform.transform)};
  std::vector<Nanoseconds> known;
  geometry_msgs::TransformStamped played = received.transform;
  for (const PoseSample& pose : tracks_.try_emplace(child, jump_speed_, longest_gap_).first->second.add(sample, carried)) {
    // Points of a spline only where there is room for them.
    if (pose.is_between && !stored_.has_room(child, pose.stamp)) continue;
    played.header.stamp = to_ros_time(pose.stamp);
    // As it was sent, to the last bit.
    played.transform = pose.stamp == sample.stamp ? received.transform.transform : to_transform(pose.pose);
    if (play(played, child)) known.push_back(pose.stamp);
  }
  return known;
}

bool FrameBuffer::play(const geometry_msgs::TransformStamped& transform, const std::string& child) {
  if (!buffer_.setTransform(transform, "verlet_cable", false)) return false;
  stored_.add(child, from_ros_time(transform.header.stamp));
  return true;
}

/// Whether the transform can be used. Notes whose it is.
bool FrameBuffer::accept(const ReceivedTransform& received, const std::string& child, Nanoseconds now) {
  std::string problem = transform_problem(received, now);
  if (problem.empty() && !(know(child) && know(without_slash(received.transform.header.frame_id))))
    problem = "it would be more than " + std::to_string(most_frames) + " frames";
  if (!problem.empty()) {
    refuse(child.substr(0, most_name_characters), problem);
    return false;
  }
  refused_.erase(child);
  note_kind(child, received.is_static);
  if (!received.is_static) {
    note_source(child, received.source);
    // tf2 refuses repeated and very old stamps, too, but logs each of them.
    Nanoseconds& newest = newest_[child];
    const Nanoseconds stamp = from_ros_time(received.transform.header.stamp);
    if (stamp == newest || stamp < newest - memory) return false;
    if (!stored_.has_room(child, stamp)) {
      refuse(child, "more than " + std::to_string(stored_.most()) + " transforms in 60 s; allowed " +
                        (stored_.knows(child)
                             ? "of each frame for now: one in " + std::to_string(stored_.least_interval() / 1000) + " us"
                             : "for now: frames of which some are stored"));
      return false;
    }
    if (stamp > newest && note_parent(child, without_slash(received.transform.header.frame_id))) tracks_.erase(child);
    newest = std::max(newest, stamp);
  } else {
    note_parent(child, without_slash(received.transform.header.frame_id));
  }
  return true;
}

void FrameBuffer::see_from(const std::string& fixed_frame) {
  fixed_frame_ = fixed_frame;
  ++tree_version_;
}

void FrameBuffer::refuse(const std::string& child, const std::string& problem) {
  ++refused_count_;
  if (refused_.size() < most_refused || refused_.count(child) > 0) refused_[child] = problem;
  const ros::WallTime now = ros::WallTime::now();
  for (auto it = logged_.begin(); it != logged_.end();) it = now - it->second > log_period ? logged_.erase(it) : std::next(it);
  if (logged_.size() >= most_refused || !logged_.emplace(child, now).second) return;
  ROS_WARN("tf of frame %s refused: %s", in_quotes(child).c_str(), problem.c_str());
}

/// Whether tf2 may have the name.
bool FrameBuffer::know(const std::string& frame) {
  if (frames_.count(frame) > 0) return true;
  if (frames_.size() >= most_frames) return false;
  frames_.insert(frame);
  return true;
}

/// tf2 keeps a frame as what it came as first.
void FrameBuffer::note_kind(const std::string& child, bool is_static) {
  const bool was_static = static_.emplace(child, is_static).first->second;
  if (was_static == is_static || !mixed_.insert(child).second) return;
  if (is_static) {
    ROS_WARN(
        "frame %s came on /tf and now comes on /tf_static, which ROS cannot change while a node runs: it counts as lost; start "
        "the node again",
        in_quotes(child).c_str());
  } else {
    ROS_WARN(
        "frame %s came on /tf_static and now comes on /tf, which ROS cannot change while a node runs: it is followed with jerks; "
        "start the node again",
        in_quotes(child).c_str());
  }
}

/// Whether it has another one than before.
bool FrameBuffer::note_parent(const std::string& child, const std::string& parent) {
  std::string& known = parents_[child];
  if (known == parent) return false;
  known = parent;
  ++tree_version_;
  return true;
}

void FrameBuffer::note_source(const std::string& child, const std::string& source) {
  std::map<std::string, ros::WallTime>& sources = sources_[child];
  const ros::WallTime now = ros::WallTime::now();
  if (!sources.insert_or_assign(source, now).second || sources.size() == 1) return;
  for (auto it = sources.begin(); it != sources.end();) it = now - it->second > source_memory ? sources.erase(it) : std::next(it);
}

std::map<std::string, std::vector<std::string>> FrameBuffer::disputed() const {
  std::map<std::string, std::vector<std::string>> disputed;
  const ros::WallTime now = ros::WallTime::now();
  for (const auto& [child, sources] : sources_) {
    std::vector<std::string> names;
    for (const auto& [name, time] : sources)
      if (now - time <= source_memory) names.push_back(name);
    if (names.size() > 1) disputed.emplace(child, std::move(names));
  }
  return disputed;
}

void FrameBuffer::clear() {
  buffer_.clear();
  stored_.clear();
  newest_.clear();
  tracks_.clear();
}

std::optional<Pose> FrameBuffer::pose(const std::string& frame, Nanoseconds time) const {
  if (frame == fixed_frame_) return Pose{};
  try {
    const Pose pose = to_pose(buffer_.lookupTransform(fixed_frame_, frame, to_ros_time(time)).transform);
    // Finite transforms can multiply to what is not.
    if (pose.position.allFinite() && pose.orientation.coeffs().allFinite()) return pose;
  } catch (const std::runtime_error&) {  // tf2's own, and those of its arithmetic with times
  }
  return std::nullopt;
}

std::optional<Vector3> FrameBuffer::position_in(const std::string& other, const std::string& frame) const {
  try {
    const Vector3 position = to_pose(buffer_.lookupTransform(other, frame, ros::Time()).transform).position;
    if (position.allFinite()) return position;
  } catch (const std::runtime_error&) {
  }
  return std::nullopt;
}

std::optional<Nanoseconds> FrameBuffer::newest(const std::string& frame) const {
  if (frame == fixed_frame_) return 0;
  try {
    return from_ros_time(buffer_.lookupTransform(fixed_frame_, frame, ros::Time()).header.stamp);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

std::set<std::string> FrameBuffer::transforms_of(const std::string& frame) const {
  std::set<std::string> transforms;
  for (const std::string& from : {frame, fixed_frame_}) {
    // Frames may have come in a circle; tf2 says no pose then.
    for (auto edge = parents_.find(from); edge != parents_.end() && transforms.insert(edge->first).second;)
      edge = parents_.find(edge->second);
  }
  return transforms;
}

std::optional<std::string> FrameBuffer::other_root(const std::string& frame) const {
  if (frames_.count(frame) == 0) return std::nullopt;
  std::string root = root_of(frame);
  return root == root_of(fixed_frame_) ? std::nullopt : std::make_optional(std::move(root));
}

/// Of frames in a circle, any of them.
std::string FrameBuffer::root_of(const std::string& frame) const {
  std::set<std::string> seen{frame};
  std::string root = frame;
  for (auto edge = parents_.find(root); edge != parents_.end() && seen.insert(edge->second).second; edge = parents_.find(root))
    root = edge->second;
  return root;
}

}  // namespace verlet_cable
