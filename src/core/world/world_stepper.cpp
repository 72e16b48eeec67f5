#include "verlet_cable/core/world_stepper.h"

#include <tbb/enumerable_thread_specific.h>

#include "world/flush_denormals.h"
#include "world/implementation.h"
#include "world/island_stepper.h"
#include "world/parallel_for.h"

namespace verlet_cable {

namespace {

/// Fewer worlds are not worth another core.
constexpr std::size_t least_share = 8;

}  // namespace

struct WorldStepper::Implementation {
  /// Of a thread.
  struct Buffers {
    Workspace workspace;
    std::vector<IslandStepper> steppers;
  };
  tbb::enumerable_thread_specific<Buffers> buffers;

  void step(std::vector<WorldStep>& worlds, std::size_t from, std::size_t to);
};

WorldStepper::WorldStepper() : implementation_(std::make_unique<Implementation>()) {}
WorldStepper::~WorldStepper() = default;

void WorldStepper::step(std::vector<WorldStep>& worlds, bool all_cores) {
  if (!all_cores || worlds.size() < 2 * least_share) return implementation_->step(worlds, 0, worlds.size());
  parallel_for(worlds.size(), least_share, [&](std::size_t from, std::size_t to) { implementation_->step(worlds, from, to); });
}

void WorldStepper::Implementation::step(std::vector<WorldStep>& worlds, std::size_t from, std::size_t to) {
  const FlushDenormals flush_denormals;
  Workspace& workspace = buffers.local().workspace;
  std::vector<IslandStepper>& steppers = buffers.local().steppers;
  steppers.clear();
  steppers.reserve(to - from);  // what waits points to them
  for (std::size_t i = from; i < to; ++i) {
    World::Implementation& world = *worlds[i].world->implementation_;
    worlds[i].result = {};
    world.begin_step(*worlds[i].inputs, worlds[i].result);
    const std::size_t islands = world.islands.value.all().size();
    world.island_outcomes.value.resize(islands);
    steppers.emplace_back(world.state, workspace, world.cable_outcomes.value, world.most_lanes);
    world.step_islands(0, islands, steppers.back());
  }
  if (!steppers.empty()) steppers.back().finish();
  for (std::size_t i = from; i < to; ++i) {
    World::Implementation& world = *worlds[i].world->implementation_;
    world.resume_islands(true);
    world.end_step(worlds[i].result);
  }
}

}  // namespace verlet_cable
