#include "simulation/driven_world.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "scene/frame_speed.h"
#include "scene/pose_bytes.h"
#include "simulation/quantity.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

World begin(const SceneDesc& scene, BoundaryInputs start, LoadPlayer& loads) {
  limit_frame_velocities(scene.max_frame_speed, start);
  World world(scene, start);
  loads.apply_due(world);
  return world;
}

/// Throws SceneError where cables do not reach from where the motion begins.
std::shared_ptr<const FrameSource> begin_frames(const SceneDesc& scene, const Motion& motion) {
  auto frames = std::make_shared<FrameSource>(scene, motion);
  std::vector<std::string> errors;
  if (!motion.empty())
    for (const std::string& line : validate_distances(scene, frames->at(0))) errors.push_back("motion at t = 0: " + line);
  if (!errors.empty()) throw SceneError(std::move(errors));
  return frames;
}

void write_inputs(const BoundaryInputs& inputs, ByteWriter& bytes) {
  bytes(inputs.size());
  for (const FrameInput& input : inputs) {
    write_pose(input.pose, bytes);
    bytes(input.known);
    bytes(input.velocity.has_value());
    const FrameVelocity velocity = input.velocity.value_or(FrameVelocity{});
    write_vector(velocity.linear, bytes);
    write_vector(velocity.angular, bytes);
  }
}

BoundaryInputs read_inputs(ByteReader& bytes, std::size_t frames) {
  BoundaryInputs inputs(bytes.read_length());
  if (inputs.size() != frames) throw std::invalid_argument("they are of other frames");
  for (FrameInput& input : inputs) {
    input.pose = read_pose(bytes);
    bytes(input.known);
    bool has_velocity = false;
    bytes(has_velocity);
    const Vector3 linear = read_vector(bytes), angular = read_vector(bytes);
    if (has_velocity) input.velocity = FrameVelocity{linear, angular};
  }
  return inputs;
}

}  // namespace

DrivenWorld::DrivenWorld(WorldFile file)
    : scene_(std::make_shared<const SceneDesc>(file.world.scene())),
      scene_at_first_(std::move(file.scene_at_first)),
      world_(std::move(file.world)),
      hash_of_start_(0) {
  if (file.frames.empty())
    let_frames_rest();
  else
    read_frames(file.frames);
}

DrivenWorld DrivenWorld::load(const SceneDesc& scene, const std::string& data) {
  WorldFile file = read_world(scene, data);
  try {
    return DrivenWorld(std::move(file));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("data: what moves its frames: " + std::string(error.what()) +
                                "; allowed: what a world with such a scene has saved");
  }
}

std::string DrivenWorld::save() const {
  ByteWriter bytes;
  frames_->write(bytes);
  write_inputs(inputs_, bytes);
  write_inputs(targets_, bytes);
  bytes(hash_of_start_);
  loads_.write(bytes);
  bytes(unplaced_.size());
  for (const std::string& name : unplaced_) bytes.write_text(name);
  bytes(given_.size());
  for (const GivenPoses& given : given_) {
    bytes(given.frame);
    bytes(given.poses.size() - given.next);
    for (std::size_t k = given.next; k < given.poses.size(); ++k) write_pose(given.poses[k], bytes);
  }
  return write_world(*scene_at_first_, world_, bytes.take());
}

void DrivenWorld::read_frames(const std::string& frames) {
  ByteReader bytes(frames);
  frames_ = std::make_shared<const FrameSource>(bytes, world_.frames().size());
  const std::size_t count = frames_->at(0).size();
  inputs_ = read_inputs(bytes, count);
  targets_ = read_inputs(bytes, count);
  bytes(hash_of_start_);
  loads_ = LoadPlayer(bytes);
  all_loads_ = loads_.from_the_start();
  unplaced_.resize(bytes.read_length());
  for (std::string& name : unplaced_) name = bytes.read_text();
  given_.resize(bytes.read_length());
  for (GivenPoses& given : given_) {
    bytes(given.frame);
    const std::size_t poses = bytes.read_length();
    for (std::size_t k = 0; k < poses; ++k) given.poses.push_back(read_pose(bytes));
    if (poses == 0 || given.frame < 0 || static_cast<std::size_t>(given.frame) >= count)
      throw std::invalid_argument("a pose is of no frame");
  }
}

