#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulation/driven_world.h"
#include "simulation/records.h"
#include "verlet_cable/core/world_stepper.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable {

/// A number of a material, for each world.
struct MaterialChange {
  std::string field;                     ///< a key of materials
  std::vector<BendingStiffness> values;  ///< one a world; but for bending_stiffness both numbers are the same
};

/// Many worlds that are alike but for numbers, stepped together. What comes out does not depend on the number of threads, and is
/// the same as of each world alone.
class Batch {
 public:
  /// A world a scene; `threads`: how many step them, 0: as many as there are cores. Throws SceneError where a scene is wrong, or
  /// differs from the first in more than numbers.
  Batch(std::vector<std::shared_ptr<const SceneDesc>> scenes, const Motion& motion, int threads);

  std::size_t size() const { return worlds_.size(); }
  const DrivenWorld& operator[](std::size_t index) const { return worlds_[index]; }
  DrivenWorld& operator[](std::size_t index) { return worlds_[index]; }

  /// Changes a material of the scenes. At t = 0 the worlds start anew from them; later what tuning takes over is changed, which
  /// linear_density is not. Throws SceneError with all that is wrong, and UnknownName.
  void set_material(const std::string& name, const std::vector<MaterialChange>& changes);

  /// Begins a call: what the steps until the next one record, after every `record_every` of them; 0: nothing.
  void begin_steps(std::int64_t steps, std::int64_t record_every, const std::vector<Quantity>& quantities);
  /// So many of the steps that have begun.
  void advance(std::int64_t steps);

  /// What was recorded since `begin_steps` is not there: the steps were not finished.
  void drop_records() { records_ = {}; }

  const Records& records() const { return records_; }
  /// The worst of each world since `begin_steps`.
  const std::vector<StepResult::Status>& status() const { return status_; }

  /// True where all that is held found an equilibrium.
  std::vector<char> settle();

 private:
  class Threads;

  void advance(std::size_t first, std::size_t last, std::int64_t steps);
  std::vector<DrivenWorld> make_worlds(const std::vector<std::shared_ptr<const SceneDesc>>& scenes) const;

  Motion motion_;
  std::shared_ptr<Threads> threads_;  ///< of copies, too: nobody steps two at once
  std::vector<DrivenWorld> worlds_;
  std::vector<StepResult::Status> status_;
  Records records_;
  std::int64_t record_every_ = 0;
  std::int64_t steps_done_ = 0;  ///< since begin_steps
};

}  // namespace verlet_cable
