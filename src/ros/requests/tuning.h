#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/ros.h>

#include <vector>

#include "edit_requests/tunable_numbers.h"
#include "simulation/simulation.h"

namespace verlet_cable {

/// Topic `tuning/parameter_descriptions` (dynamic_reconfigure/ConfigDescription), latched, with `tuning/parameter_updates` and
/// the service `tuning/set_parameters`: dynamic_reconfigure for gravity, wind, dampings, stiffnesses and friction. The parameters
/// follow the scene, with the ranges that it allows: that is why this speaks the protocol of dynamic_reconfigure (of its
/// messages) itself, whose own server knows parameters of compile time only.
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
