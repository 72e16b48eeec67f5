#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "verlet_cable/core/world.h"
#include "verlet_cable/scene/loads.h"
#include "world_events/status_log.h"
#include "world_events/world_event.h"

namespace verlet_cable {

struct TimedEvent {
  double time = 0;   ///< [s] simulated
  std::string type;  ///< as in the summary of cable_sim
  EventSubject subject;
  std::string message;
};

/// What has happened to a world since it was asked for last: the first 1000, and how many more.
class EventRecord {
 public:
  struct Taken {
    std::vector<TimedEvent> events;  ///< in the order of their times
    std::size_t left_out = 0;
    double last_time = 0;  ///< [s] of the last one that was left out
  };

  EventRecord() = default;
  /// As `save` has written it. Throws std::invalid_argument.
  explicit EventRecord(const std::string& data);
  std::string save() const;

  void add(double time, const WorldEvent& event);
  /// What could not start as the scene says, or, later, found no equilibrium to settle in.
  void observe_start(const World& world);
  /// What holds on in a world that was read from bytes.
  void observe_restored(const World& world);
  /// After each step. `held_back`: see StatusLog; `refused_loads`: before it.
  void observe(const World& world, const StepResult& result, const std::vector<int>& held_back,
               const std::vector<RefusedLoad>& refused_loads) {
    for (const RefusedLoad& load : refused_loads)
      add(world.time(), {EventType::load_ended, {load.on, load.name, 0, {}}, load.message});
    statuses_.observe(world, result, held_back);
    const Findings& findings = world.findings();
    if (!statuses_.is_empty() || !findings.jumps.empty() || !findings.breaks.empty() || !findings.excursions.empty() ||
        !findings.caught.empty() || !findings.released.empty() || !findings.ended_loads.empty())
      add_all(world);
  }

  /// Forgets them.
  Taken take();

 private:
  void add(TimedEvent event);
  void add_all(const World& world);
  void add_misfits(const World& world);
  void add_statuses();
  void add_jumps(const World& world);

  Taken taken_;
  StatusLog statuses_;
  std::map<std::string, double> jumps_;  ///< when a frame's last one was told [s]
};

}  // namespace verlet_cable