/// Of a world that something else moved.
void DrivenWorld::let_frames_rest() {
  auto frames = std::make_shared<FrameSource>(*scene_, Motion{});
  const int count = static_cast<int>(world_.frames().size());
  for (int frame = 0; frame < count; ++frame) {
    const Pose& pose = world_.frame_pose(frame);
    if (frame >= static_cast<int>(verlet_cable::frame_names(*scene_).size())) frames->add(world_.frames()[frame], frame, pose);
    inputs_.push_back({pose, world_.frame_known(frame)});
    if (frame > 0 && world_.frame_known(frame) && !world_.is_body_frame(frame)) given_.push_back({frame, {pose}, 0});
  }
  frames_ = std::move(frames);
  targets_ = inputs_;
}

DrivenWorld::DrivenWorld(std::shared_ptr<const SceneDesc> scene, std::shared_ptr<const FrameSource> frames, LoadPlayer loads)
    : scene_(std::move(scene)),
      scene_at_first_(scene_),
      frames_(std::move(frames)),
      inputs_(frames_->at(0)),
      targets_(inputs_),
      all_loads_(std::move(loads)),
      loads_(all_loads_),
      world_(begin(*scene_, inputs_, loads_)),
      hash_of_start_(world_.hash()) {}

DrivenWorld::DrivenWorld(std::shared_ptr<const SceneDesc> scene, const Motion& motion, LoadPlayer loads)
    : DrivenWorld(scene, begin_frames(*scene, motion), std::move(loads)) {
  unplaced_ = unplaced_holders(*scene, motion);
}

int DrivenWorld::index_of_frame(const std::string& name) const {
  const std::vector<std::string>& names = world_.frames();
  for (int frame = 1; frame < static_cast<int>(names.size()); ++frame)
    if (names[frame] == name && !world_.is_body_frame(frame)) return frame;
  return -1;
}

int DrivenWorld::find_frame(const std::string& name) const {
  if (const int frame = index_of_frame(name); frame >= 0) return frame;
  const NameList allowed(frame_names());
  throw UnknownName("name: " + in_quotes(name) + "; allowed: " + allowed.text("none, the scene has none that moves"));
}

std::vector<std::string> DrivenWorld::frame_names() const {
  std::vector<std::string> names;
  for (int frame = 1; frame < static_cast<int>(world_.frames().size()); ++frame)
    if (!world_.is_body_frame(frame)) names.push_back(world_.frames()[frame]);
  return names;
}

std::optional<Pose> DrivenWorld::frame_pose(const std::string& name) const {
  const std::vector<std::string>& names = world_.frames();
  const auto found = std::find(names.begin(), names.end(), name);
  const int frame = static_cast<int>(found - names.begin());
  if (found != names.end()) return world_.frame_known(frame) ? std::optional<Pose>(world_.frame_pose(frame)) : std::nullopt;
  if (!frames_->is_link(name)) return std::nullopt;
  return frames_with(name, names.size(), {})->at(world_.time(), given_now())[names.size()].pose;
}

void DrivenWorld::add_frame(const std::string& name, const Pose& pose) {
  const std::vector<std::string>& names = world_.frames();
  if (!is_frame_name(name)) throw std::invalid_argument("name: " + in_quotes(name) + "; allowed: " + frame_words);
  if (std::find(names.begin(), names.end(), name) != names.end())
    throw std::invalid_argument("name: " + in_quotes(name) + "; allowed: names that no frame has");
  const std::size_t frame = names.size();
  world_.add_frame(name, pose);
  follow_frames_from(frame);
  set_frame(static_cast<int>(frame), &pose, 1);
}

