#pragma once

#include <ros/callback_queue_interface.h>

#include <atomic>
#include <functional>
#include <future>
#include <utility>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// How a request is answered: at once, or when it is done.
using Answer = std::function<void(const EditResult&)>;

/// Lets other threads have things done by the one thread that owns the simulation, and wait for the answer, however long that
/// takes: the owner goes on meanwhile.
class OwnerCalls {
 public:
  /// `queue`: the owner's, of callbacks.
  explicit OwnerCalls(ros::CallbackQueueInterface& queue) : queue_(queue) {}
  ~OwnerCalls();

  /// The owner calls `request`, after what was in its queue before. Returns what that, or who it passed the Answer on to,
  /// answers, or a failure where the node ends first. Not to be called by the owner.
  EditResult ask(std::function<void(const Answer&)> request) { return wait(begin(std::move(request))); }
  /// The two parts of that: what begins later is called later.
  std::future<EditResult> begin(std::function<void(const Answer&)> request);
  EditResult wait(std::future<EditResult> answer) const;

  /// Nobody waits any longer.
  void end() { ending_ = true; }

 private:
  ros::CallbackQueueInterface& queue_;
  std::atomic<bool> ending_{false};
};

}  // namespace verlet_cable
