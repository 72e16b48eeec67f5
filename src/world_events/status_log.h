#pragma once

#include <map>
#include <string>
#include <vector>

#include "verlet_cable/core/bytes.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// "overstretched"
const char* name_of(StepResult::Status status);

/// Of a cable that hangs instead of having the shape it was given.
inline constexpr char misfit_text[] =
    "the initial shape does not fit the cable's attachments and junctions; it hangs between them instead, in a loop where it is "
    "joined with itself";

/// That a status, or what keeps a frame from being followed, begins or has ended.
struct StatusEvent {
  double time = 0;   ///< [s] simulated; of an end, when it was there last
  std::string name;  ///< of the status (a fault: FAULT), or ENERGY, frame_too_fast, frame_out_of_range
  bool has_ended = false;
  std::string cable;  ///< or the net, particle or body; empty: a frame
  int node = -1;      ///< -1: none in particular
  std::string other;  ///< inside_obstacle: the obstacle; the frame
  std::string message;
};

/// Tells what steps find when it begins and when it has ended, not in each step. What comes back within 0.1 s has not ended.
/// Jumps are no statuses here: they have events of their own. Of energy that is unaccounted for no end is told.
class StatusLog {
 public:
  StatusLog() = default;
  /// As `write` has written it. Throws std::invalid_argument.
  explicit StatusLog(ByteReader& bytes);
  void write(ByteWriter& bytes) const;

  /// Cables that found no equilibrium, from this of Findings::unsettled on.
  void observe_start(const World& world, std::size_t first_unsettled = 0);
  /// After each step. `held_back`: ids of the frames that moved faster than `max_frame_speed`.
  void observe(const World& world, const StepResult& result, const std::vector<int>& held_back) {
    if (!world.findings().statuses.empty() || !world.findings().unaccounted.empty() || !episodes_.empty() || !held_back.empty() ||
        result.ignored_frame >= 0)
      tell(world, result, held_back);
  }
  /// What has not ended ends: something else begins.
  void end_all();

  /// What was told since the last call.
  std::vector<StatusEvent> take();
  bool is_empty() const { return told_.empty(); }

 private:
  struct Episode {
    StatusEvent first;
    double last_time = 0;
    double largest = 0;  ///< strain, or depth [m]
  };

  void tell(const World& world, const StepResult& result, const std::vector<int>& held_back);
  void report(const StatusEvent& event, double size);
  void end(const Episode& episode);

  std::map<std::string, Episode> episodes_;  ///< that have not ended, by what they are and of what
  std::vector<StatusEvent> told_;
};

}  // namespace verlet_cable
