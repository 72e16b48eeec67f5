#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "event_log.h"
#include "extremes.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_sim {

/// What is gathered over a run.
class Summary {
 public:
  /// The forces of attachments are averaged over the last `averaged_steps`, as far as there are so many.
  Summary(const World& world, std::int64_t averaged_steps);

  void add_step(const World& world, const StepResult& result, std::chrono::steady_clock::duration wall_time);

  /// The contract's summary as JSON.
  std::string json(const World& world, const std::vector<Event>& events) const;
  /// One line for people.
  std::string line(const World& world) const;

 private:
  struct Wrench {
    Vector3 force = Vector3::Zero();   ///< [N]
    Vector3 torque = Vector3::Zero();  ///< [N m]
  };

  /// Over the last steps; that of the attachment now if there was none.
  Wrench mean_wrench(const Attachment& attachment) const;

  double wall_seconds() const { return std::chrono::duration<double>(wall_time_).count(); }

  std::size_t averaged_steps_;
  std::int64_t segments_ = 0;  ///< as `limits.segments` counts: links or nodes of nets, particles and bodies, too
  double initial_energy_;      ///< [J]
  std::chrono::steady_clock::duration wall_time_{0};
  std::size_t steps_ = 0;
  std::int64_t substeps_ = 0;
  double max_strain_ = 0;
  Extremes extremes_;
  std::map<std::string, std::vector<Wrench>> wrenches_;  ///< by attachment: step k at k modulo `averaged_steps_`
};

}  // namespace verlet_cable::cable_sim