void DrivenWorld::follow_frames_from(std::size_t first) {
  const std::size_t count = world_.frames().size();
  if (first == count) return;
  inputs_.resize(count, {{}, false});
  for (std::size_t id = first; id < count; ++id) {
    const Pose& pose = world_.frame_pose(static_cast<int>(id));
    frames_ = frames_with(world_.frames()[id], id, pose);
    inputs_[id] = {pose, true};
  }
  targets_ = inputs_;
}

std::shared_ptr<const FrameSource> DrivenWorld::frames_with(const std::string& name, std::size_t id, const Pose& resting) const {
  auto frames = std::make_shared<FrameSource>(*frames_);
  frames->add(name, static_cast<int>(id), resting);
  return frames;
}

PosesById DrivenWorld::given_now() const {
  PosesById given;
  for (const GivenPoses& frame : given_) given.emplace(frame.frame, world_.frame_pose(frame.frame));
  return given;
}

void DrivenWorld::require_placed_frames(const std::string& where) const {
  if (unplaced_.empty()) return;
  NameList names;
  for (const std::string& name : unplaced_) names.add(name);
  throw std::invalid_argument(
      where + "frames: nothing has placed " + names.text() +
      "; allowed: a pose by set_frame (set_frames of a Batch) before the first step, by the motion, or as "
      "initial_pose in the scene");
}

bool DrivenWorld::set_frame(int frame, const Pose* poses, std::size_t count) {
  const auto unplaced = std::find(unplaced_.begin(), unplaced_.end(), world_.frames()[frame]);
  const bool begins = unplaced != unplaced_.end() && place(unplaced - unplaced_.begin(), frame, *poses);
  auto given = std::find_if(given_.begin(), given_.end(), [frame](const GivenPoses& other) { return other.frame == frame; });
  if (given == given_.end()) given = given_.insert(given_.end(), {frame, {}, 0});
  given->poses.assign(poses, poses + count);
  given->next = 0;
  return begins;
}

/// One of the unplaced frames. Returns whether the world began anew with it.
bool DrivenWorld::place(std::ptrdiff_t unplaced, int frame, const Pose& pose) {
  auto frames = std::make_shared<FrameSource>(*frames_);
  frames->place(frame, pose);
  if (unplaced_.size() == 1 && is_as_it_began()) {
    const std::vector<std::string> errors = validate_distances(*scene_, frames->at(0));
    if (!errors.empty()) throw SceneError(errors);
    DrivenWorld anew(scene_, frames, all_loads_);
    anew.given_ = given_;
    *this = std::move(anew);
    return true;
  }
  frames_ = std::move(frames);
  unplaced_.erase(unplaced_.begin() + unplaced);
  return false;
}

void DrivenWorld::begin_anew(std::shared_ptr<const SceneDesc> scene) {
  DrivenWorld anew(std::move(scene), frames_, all_loads_);
  anew.given_ = std::move(given_);
  anew.unplaced_ = std::move(unplaced_);
  *this = std::move(anew);
}

void DrivenWorld::tune(std::shared_ptr<const SceneDesc> scene) {
  world_.tune(*scene);
  scene_ = std::move(scene);
}

const BoundaryInputs& DrivenWorld::next_inputs() {
  refused_loads_ = loads_.apply_due(world_);
  const double time = static_cast<double>(world_.steps() + 1) * scene_->time_step;
  if (frames_->has_links() && !given_.empty()) {
    PosesById poses;
    for (const GivenPoses& given : given_) poses.emplace(given.frame, given.poses[given.next]);
    targets_ = frames_->at(time, poses);
  } else {
    if (!frames_->rests()) targets_ = frames_->at(time);
    for (const GivenPoses& given : given_) targets_[given.frame].pose = given.poses[given.next];
  }
  for (GivenPoses& given : given_)
    if (given.next + 1 < given.poses.size()) ++given.next;
  inputs_.swap(targets_);
  if (scene_->max_frame_speed < infinity)
    held_back_ = limit_frame_motion(targets_, scene_->max_frame_speed * scene_->time_step, inputs_);
  if (!frames_->rests() || !given_.empty()) targets_ = inputs_;
  return inputs_;
}

}  // namespace verlet_cable
