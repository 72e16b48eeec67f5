#pragma once

#include <cstddef>
#include <set>
#include <string>

#include "publish/event_publisher.h"
#include "time/time_grid.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What happens to cables, nets and particles: events, log, and what diagnostics show of it.
class CableWatch {
 public:
  explicit CableWatch(const EventPublisher& events) : events_(events) {}

  /// Reports how a step went that began at the simulated time `stamp`.
  void report_status(const StepResult& result, Nanoseconds stamp, const World& world);
  /// Reports what happened to cables in the step that led to `stamp`: see `events_of_step`.
  void report_events(Nanoseconds stamp, const World& world) const;
  /// Warns of cables that the last step found inside obstacles, of each pair once until `restart`, and of a thousand pairs at
  /// most.
  void report_intrusions(const World& world);
  /// Warns of cables that could not start as the scene says, from these of World::unsettled() and World::misfits() on.
  void report_starts(std::size_t first_unsettled, std::size_t first_misfit, const World& world) const;
  /// Another world starts: reports how, and forgets what was found inside obstacles.
  void restart(const World& world);

  int faults() const { return faults_; }  ///< since the node started
  /// "CABLE in OBSTACLE" of those that were warned of since the last restart.
  const std::set<std::string>& intrusions() const { return intrusions_; }

 private:
  const EventPublisher& events_;
  int faults_ = 0;
  std::set<std::string> intrusions_;
};

}  // namespace verlet_cable
