#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/progress_bar.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_sim {

/// Something that a user should know of a run. What the node publishes, too, has the name that it has in CableEvent.msg.
struct Event {
  double time = 0;  ///< [s]
  std::string type;
  std::string cable;  ///< empty: none in particular
  int node = -1;      ///< -1: none in particular
  std::string frame;  ///< empty: none in particular
  std::string message;
  std::string other;  ///< BROKE: the new cable; inside_obstacle: the obstacle
};

/// Turns what each step reports into events: one when something begins, one when it has ended, not one a step. Keeps the first
/// 1000 and prints the first 20 to standard error.
class EventLog {
 public:
  explicit EventLog(tools::ProgressBar& progress) : progress_(progress) {}

  /// After each step. `held_back`: ids of the frames that moved faster than `max_frame_speed`.
  void observe(const World& world, const StepResult& result, const std::vector<int>& held_back);

  /// Jumps that the last step found to be over.
  void add_jumps(const World& world);
  void add_guides(const World& world);

  /// Cables that hang instead of having the shape they were given, or found no equilibrium.
  void add_starts(const World& world);

  /// In the order of their times.
  std::vector<Event> events() const;

 private:
  struct Episode {
    Event first;
    double last_time = 0;
    double largest_strain = 0;
  };

  void add_breaks(const World& world);
  void add_excursions(const World& world);
  void add_intrusions(const World& world);
  void report(const Event& event, double strain);
  void end_episodes(double time);
  void add(const Event& event);

  tools::ProgressBar& progress_;
  std::vector<Event> events_;
  std::size_t dropped_ = 0;
  double last_dropped_time_ = 0;
  std::map<std::string, Episode> episodes_;                   ///< that have not ended, by type and subject
  std::map<std::string, double> jumps_;                       ///< when a frame's last one was told [s]
  std::set<std::pair<std::string, std::string>> intrusions_;  ///< that were told: cable and obstacle
};

}  // namespace verlet_cable::cable_sim
