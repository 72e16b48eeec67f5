#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "simulation/simulation.h"
#include "threads/guarded_queue.h"
#include "threads/owner_calls.h"

namespace verlet_cable {

/// The services of the node. Requests are checked and applied at once: the simulation's updates and they share one queue of
/// callbacks, so each is applied between steps, in the order they came. `reset`, `step` and `load_scene` may take long: each has
/// threads that wait for the answers, and read what is to be read, while the simulation does the others. They are several, so
/// that what is wrong is refused while another is done, and one world is built for resets that come together.
class CableServices {
 public:
  CableServices(ros::NodeHandle& private_node, Simulation& simulation);
  ~CableServices();

 private:
  /// A service with threads of its own.
  struct Aside {
    explicit Aside(std::uint32_t threads) : spinner(threads, &queue) {}
    ros::CallbackQueue queue;
    GuardedQueue guard{queue};
    ros::AsyncSpinner spinner;
    ros::ServiceServer server;
  };
  template <typename Service, typename Handler>
  void serve_aside(const ros::NodeHandle& node, const std::string& name, Handler handler);

  OwnerCalls owner_;
  std::mutex reads_scene_;
  std::vector<ros::ServiceServer> servers_;
  std::vector<std::unique_ptr<Aside>> asides_;
};

}  // namespace verlet_cable
