#include "node/cable_node.h"

#include <malloc.h>

#include <algorithm>

#include "interact/hands.h"
#include "node/diagnostics.h"
#include "requests/cable_services.h"
#include "requests/load_listener.h"
#include "requests/obstacle_listener.h"
#include "requests/rollouts.h"
#include "requests/tuning.h"
#include "scene_sources/scene_outline.h"
#include "scene_sources/scene_parameters.h"
#include "simulation/simulation.h"
#include "threads/guarded_queue.h"

namespace verlet_cable {
namespace {

/// Between times at which the system gets back what scenes, rollouts and floods took: glibc keeps what is freed, each thread for
/// itself, up to twice the largest block that there ever was and more.
const ros::WallDuration trim_period(5.0);

/// Ticks come as evenly as this fraction of their period, but no finer than a millisecond.
ros::WallDuration update_period(const SceneDesc& scene) {
  return ros::WallDuration(std::clamp(0.25 / scene.publish_rate, 1e-3, 5e-3));
}

ros::NodeHandle guarded(ros::NodeHandle node, GuardedQueue& guard) {
  node.setCallbackQueue(&guard);
  return node;
}

}  // namespace

struct CableNode::Parts {
  explicit Parts(ros::NodeHandle private_node);
  void update();

  GuardedQueue guard;
  ros::NodeHandle node;
  Simulation simulation;
  CableServices services;
  ObstacleListener obstacles;
  LoadListener loads;
  Tuning tuning;
  Rollouts rollouts;
  Hands hands;
  Diagnostics diagnostics;
  ros::WallTimer timer;
  ros::WallTimer trim_timer;
  double publish_rate;  ///< [Hz] for which the timer runs
};

CableNode::Parts::Parts(ros::NodeHandle private_node)
    : guard(*private_node.getCallbackQueue()),
      node(guarded(private_node, guard)),
      simulation(node, read_scene_parameters(node)),
      services(node, simulation),
      obstacles(node, simulation),
      loads(node, simulation),
      tuning(node, simulation),
      rollouts(node, simulation),
      hands(node, simulation),
      diagnostics(node, simulation, obstacles),
      timer(node.createWallTimer(update_period(simulation.scene()),
                                 [this](const ros::WallTimerEvent&) { run_guarded("an update", [this] { update(); }); })),
      trim_timer(node.createWallTimer(trim_period, [](const ros::WallTimerEvent&) { malloc_trim(0); })),
      publish_rate(simulation.scene().publish_rate) {
  ROS_INFO("scene: %s", scene_outline(simulation.scene()).c_str());
}

void CableNode::Parts::update() {
  simulation.update(Simulation::longest_slice);
  tuning.follow_scene();
  loads.follow_scene();
  hands.update();
  if (simulation.scene().publish_rate == publish_rate) return;
  publish_rate = simulation.scene().publish_rate;
  timer.setPeriod(update_period(simulation.scene()));
}

CableNode::CableNode(ros::NodeHandle private_node) : parts_(std::make_unique<Parts>(private_node)) {}
CableNode::~CableNode() = default;

bool CableNode::busy() const {
  return parts_->simulation.busy();
}

void log_errors(const SceneError& error) {
  for (const std::string& line : error.errors()) ROS_FATAL("%s", line.c_str());
}

}  // namespace verlet_cable
