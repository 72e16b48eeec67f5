#include <gtest/gtest.h>

#include "verlet_cable/core/world.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable {
namespace {

class LectureScene : public testing::TestWithParam<const char*> {};

TEST_P(LectureScene, runsAndStaysFinite) {
  const SceneDesc scene = read_scene_file(std::string(CONFIG_DIRECTORY) + "/scenes/lecture/" + GetParam() + ".yaml");
  const BoundaryInputs frames = initial_frames(scene);
  World world(scene, frames);
  for (int i = 0; i < 500; ++i) ASSERT_EQ(world.step(frames).status, StepResult::Status::ok) << i;
  for (const SimulatedNet& net : world.nets())
    for (const Vector3& position : net.state.positions) EXPECT_TRUE(position.allFinite());
  for (const SimulatedParticle& particle : world.particles()) EXPECT_TRUE(particle.position.allFinite());
}

INSTANTIATE_TEST_SUITE_P(Each, LectureScene,
                         testing::Values("box", "planet", "oscillator", "ropes", "elastic_flag", "semi_rigid_flag",
                                         "figure_on_stairs", "dragged_figure"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace verlet_cable
