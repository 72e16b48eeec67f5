#include "simulation/driven_world.h"

#include <algorithm>
#include <utility>

#include "scene/frame_speed.h"
#include "simulation/quantity.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

World begin(const SceneDesc& scene, const FrameSource& frames) {
  BoundaryInputs start = frames.at_start();
  limit_frame_velocities(scene.max_frame_speed, start);
  return World(scene, start);
}

}  // namespace

DrivenWorld::DrivenWorld(std::shared_ptr<const SceneDesc> scene, std::shared_ptr<const FrameSource> frames)
    : scene_(std::move(scene)),
      frames_(std::move(frames)),
      inputs_(frames_->at(0)),
      targets_(inputs_),
      world_(begin(*scene_, *frames_)),
      hash_of_start_(world_.hash()) {}

int DrivenWorld::find_frame(const std::string& name) const {
  const std::vector<std::string>& names = world_.frames();
  std::string allowed;
  for (int frame = 1; frame < static_cast<int>(names.size()); ++frame) {
    if (world_.is_body_frame(frame)) continue;
    if (names[frame] == name) return frame;
    allowed += (allowed.empty() ? "" : ", ") + names[frame];
  }
  throw UnknownName("frame: " + quoted(name) +
                    "; allowed: " + (allowed.empty() ? "none, the scene has none that moves" : allowed));
}

void DrivenWorld::set_frame(int frame, std::vector<Pose> poses) {
  const auto given =
      std::find_if(given_.begin(), given_.end(), [frame](const GivenPoses& other) { return other.frame == frame; });
  if (given == given_.end())
    given_.push_back({frame, std::move(poses), 0});
  else
    *given = {frame, std::move(poses), 0};
}

void DrivenWorld::begin_anew(std::shared_ptr<const SceneDesc> scene) {
  DrivenWorld anew(std::move(scene), frames_);
  anew.given_ = std::move(given_);
  *this = std::move(anew);
}

void DrivenWorld::tune(std::shared_ptr<const SceneDesc> scene) {
  world_.tune(*scene);
  scene_ = std::move(scene);
}

const BoundaryInputs& DrivenWorld::next_inputs() {
  if (!frames_->rests()) targets_ = frames_->at(static_cast<double>(world_.steps() + 1) * scene_->time_step);
  for (GivenPoses& given : given_) {
    targets_[given.frame].pose = given.poses[given.next];
    if (given.next + 1 < given.poses.size()) ++given.next;
  }
  inputs_.swap(targets_);
  if (scene_->max_frame_speed < infinity) limit_frame_motion(targets_, scene_->max_frame_speed * scene_->time_step, inputs_);
  if (!frames_->rests() || !given_.empty()) targets_ = inputs_;
  return inputs_;
}

}  // namespace verlet_cable
