#include "simulation/batch.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/world/parallel_for.h"
#include "simulation/batch_materials.h"
#include "simulation/batch_scenes.h"
#include "simulation/memory_check.h"
#include "simulation/quantity.h"

namespace verlet_cable {
namespace {

/// Worlds that a thread steps together: enough for the widest lanes, and few enough to stay in its cache.
constexpr std::size_t share = 16;

/// False where the world has no such part.
bool try_copy(const World& world, const Part& part, double* to) {
  if (!part.at_points) return try_copy_quantity(world, part.quantity, part.name, part.shape, to);
  if (find(world.cables(), part.name) < 0) return false;
  copy_points(world, part.quantity, part.name, part.shape.rows, to);
  return true;
}

/// Errors name the scene, where it is not the first.
DrivenWorld begin(const std::shared_ptr<const SceneDesc>& scene, std::size_t index, const Motion& motion,
                  const LoadPlayer& loads) {
  try {
    return DrivenWorld(scene, motion, loads);
  } catch (const SceneError& error) {
    if (index == 0) throw;
    std::vector<std::string> lines = error.errors();
    for (std::string& line : lines) line = "scenes[" + std::to_string(index) + "]: " + line;
    throw SceneError(std::move(lines));
  }
}

/// Before copies are made. [byte] of a world, and of each of its nodes, at least.
void check_size(const World& world, std::size_t count) {
  constexpr double least = 1000, least_of_node = 200;
  double nodes = static_cast<double>(world.particles().size());
  for (const SimulatedCable& cable : world.cables()) nodes += cable.state.nodes();
  for (const SimulatedNet& net : world.nets()) nodes += net.model.nodes();
  check_memory("count: " + std::to_string(count) + " worlds", static_cast<double>(count) * (least + least_of_node * nodes));
}

}  // namespace

/// The threads that step, and what each needs for it.
class Batch::Threads {
 public:
  struct Buffers {
    WorldStepper stepper;
    std::vector<WorldStep> steps;
  };

  explicit Threads(int count) : arena_(count == 0 ? tbb::task_arena::automatic : count), alone_(count == 1) {}

  /// Calls `work(first, last)` for shares of so many items, on all threads; on this one where it is one share.
  template <class Work>
  void share_out(std::size_t items, const Work& work) {
    if (alone_ || items <= share) {
      for (std::size_t first = 0; first < items; first += share) work(first, std::min(items, first + share));
      return;
    }
    const std::size_t shares = (items + share - 1) / share;
    arena_.execute([&] { parallel_for(shares, [&](std::size_t i) { work(i * share, std::min(items, (i + 1) * share)); }); });
  }

  Buffers& buffers() { return buffers_.local(); }

 private:
  tbb::task_arena arena_;
  bool alone_;
  tbb::enumerable_thread_specific<Buffers> buffers_;
};

Batch::Batch(const std::vector<std::shared_ptr<const SceneDesc>>& scenes, const Motion& motion, const LoadPlayer& loads,
             int threads, bool keeps_going)
    : threads_(std::make_shared<Threads>(threads)), status_(scenes.size()), errors_(scenes.size()) {
  std::map<const SceneDesc*, std::size_t> known;  // looked up only: its order does not matter
  std::optional<std::size_t> first;               // that is right
  std::optional<SceneError> wrong;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const auto [same, is_new] = known.emplace(scenes[i].get(), i);
    try {
      if (!is_new) {
        errors_[i] = errors_[same->second];
        if (first) worlds_.push_back(worlds_[same->second]);
        continue;
      }
      if (first) check_alike(*scenes[*first], *scenes[i], "scenes[" + std::to_string(i) + "]");
      DrivenWorld world = begin(scenes[i], i, motion, loads);
      if (!first) {
        check_size(world.world(), scenes.size());
        worlds_.reserve(scenes.size());
        worlds_.assign(i, world);  // for those before it
        first = i;
      }
      worlds_.push_back(std::move(world));
    } catch (const SceneError& error) {
      if (!keeps_going) throw;
      errors_[i] = error.what();
      if (!wrong) wrong = error;
      if (first) worlds_.push_back(worlds_[*first]);
    }
  }
  if (!first) throw *wrong;
  for (DrivenWorld& world : worlds_) world.world().step_one_by_one(true);
  begin_status();
  events_.resize(worlds_.size());
  for (std::size_t i = 0; i < worlds_.size(); ++i) begin_events(i);
}

