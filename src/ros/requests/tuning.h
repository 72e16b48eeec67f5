#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/ros.h>

#include <functional>
#include <string>
#include <vector>

#include "simulation/simulation.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {

/// A number of a scene that can be changed while it runs.
struct TunableNumber {
  std::string name;  ///< `gravity_z`, `wind_x`, `<material>_bending_stiffness`; of one that bends unequally `..._y` and `..._z`
  std::string description;
  Range range;
  std::function<double(const SceneDesc&)> value;
  std::function<void(SceneDesc&, double)> set;
};

/// What can be tuned of a scene: gravity, wind (the fluid's velocity), and of each material the dampings, finite stiffnesses and
/// friction.
std::vector<TunableNumber> tunable_numbers(const SceneDesc& scene);

/// dynamic_reconfigure under `tuning`. The parameters follow the scene, with the ranges that it allows: that is why this speaks
/// the protocol of dynamic_reconfigure (of its messages) itself, whose own server knows parameters of compile time only.
class Tuning {
 public:
  Tuning(ros::NodeHandle& private_node, Simulation& simulation);

  /// Publishes descriptions and values anew if the simulation's scene has changed.
  void follow_scene();

 private:
  bool set(const dynamic_reconfigure::Config& changes);
  dynamic_reconfigure::Config present() const;
  void publish_description();

  Simulation& simulation_;
  int scene_version_;
  std::vector<TunableNumber> numbers_;
  ros::Publisher descriptions_;
  ros::Publisher updates_;
  ros::ServiceServer service_;
};

}  // namespace verlet_cable
