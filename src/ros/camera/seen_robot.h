#pragma once

#include <optional>
#include <string>
#include <vector>

#include "verlet_cable/view/drawing.h"

namespace verlet_cable {

/// A robot as its URDF says that it looks: the visual geometry of its links.
class SeenRobot {
 public:
  /// No robot.
  SeenRobot() = default;
  /// Reads the URDF and its meshes. What cannot be read of it is left out, and logged. Throws SceneError where it is no URDF.
  SeenRobot(const std::string& urdf, const std::string& parameter);

  /// Names of the links that have visual geometry, which are those of their frames.
  const std::vector<std::string>& links() const { return links_; }
  /// Adds the parts of a link that is at `pose` to a thing.
  void add(std::size_t link, const Pose& pose, view::Thing& thing) const;

 private:
  std::vector<std::string> links_;
  std::vector<std::vector<view::Part>> parts_;  ///< of each link, in its frame
};

}  // namespace verlet_cable
