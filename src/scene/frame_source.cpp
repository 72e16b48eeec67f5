#include "frame_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "pose_bytes.h"

namespace verlet_cable {
namespace {

/// What is fixed to a moving parent.
FrameInput carried(const FrameInput& parent, const Pose& origin) {
  const Vector3 arm = parent.pose.orientation * origin.position;
  const FrameVelocity& velocity = *parent.velocity;
  return {parent.pose * origin, true, FrameVelocity{velocity.linear + velocity.angular.cross(arm), velocity.angular}};
}

}  // namespace

FrameSource::FrameSource(const SceneDesc& scene, const Motion& motion) : jump_speed_(scene.jump_speed) {
  const std::vector<std::string> names = frame_names(scene);
  const BoundaryInputs initial = initial_frames(scene);
  ids_ = static_cast<int>(names.size());
  for (int id = 0; id < ids_; ++id) add_frame(id, names[id], initial[id], motion);
  if (!scene.robot) return;
  for (const LinkDesc& desc : scene.robot->tree) {
    Link link;
    link.name = desc.name;
    link.parent = desc.parent;
    link.origin = pose_of(desc.origin);
    const auto id = static_cast<std::size_t>(std::find(names.begin(), names.end(), desc.name) - names.begin());
    const bool used = id < names.size();
    if (used) link.id = static_cast<int>(id);
    if (motion.count(desc.name) || (used && initial[id].known))
      link.frame = used ? static_cast<int>(id) : add_frame(-1, desc.name, {}, motion);
    links_.push_back(link);
  }
}

FrameSource::FrameSource(ByteReader& bytes, std::size_t most_ids) {
  const auto require_one_of = [](int index, std::size_t count) {
    if (index < -1 || index >= static_cast<int>(count)) throw std::invalid_argument("a frame or link is not there");
  };
  bytes(jump_speed_);
  bytes(ids_);
  if (ids_ < 0 || static_cast<std::size_t>(ids_) > most_ids) throw std::invalid_argument("they are of other frames");
  frames_.resize(bytes.read_length());
  for (Frame& frame : frames_) {
    bytes(frame.id);
    require_one_of(frame.id, ids_);
    std::vector<double> times;
    bytes.read_list(times);
    double latest = -std::numeric_limits<double>::infinity();
    for (const double time : times) {
      if (!(time > latest && std::isfinite(time))) throw std::invalid_argument("the times of a frame do not ascend");
      frame.track.add(time, read_pose(bytes));
      latest = time;
    }
    frame.track.find_jumps(jump_speed_);
    frame.resting = read_pose(bytes);
  }
  links_.resize(bytes.read_length());
  for (Link& link : links_) {
    link.name = bytes.read_text();
    bytes(link.frame);
    require_one_of(link.frame, frames_.size());
    bytes(link.parent);
    require_one_of(link.parent, static_cast<std::size_t>(&link - links_.data()));
    link.origin = read_pose(bytes);
    bytes(link.id);
    require_one_of(link.id, ids_);
  }
}

void FrameSource::write(ByteWriter& bytes) const {
  bytes(jump_speed_);
  bytes(ids_);
  bytes(frames_.size());
  for (const Frame& frame : frames_) {
    bytes(frame.id);
    bytes.write_list(frame.track.times());
    for (const Pose& pose : frame.track.poses()) write_pose(pose, bytes);
    write_pose(frame.resting, bytes);
  }
  bytes(links_.size());
  for (const Link& link : links_) {
    bytes.write_text(link.name);
    bytes(link.frame);
    bytes(link.parent);
    write_pose(link.origin, bytes);
    bytes(link.id);
  }
}

int FrameSource::add_frame(int id, const std::string& name, const FrameInput& resting, const Motion& motion) {
  const auto track = motion.find(name);
  frames_.push_back({id, track == motion.end() ? FrameTrack{} : track->second, resting.pose});
  frames_.back().track.find_jumps(jump_speed_);
  return static_cast<int>(frames_.size()) - 1;
}

void FrameSource::place(int id, const Pose& resting) {
  for (Frame& frame : frames_)
    if (frame.id == id) frame.resting = resting;
}

bool FrameSource::is_link(const std::string& name) const {
  return std::any_of(links_.begin(), links_.end(), [&](const Link& link) { return link.name == name; });
}

void FrameSource::add(const std::string& name, int id, const Pose& resting) {
  ids_ = std::max(ids_, id + 1);
  const auto link = std::find_if(links_.begin(), links_.end(), [&](const Link& other) { return other.name == name; });
  if (link == links_.end()) {
    frames_.push_back({id, {}, resting});
    return;
  }
  link->id = id;
  if (link->frame >= 0) frames_[link->frame].id = id;
}

BoundaryInputs FrameSource::at(double time) const {
  return at(time, {});
}

bool FrameSource::rests() const {
  return std::all_of(frames_.begin(), frames_.end(), [](const Frame& frame) { return frame.track.empty(); });
}

BoundaryInputs FrameSource::at(double time, const PosesById& given) const {
  BoundaryInputs placed;  // one a frame
  BoundaryInputs inputs(ids_, FrameInput{{}, false, FrameVelocity{}});
  for (const Frame& frame : frames_) {
    placed.push_back({frame.resting, true, FrameVelocity{}});
    if (!frame.track.empty()) placed.back() = {frame.track.at(time), true, frame.track.velocity_from(time)};
    if (frame.id >= 0) inputs[frame.id] = placed.back();
  }
  for (const auto& [id, pose] : given) inputs[id] = {pose, true, FrameVelocity{}};
  const FrameInput fixed{{}, true, FrameVelocity{}};
  BoundaryInputs links;
  links.reserve(links_.size());
  for (const Link& link : links_) {
    const FrameInput& parent = link.parent < 0 ? fixed : links[link.parent];
    const bool is_given = given.count(link.id) > 0;
    links.push_back(is_given ? inputs[link.id] : link.frame < 0 ? carried(parent, link.origin) : placed[link.frame]);
    if (link.id >= 0) inputs[link.id] = links.back();
  }
  return inputs;
}

std::vector<std::string> unused_frames(const SceneDesc& scene, const Motion& motion) {
  std::vector<std::string> used = frame_names(scene);
  if (scene.robot)
    for (const LinkDesc& link : scene.robot->tree) used.push_back(link.name);
  std::vector<std::string> unused;
  for (const auto& track : motion) {
    if (std::find(used.begin(), used.end(), track.first) == used.end()) unused.push_back(track.first);
  }
  return unused;
}

std::vector<std::string> unplaced_frames(const SceneDesc& scene, const Motion& motion) {
  const std::vector<std::string> names = frame_names(scene);
  const BoundaryInputs initial = initial_frames(scene);
  std::set<std::string> links;
  if (scene.robot)
    for (const LinkDesc& link : scene.robot->tree) links.insert(link.name);
  std::vector<std::string> unplaced;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!initial[i].known && motion.count(names[i]) == 0 && links.count(names[i]) == 0) unplaced.push_back(names[i]);
  }
  return unplaced;
}

std::vector<std::string> unplaced_holders(const SceneDesc& scene, const Motion& motion) {
  std::set<std::string> holders;
  const auto add = [&](const auto& user) { holders.insert(user.frame); };
  for (const CableDesc& cable : scene.cables) std::for_each(cable.attachments.begin(), cable.attachments.end(), add);
  for (const NetDesc& net : scene.nets) std::for_each(net.attachments.begin(), net.attachments.end(), add);
  for (const BodyDesc& body : scene.bodies) std::for_each(body.attachments.begin(), body.attachments.end(), add);
  std::for_each(scene.guides.begin(), scene.guides.end(), add);
  std::vector<std::string> frames = unplaced_frames(scene, motion);
  const auto holds_nothing = [&](const std::string& frame) { return holders.count(frame) == 0; };
  frames.erase(std::remove_if(frames.begin(), frames.end(), holds_nothing), frames.end());
  return frames;
}

}  // namespace verlet_cable
