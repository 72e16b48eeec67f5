#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "camera/camera_settings.h"
#include "camera/mesh_shelf.h"
#include "camera/moment.h"
#include "camera/seen_robot.h"
#include "verlet_cable/view/stage.h"

namespace verlet_cable {

/// Makes what cameras look at. Cameras of a process that look at the same robot and the same cables, and number them alike, share
/// one, and with it each stage: it is made by the first of them that needs it.
class StageMaker {
 public:
  /// That of all cameras with such settings. Throws SceneError where the robot cannot be read.
  static std::shared_ptr<StageMaker> shared(const CameraSettings& settings);

  explicit StageMaker(const CameraSettings& settings);

  const std::vector<std::string>& links() const { return robot_.links(); }  ///< frames of the robot
  /// `link_poses`: of the links, by tf at the time of the state; none: not seen. May be called from any thread.
  std::shared_ptr<const view::Stage> stage(const Moment& moment, const std::vector<std::optional<Pose>>& link_poses);

 private:
  const std::vector<std::string> labels_;
  const bool shadows_;
  const SeenRobot robot_;
  std::mutex mutex_;  ///< of those below
  MeshShelf meshes_;
  Moment moment_;  ///< of the last stage
  std::vector<bool> seen_links_;
  std::shared_ptr<const view::Stage> stage_;
};

}  // namespace verlet_cable
