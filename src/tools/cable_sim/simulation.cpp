#include "simulation.h"

#include <algorithm>
#include <cmath>

#include "scene/frame_speed.h"

namespace verlet_cable::cable_sim {
namespace {

constexpr double averaged_time = 0.1;  // [s]
constexpr double longest_jump = 5e-3;  // [s] see Jump

}  // namespace

std::int64_t averaged_steps(const Job& job) {
  return std::max<std::int64_t>(1, std::llround(averaged_time / job.scene.time_step));
}

RunEnd simulate(const Job& job, const FrameSource& frames, LoadPlayer loads, World& world, const Recorders& recorders) {
  using Clock = std::chrono::steady_clock;
  const double time_step = job.scene.time_step;
  const RowSchedule schedule(job.rate, time_step);
  std::int64_t row = 0;
  const auto write_due_rows = [&] {
    if (row == job.rows || world.steps() < schedule.step_of(row)) return;
    ++row;
    if (recorders.nodes) write_nodes(world, *recorders.nodes);
    if (recorders.bodies) write_bodies(world, *recorders.bodies);
    if (recorders.usd) recorders.usd->add(world);
    if (recorders.vtk) recorders.vtk->add(world);
  };

  BoundaryInputs inputs = frames.at(0);
  const auto inputs_of_next_step = [&](const World& of, std::vector<int>& held_back) {
    BoundaryInputs targets = frames.at(static_cast<double>(of.steps() + 1) * time_step);
    held_back = limit_frame_motion(inputs, job.scene.max_frame_speed * time_step, targets);
    inputs = std::move(targets);
  };
  std::vector<int> held_back;
  bool jumps = false;
  write_due_rows();
  while (world.steps() < job.steps) {
    if (recorders.stop.signal()) return RunEnd::signal;
    for (const CsvWriter* csv : {recorders.nodes, recorders.bodies})
      if (csv && csv->has_failed()) return RunEnd::output_failed;
    if (recorders.vtk && !recorders.vtk->problem().empty()) return RunEnd::output_failed;
    inputs_of_next_step(world, held_back);
    recorders.events.add_refused_loads(world, loads.apply_due(world));
    const Clock::time_point start = Clock::now();
    const StepResult result = world.step(inputs);
    const Clock::time_point end = Clock::now();

    recorders.summary.add_step(world, result, end - start);
    recorders.events.observe(world, result, held_back);
    if (recorders.pictures) recorders.pictures->add(world);
    if (result.status == StepResult::Status::fault) return RunEnd::fault;
    write_due_rows();
    recorders.progress.show(world.time(), end);
    jumps = result.status == StepResult::Status::jumped;
  }
  if (!jumps) return RunEnd::done;
  // Whether the last steps were a jump is known only when it is over.
  World later = world;
  while (jumps && later.time() - world.time() <= longest_jump) {
    inputs_of_next_step(later, held_back);
    jumps = later.step(inputs).status == StepResult::Status::jumped;
    recorders.events.add_jumps(later);
  }
  return RunEnd::done;
}

}  // namespace verlet_cable::cable_sim
