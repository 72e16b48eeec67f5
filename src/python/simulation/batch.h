#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulation/batch_materials.h"
#include "simulation/driven_world.h"
#include "simulation/event_record.h"
#include "simulation/records.h"
#include "verlet_cable/core/world_stepper.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable {

/// What is read of each world, the name being looked up in it, and the shape that it should have.
struct Part {
  Quantity quantity = Quantity::positions;
  std::string name;
  QuantityShape shape;
  bool at_points = false;  ///< rows are points of a cable, see copy_points; else what the world has
};

/// A world that does not have a part, or has another shape of it.
struct OddWorld {
  std::size_t world = 0, part = 0;
};

/// Many worlds that are alike but for numbers, stepped together. What comes out does not depend on the number of threads, and is
/// the same as of each world alone.
class Batch {
 public:
  /// A world a scene; `threads`: how many step them, 0: as many as there are cores. Throws SceneError where a scene is wrong, or
  /// differs from the first in more than numbers; or, where it `keeps_going` and one scene at least is right, has for it a copy
  /// of the first world that is right, which is never stepped, and what is wrong in `errors`.
  Batch(const std::vector<std::shared_ptr<const SceneDesc>>& scenes, const Motion& motion, const LoadPlayer& loads, int threads,
        bool keeps_going = false);
  /// These, of scenes that differ in no more than numbers; see `errors` and `status`, of which there is one for each.
  Batch(std::vector<DrivenWorld> worlds, std::vector<std::string> errors, std::vector<StepResult::Status> status, int threads);
  /// So many copies of a world as it is.
  Batch(const DrivenWorld& world, std::size_t count, int threads);

  std::size_t size() const { return worlds_.size(); }
  const DrivenWorld& operator[](std::size_t index) const { return worlds_[index]; }
  /// To change it, and then say so.
  DrivenWorld& operator[](std::size_t index) { return worlds_[index]; }
  /// Drops the records.
  void note_change_of(std::size_t index);
  /// What has happened to a world since it began or was replaced.
  EventRecord& events(std::size_t index) { return events_[index]; }
  const EventRecord& events(std::size_t index) const { return events_[index]; }

  /// What is wrong with the scene of each world, empty where nothing is. Others are not stepped, and their status is fault.
  const std::vector<std::string>& errors() const { return errors_; }

  /// These worlds, each named once, go on as copies of another. Throws SceneError where its scene differs from theirs in more
  /// than numbers. Drops the records.
  void set_worlds(const std::vector<std::size_t>& indices, const DrivenWorld& world);

  /// Changes a material of the scenes. Worlds that are as they began begin anew with them; of others what tuning takes over is
  /// changed, which linear_density is not. Throws SceneError with all that is wrong, and UnknownName.
  void set_material(const std::string& name, const std::vector<MaterialChange>& changes);

  /// Calls work(first, last) for shares of the worlds, on all threads at once.
  void share_out(const std::function<void(std::size_t, std::size_t)>& work) const;

  /// See DrivenWorld::set_frame; `poses`: so many for each world after another. Throws UnknownName, and SceneError; then nothing
  /// is changed.
  void set_frame(const std::string& name, const std::vector<Pose>& poses);

  /// One a world, which were checked. Throws std::invalid_argument where a world has too many.
  void apply(const std::vector<edit::ApplyLoad>& loads);

  /// Writes the parts of world after world, side by side. What a world does not have is `missing`; without that, the first world
  /// that lacks something is returned.
  std::optional<OddWorld> copy(const std::vector<Part>& parts, std::optional<double> missing, double* to) const;

  /// See DrivenWorld; names the first world that lacks some.
  void require_placed_frames() const;

  /// Begins a call: what the steps until the next one record, after every `record_every` of them; 0: nothing.
  void begin_steps(std::int64_t steps, std::int64_t record_every, const std::vector<Quantity>& quantities);
  /// So many of the steps that have begun.
  void advance(std::int64_t steps);

  /// What was recorded since `begin_steps` is not there: the steps were not finished.
  void drop_records() { records_.reset(); }

  /// Null where the last step recorded nothing.
  const Records* records() const { return records_ ? &*records_ : nullptr; }
  /// The worst of each world since `begin_steps`; fault where there is an error.
  const std::vector<StepResult::Status>& status() const { return status_; }

  /// True where all that is held found an equilibrium.
  std::vector<char> settle();

 private:
  class Threads;

  void advance(std::size_t first, std::size_t last, std::int64_t steps);
  void begin_status();
  void begin_events(std::size_t world);
  void refuse_frame(std::size_t world, const std::string& name) const;
  void replace(std::vector<DrivenWorld> worlds, const std::vector<char>& begun);

  std::shared_ptr<Threads> threads_;  ///< of copies, too: nobody steps two at once
  std::vector<DrivenWorld> worlds_;
  std::vector<EventRecord> events_;  ///< one a world
  std::vector<StepResult::Status> status_;
  std::vector<std::string> errors_;
  std::optional<Records> records_;
  std::int64_t record_every_ = 0;
  std::int64_t steps_done_ = 0;  ///< since begin_steps
};

}  // namespace verlet_cable