Batch::Batch(const DrivenWorld& world, std::size_t count, int threads)
    : threads_(std::make_shared<Threads>(threads)), status_(count, StepResult::Status::ok), errors_(count) {
  check_size(world.world(), count);
  worlds_.assign(count, world);
  events_.resize(count);
  for (DrivenWorld& copy : worlds_) copy.world().step_one_by_one(true);
}

Batch::Batch(std::vector<DrivenWorld> worlds, std::vector<std::string> errors, std::vector<StepResult::Status> status,
             int threads)
    : threads_(std::make_shared<Threads>(threads)),
      worlds_(std::move(worlds)),
      events_(worlds_.size()),
      status_(std::move(status)),
      errors_(std::move(errors)) {
  for (DrivenWorld& world : worlds_) world.world().step_one_by_one(true);
}

void Batch::begin_status() {
  for (std::size_t i = 0; i < status_.size(); ++i)
    status_[i] = errors_[i].empty() ? StepResult::Status::ok : StepResult::Status::fault;
}

void Batch::begin_events(std::size_t world) {
  events_[world] = {};
  events_[world].observe_start(worlds_[world].world());
}

void Batch::note_change_of(std::size_t index) {
  worlds_[index].world().step_one_by_one(true);
  drop_records();
}

void Batch::set_worlds(const std::vector<std::size_t>& indices, const DrivenWorld& world) {
  check_alike(worlds_.front().scene(), world.scene(), "world");
  if (indices.empty()) return;
  threads_->share_out(indices.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      DrivenWorld& copy = worlds_[indices[i]];
      copy = world;
      copy.world().step_one_by_one(true);
      status_[indices[i]] = StepResult::Status::ok;
      errors_[indices[i]].clear();
      events_[indices[i]] = {};
    }
  });
  drop_records();
}

void Batch::set_material(const std::string& name, const std::vector<MaterialChange>& changes) {
  const std::vector<std::shared_ptr<const SceneDesc>> scenes = scenes_with(name, changes, worlds_);
  std::vector<DrivenWorld> changed = worlds_;
  std::vector<char> begun(changed.size(), 0);
  for (std::size_t i = 0; i < changed.size(); ++i) {
    begun[i] = changed[i].is_as_it_began() ? 1 : 0;
    if (begun[i] != 0)
      changed[i].begin_anew(scenes[i]);
    else
      changed[i].tune(scenes[i]);
    changed[i].world().step_one_by_one(true);
  }
  replace(std::move(changed), begun);
}

/// Of those that have `begun`, events begin, too.
void Batch::replace(std::vector<DrivenWorld> worlds, const std::vector<char>& begun) {
  worlds_ = std::move(worlds);
  for (std::size_t i = 0; i < worlds_.size(); ++i)
    if (begun[i] != 0) begin_events(i);
}

void Batch::share_out(const std::function<void(std::size_t, std::size_t)>& work) const {
  threads_->share_out(worlds_.size(), work);
}

void Batch::set_frame(const std::string& name, const std::vector<Pose>& poses) {
  const std::size_t steps = poses.size() / worlds_.size();
  std::vector<int> frames(worlds_.size());
  std::vector<char> lacks(worlds_.size());
  share_out([&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      frames[i] = worlds_[i].index_of_frame(name);
      lacks[i] = worlds_[i].has_unplaced_frames() ? 1 : 0;
    }
  });
  const auto unknown = std::find(frames.begin(), frames.end(), -1) - frames.begin();
  if (unknown == 0) worlds_.front().find_frame(name);
  if (unknown < static_cast<std::ptrdiff_t>(frames.size())) refuse_frame(static_cast<std::size_t>(unknown), name);
  if (std::find(lacks.begin(), lacks.end(), 1) == lacks.end()) {
    share_out([&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) worlds_[i].set_frame(frames[i], &poses[i * steps], steps);
    });
    return;
  }
  std::vector<DrivenWorld> changed = worlds_;
  std::vector<char> begun(changed.size(), 0);
  std::vector<std::string> errors;
  for (std::size_t i = 0; i < changed.size() && errors.size() < most_errors; ++i) {
    try {
      begun[i] = changed[i].set_frame(frames[i], &poses[i * steps], steps) ? 1 : 0;
      if (begun[i] != 0) changed[i].world().step_one_by_one(true);
    } catch (const SceneError& error) {
      for (const std::string& line : error.errors()) errors.push_back("world " + std::to_string(i) + ": " + line);
    }
  }
  if (!errors.empty()) throw SceneError(std::move(errors));
  replace(std::move(changed), begun);
}

