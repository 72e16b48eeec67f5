#include "verlet_cable/ros/frame_buffer.h"

#include <ros/console.h>
#include <tf2/exceptions.h>

#include <cmath>
#include <iterator>
#include <sstream>
#include <utility>

#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

const ros::Duration cache_time = ros::Duration().fromNSec(FrameBuffer::memory);
const ros::WallDuration source_memory(1.0);
const ros::WallDuration log_period(5.0);  // of each frame

std::string without_slash(const std::string& frame) {
  return frame.substr(frame.find('/') == 0 ? 1 : 0);
}

ros::Time to_ros(Nanoseconds time) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(time));
}

Pose to_pose(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const auto& r = transform.rotation;
  return {Vector3(t.x, t.y, t.z), Quaternion(r.w, r.x, r.y, r.z).normalized()};
}

}  // namespace

std::string transform_problem(const ReceivedTransform& received) {
  // The tolerance that tf2 has on the squared length; it would refuse the same without saying so to us.
  constexpr double tolerance = 1e-2;
  const geometry_msgs::TransformStamped& transform = received.transform;
  const auto& t = transform.transform.translation;
  const auto& r = transform.transform.rotation;
  const double squared_length = r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w;
  std::ostringstream problem;
  if (without_slash(transform.child_frame_id).empty() || without_slash(transform.header.frame_id).empty()) {
    problem << "a frame without a name";
  } else if (without_slash(transform.child_frame_id) == without_slash(transform.header.frame_id)) {
    problem << "its parent is itself";
  } else if (!coordinate.contains(t.x) || !coordinate.contains(t.y) || !coordinate.contains(t.z)) {
    problem << "translation (" << t.x << ", " << t.y << ", " << t.z << "); allowed: " << coordinate.text("m");
  } else if (!(std::abs(squared_length - 1) <= tolerance)) {
    problem << "rotation (" << r.x << ", " << r.y << ", " << r.z << ", " << r.w << "); allowed: quaternions of length 1";
  } else if (!received.is_static && transform.header.stamp.isZero()) {
    problem << "stamp 0; allowed: the ROS time at which it holds";
  }
  return problem.str();
}

FrameBuffer::FrameBuffer(std::string fixed_frame) : fixed_frame_(std::move(fixed_frame)), buffer_(cache_time) {}

bool FrameBuffer::insert(const ReceivedTransform& received) {
  const std::string child = without_slash(received.transform.child_frame_id);
  const std::string problem = transform_problem(received);
  if (!problem.empty()) {
    ++refused_count_;
    refused_[child] = problem;
    ros::WallTime& logged = logged_[child];
    if (ros::WallTime::now() - logged > log_period) {
      logged = ros::WallTime::now();
      ROS_WARN("tf of frame %s refused: %s", quoted(child).c_str(), problem.c_str());
    }
    return false;
  }
  refused_.erase(child);
  if (!received.is_static) {
    note_source(child, received.source);
    // tf2 refuses repeated and very old stamps, too, but logs each of them.
    ros::Time& newest = newest_[child];
    const ros::Time& stamp = received.transform.header.stamp;
    if (stamp == newest || stamp + cache_time < newest) return false;
    newest = std::max(newest, stamp);
  }
  return buffer_.setTransform(received.transform, "verlet_cable", received.is_static);
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
  newest_.clear();
}

std::optional<Pose> FrameBuffer::pose(const std::string& frame, Nanoseconds time) const {
  if (frame == fixed_frame_) return Pose{};
  try {
    const Pose pose = to_pose(buffer_.lookupTransform(fixed_frame_, frame, to_ros(time)).transform);
    // Finite transforms can multiply to what is not.
    if (pose.position.allFinite() && pose.orientation.coeffs().allFinite()) return pose;
  } catch (const tf2::TransformException&) {
  }
  return std::nullopt;
}

std::optional<Nanoseconds> FrameBuffer::newest(const std::string& frame) const {
  if (frame == fixed_frame_) return 0;
  try {
    return static_cast<Nanoseconds>(buffer_.lookupTransform(fixed_frame_, frame, ros::Time()).header.stamp.toNSec());
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

}  // namespace verlet_cable
