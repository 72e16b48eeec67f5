#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "verlet_cable/core/world.h"
#include "world_events/world_event.h"

namespace verlet_cable {

struct TimedEvent {
  double time = 0;  ///< [s] simulated
  WorldEvent event;
};

/// What has happened to a world since it was asked for last: the first 1000, and how many more.
class EventRecord {
 public:
  struct Taken {
    std::vector<TimedEvent> events;
    std::size_t left_out = 0;
    double last_time = 0;  ///< [s] of the last one that was left out
  };

  void add(double time, WorldEvent event);
  /// After each step.
  void observe(const World& world, const StepResult& result) {
    const Findings& findings = world.findings();
    const bool fault = result.status == StepResult::Status::fault;
    if (fault || faulted_ || !findings.jumps.empty() || !findings.breaks.empty() || !findings.excursions.empty() ||
        !findings.caught.empty() || !findings.released.empty())
      add_all(world, result);
  }

  /// Forgets them.
  Taken take();

 private:
  void add_all(const World& world, const StepResult& result);
  void add_jumps(const World& world);

  Taken taken_;
  std::map<std::string, double> jumps_;  ///< when a frame's last one was told [s]
  bool faulted_ = false;                 ///< the last step did
};

}  // namespace verlet_cable
