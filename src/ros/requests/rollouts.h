#pragma once

#include <ros/ros.h>
#include <verlet_cable/RolloutAction.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <list>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "requests/rollout.h"
#include "requests/rollout_server.h"
#include "simulation/simulation.h"

namespace verlet_cable {

/// The action `rollout`: copies of the world that are run on as fast as it goes, many at once, by threads that give way to the
/// live simulation. A thread runs several of them step by step, so that cables that are alike are stepped together. Goals are
/// checked and cancelled by the node's own thread.
class Rollouts {
 public:
  Rollouts(ros::NodeHandle& private_node, const Simulation& simulation);
  ~Rollouts();

 private:
  using Server = RolloutServer;
  struct Job {
    Job(const Server::GoalHandle& handle, Rollout run) : goal(handle), rollout(std::move(run)) {}
    Server::GoalHandle goal;
    Rollout rollout;
    ros::WallTime reported = ros::WallTime::now();
    std::atomic<bool> cancelled{false};
  };
  using Jobs = std::vector<std::shared_ptr<Job>>;

  void accept(Server::GoalHandle goal);
  std::size_t count_jobs();
  void cancel(Server::GoalHandle goal);
  void work();
  Jobs take_waiting();
  void run(Jobs jobs) const;
  void report(Job& job) const;
  static void end(Job& job);

  const Simulation& simulation_;
  std::mutex mutex_;
  std::condition_variable new_job_;
  std::deque<std::shared_ptr<Job>> waiting_;  ///< guarded by mutex_
  std::list<std::shared_ptr<Job>> jobs_;      ///< waiting and running ones; guarded by mutex_
  std::atomic<bool> ending_{false};
  Server server_;
  std::vector<std::thread> threads_;
};

}  // namespace verlet_cable
