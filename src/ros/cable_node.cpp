#include "verlet_cable/ros/cable_node.h"

#include <algorithm>

#include "verlet_cable/ros/scene_parameters.h"

namespace verlet_cable {
namespace {

/// Ticks come as evenly as this fraction of their period, but no finer than a millisecond.
ros::WallDuration update_period(const SceneDesc& scene) {
  return ros::WallDuration(std::clamp(0.25 / scene.publish_rate, 1e-3, 5e-3));
}

ros::NodeHandle guarded(ros::NodeHandle node, GuardedQueue& guard) {
  node.setCallbackQueue(&guard);
  return node;
}

}  // namespace

CableNode::CableNode(ros::NodeHandle private_node)
    : guard_(*private_node.getCallbackQueue()),
      node_(guarded(private_node, guard_)),
      simulation_(node_, read_scene_parameters(node_)),
      services_(node_, simulation_),
      obstacles_(node_, simulation_),
      tuning_(node_, simulation_),
      rollouts_(node_, simulation_),
      hands_(node_, simulation_),
      diagnostics_(node_, simulation_, obstacles_),
      timer_(node_.createWallTimer(update_period(simulation_.scene()),
                                   [this](const ros::WallTimerEvent&) { run_guarded("an update", [this] { update(); }); })),
      publish_rate_(simulation_.scene().publish_rate) {}

void CableNode::update() {
  simulation_.update(Simulation::longest_slice);
  tuning_.follow_scene();
  hands_.update();
  if (simulation_.scene().publish_rate == publish_rate_) return;
  publish_rate_ = simulation_.scene().publish_rate;
  timer_.setPeriod(update_period(simulation_.scene()));
}

void log_errors(const SceneError& error) {
  for (const std::string& line : error.errors()) ROS_FATAL("%s", line.c_str());
}

}  // namespace verlet_cable
