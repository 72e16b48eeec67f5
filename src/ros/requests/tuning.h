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
/// and their ranges depend on the scene. The node therefore implements the protocol of dynamic_reconfigure (its messages) itself,
/// as the server of that package only supports parameters that are known at compile time.
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
