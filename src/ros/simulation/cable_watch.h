#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>

#include "publish/event_publisher.h"
#include "time/time_grid.h"
#include "verlet_cable/core/world.h"
#include "world_events/status_log.h"

namespace verlet_cable {

/// How many of Findings's lists of these names have been reported.
struct StartsReported {
  std::size_t unsettled = 0, misfits = 0, unreached = 0;
};

/// What happens to cables, nets and particles: events, log, and what diagnostics show of it.
class CableWatch {
 public:
  explicit CableWatch(const EventPublisher& events) : events_(events) {}

  /// Reports how a step went that began at the simulated time `stamp`.
  void report_status(const StepResult& result, Nanoseconds stamp, const World& world);
  /// Reports what happened to cables in the step that led to `stamp`: see `events_of_step`.
  void report_events(Nanoseconds stamp, const World& world) const;
  /// Reports which statuses the step that led to `stamp` began with, or found to be over.
  void report_statuses(const StepResult& result, Nanoseconds stamp, const World& world);
  /// Reports cables that could not start as the scene says, and have not been reported `before`.
  void report_starts(const StartsReported& before, Nanoseconds stamp, const World& world);
  /// Another world starts: ends the statuses of the last one, reports how it starts, and forgets what was found inside obstacles.
  void restart(Nanoseconds stamp, const World& world);
  /// What comes next does not go on from the steps before.
  void end_statuses(Nanoseconds stamp);

  int faults() const { return faults_; }  ///< since the node started
  /// "CABLE in OBSTACLE" of those that were found since the last restart, a thousand pairs at most.
  const std::set<std::string>& intrusions() const { return intrusions_; }

 private:
  void publish(Nanoseconds stamp, std::optional<double> time);

  const EventPublisher& events_;
  StatusLog statuses_;
  int faults_ = 0;
  std::set<std::string> intrusions_;
};

}  // namespace verlet_cable
