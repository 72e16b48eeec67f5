#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/progress_bar.h"
#include "verlet_cable/core/world.h"
#include "verlet_cable/scene/loads.h"
#include "world_events/status_log.h"

namespace verlet_cable::cable_sim {

/// Something that a user should know of a run. What the node publishes, too, has the name that it has in CableEvent.msg.
struct Event {
  double time = 0;  ///< [s]
  std::string type;
  std::string cable;  ///< empty: none in particular
  int node = -1;      ///< -1: none in particular
  std::string frame;  ///< empty: none in particular
  std::string message;
  std::string other;  ///< BROKE: the new cable; inside_obstacle: the obstacle; LOAD_ENDED: the load
};

/// What each step reports, as events; of what lasts, one when it begins and one when it has ended, see StatusLog. Keeps the first
/// 1000 and prints the first 20 to standard error.
class EventLog {
 public:
  explicit EventLog(tools::ProgressBar& progress) : progress_(progress) {}

  /// After each step. `held_back`: ids of the frames that moved faster than `max_frame_speed`.
  void observe(const World& world, const StepResult& result, const std::vector<int>& held_back);
  /// Before a step.
  void add_refused_loads(const World& world, const std::vector<RefusedLoad>& refused);

  /// Jumps that the last step found to be over.
  void add_jumps(const World& world);
  void add_guides(const World& world);

  /// Cables that hang instead of having the shape they were given, or found no equilibrium.
  void add_starts(const World& world);

  /// In the order of their times.
  std::vector<Event> events() const;

 private:
  void add_breaks(const World& world);
  void add_excursions(const World& world);
  void add_statuses();
  void add_ended_loads(const World& world);
  void add(const Event& event);

  tools::ProgressBar& progress_;
  std::vector<Event> events_;
  std::size_t dropped_ = 0;
  double last_dropped_time_ = 0;
  StatusLog statuses_;
  std::map<std::string, double> jumps_;  ///< when a frame's last one was told [s]
};

}  // namespace verlet_cable::cable_sim
