#include "rollouts.h"

#include <cmath>

#include "scenes.h"
#include "stopwatch.h"
#include "verlet_cable/core/world_stepper.h"

namespace verlet_cable::bench {
namespace {

constexpr double duration = 1, time_step = 0.005;
const Vector3 hand(0.6, 0, 0);

}  // namespace

World start_of(const Rollouts& rollouts) {
  SceneDesc scene = scenes::held_by_a_hand(rollouts.segments, rollouts.bends ? AttachmentType::clamp : AttachmentType::hinge);
  scene.time_step = time_step;
  if (rollouts.bends) scene.materials[0].material.bending_stiffness = 0.01;
  scene.cables[0].attachments[1].initial_pose = InitialPose{hand.x(), hand.y(), hand.z(), 0, 0, 0};
  BoundaryInputs inputs = initial_frames(scene);
  inputs[1].velocity = FrameVelocity{};
  World world(scene, inputs);
  world.settle();
  return world;
}

RolloutResult run(const Rollouts& rollouts) {
  World world = start_of(rollouts);
  world.step_one_by_one(true);
  std::vector<World> worlds(rollouts.count, world);
  std::vector<BoundaryInputs> inputs(rollouts.count, scenes::hand_at(hand));
  std::vector<WorldStep> steps(rollouts.count);
  for (int i = 0; i < rollouts.count; ++i) {
    steps[i].world = &worlds[i];
    steps[i].inputs = &inputs[i];
  }
  WorldStepper stepper;
  const double start = seconds_now();
  const int ends = static_cast<int>(std::lround(duration / time_step));
  for (int k = 1; k <= ends; ++k) {
    const double t = k * time_step;
    for (int i = 0; i < rollouts.count; ++i) {
      const double frequency = 1 + 0.5 * i / rollouts.count;
      inputs[i][1].pose.position.x() = hand.x() + 0.1 * (1 - std::cos(2 * M_PI * frequency * t));
    }
    if (rollouts.at_once)
      stepper.step(steps, true);
    else
      for (const WorldStep& step : steps) step.world->step(*step.inputs);
  }
  return {seconds_now() - start, worlds.back().hash()};
}

}  // namespace verlet_cable::bench
