#pragma once

#include <string>
#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Mean force and torque of each attachment over the steps since they were shown last, in the fixed frame's axes.
class WrenchMeans {
 public:
  /// After a step.
  void add(const World& world);
  /// The means have been shown: the next step begins new ones. Without one they are shown again.
  void end_tick() { shown_ = true; }
  /// The steps before have nothing to do with those to come.
  void forget() { sums_.clear(); }
  /// The attachment with the means as its force and torque; as it is where no step was added.
  Attachment mean(const Attachment& attachment) const;

 private:
  struct Sum {
    std::string attachment;
    Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
    int steps = 0;
  };

  std::vector<Sum> sums_;  // in the order of the world's attachments, and perhaps some that are gone
  bool shown_ = false;
};

}  // namespace verlet_cable