/// The frame is in other worlds.
void Batch::refuse_frame(std::size_t world, const std::string& name) const {
  try {
    worlds_[world].find_frame(name);
  } catch (const UnknownName& error) {
    throw UnknownName("world " + std::to_string(world) + ": " + error.what());
  }
}

void Batch::apply(const std::vector<edit::ApplyLoad>& loads) {
  for (std::size_t i = 0; i < worlds_.size(); ++i) {
    const EditResult result = worlds_[i].world().apply(loads[i]);
    if (!result.ok) throw std::invalid_argument("world " + std::to_string(i) + ": " + result.message);
  }
}

void Batch::require_placed_frames() const {
  for (std::size_t i = 0; i < worlds_.size(); ++i)
    if (worlds_[i].has_unplaced_frames()) worlds_[i].require_placed_frames("world " + std::to_string(i) + ": ");
}

std::optional<OddWorld> Batch::copy(const std::vector<Part>& parts, std::optional<double> missing, double* to) const {
  std::size_t row = 0;
  for (const Part& part : parts) row += part.shape.size();
  std::vector<std::size_t> copied(worlds_.size(), 0);  // parts of each world
  threads_->share_out(worlds_.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      double* next = to + i * row;
      for (const Part& part : parts) {
        if (!try_copy(worlds_[i].world(), part, next)) {
          if (!missing) break;
          std::fill_n(next, part.shape.size(), *missing);
        }
        next += part.shape.size();
        ++copied[i];
      }
    }
  });
  for (std::size_t i = 0; i < copied.size(); ++i)
    if (copied[i] < parts.size()) return OddWorld{i, copied[i]};
  return std::nullopt;
}

void Batch::begin_steps(std::int64_t steps, std::int64_t record_every, const std::vector<Quantity>& quantities) {
  std::optional<Records> records;
  if (record_every > 0)
    records.emplace(worlds_.front().world(), quantities, worlds_.size(), static_cast<std::size_t>(steps / record_every));
  records_ = std::move(records);
  record_every_ = record_every;
  steps_done_ = 0;
  begin_status();
}

void Batch::advance(std::int64_t steps) {
  threads_->share_out(worlds_.size(), [&](std::size_t first, std::size_t last) { advance(first, last, steps); });
  steps_done_ += steps;
}

void Batch::advance(std::size_t first, std::size_t last, std::int64_t steps) {
  Threads::Buffers& buffers = threads_->buffers();
  for (std::int64_t done = steps_done_ + 1; done <= steps_done_ + steps; ++done) {
    buffers.steps.clear();
    for (std::size_t i = first; i < last; ++i)
      if (errors_[i].empty()) buffers.steps.push_back({&worlds_[i].world(), &worlds_[i].next_inputs(), {}});
    buffers.stepper.step(buffers.steps, false);
    auto stepped = buffers.steps.begin();
    for (std::size_t i = first; i < last; ++i) {
      if (!errors_[i].empty()) continue;
      const StepResult& result = (stepped++)->result;
      status_[i] = std::max(status_[i], result.status);
      events_[i].observe(worlds_[i].world(), result, worlds_[i].held_back(), worlds_[i].refused_loads());
    }
    if (record_every_ == 0 || done % record_every_ != 0) continue;
    for (std::size_t i = first; i < last; ++i)
      records_->add(worlds_[i].world(), i, static_cast<std::size_t>(done / record_every_ - 1));
  }
}

std::vector<char> Batch::settle() {
  std::vector<char> found(worlds_.size());
  threads_->share_out(worlds_.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (!errors_[i].empty()) continue;
      found[i] = worlds_[i].world().settle();
      events_[i].observe_start(worlds_[i].world());
    }
  });
  return found;
}

}  // namespace verlet_cable
