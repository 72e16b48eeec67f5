#include "camera/stage_maker.h"

#include <map>
#include <tuple>
#include <utility>

#include "camera/moment_drawing.h"

namespace verlet_cable {

std::shared_ptr<StageMaker> StageMaker::shared(const CameraSettings& settings) {
  using Key = std::tuple<std::string, std::string, std::vector<std::string>, bool>;
  static std::mutex mutex;
  static std::map<Key, std::weak_ptr<StageMaker>> makers;
  const std::lock_guard<std::mutex> lock(mutex);
  std::weak_ptr<StageMaker>& known = makers[{settings.state, settings.robot, settings.labels, settings.shadows}];
  if (const auto maker = known.lock()) return maker;
  const auto maker = std::make_shared<StageMaker>(settings);
  known = maker;
  return maker;
}

StageMaker::StageMaker(const CameraSettings& settings)
    : labels_(settings.labels),
      shadows_(settings.shadows),
      robot_(settings.robot.empty() ? SeenRobot() : SeenRobot(settings.robot, settings.robot_description)) {}

/// Subscribers of one process that listen to one topic get the very same messages.
std::shared_ptr<const view::Stage> StageMaker::stage(const Moment& moment, const std::vector<std::optional<Pose>>& link_poses) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<bool> seen_links;
  for (const std::optional<Pose>& pose : link_poses) seen_links.push_back(pose.has_value());
  if (stage_ && moment.state == moment_.state && moment.appearance == moment_.appearance && seen_links == seen_links_)
    return stage_;
  view::Drawing drawing = drawing_of(moment, robot_, link_poses, labels_, meshes_);
  drawing.light.shadows = shadows_;
  stage_ = std::make_shared<view::Stage>(std::move(drawing), stage_.get());
  moment_ = moment;
  seen_links_ = seen_links;
  return stage_;
}

}  // namespace verlet_cable
