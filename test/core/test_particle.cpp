#include <gtest/gtest.h>

#include <cmath>

#include "../support/meshes.h"
#include "../support/nets.h"
#include "../support/scenes.h"

namespace verlet_cable {
namespace {

using Type = IntegratorDesc::Type;

Vector3 planet_at_2(double h, Type integrator) {
  World world(scenes::planet(h, integrator), {FrameInput{}});
  scenes::run(world, static_cast<int>(std::lround(2 / h)));
  return world.particles()[0].position;
}

TEST(Particle, FallsFreely) {
  SceneDesc scene = scenes::weightless();
  scene.gravity.acceleration = {0, 0, -9.81};
  scene.particles = scenes::planet(1, Type::verlet).particles;
  for (const Type type : {Type::verlet, Type::rk4, Type::pc5}) {
    scene.integrator.type = type;
    World world(scene, {FrameInput{}});
    scenes::run(world, 1000);
    EXPECT_NEAR(world.particles()[0].position.z(), -0.5 * 9.81, 1e-11);
    EXPECT_NEAR(world.particles()[0].velocity.z(), -9.81, 1e-11);
  }
}

TEST(Particle, FirstStepOfTheLecture) {
  SceneDesc scene;
  scene.particles = scenes::planet(1, Type::verlet).particles;
  scene.integrator.first_step = IntegratorDesc::FirstStep::lecture;
  World world(scene, {FrameInput{}});
  scenes::run(world, 1);
  EXPECT_NEAR(world.particles()[0].position.z(), -9.81e-6, 1e-18);
}

TEST(Particle, IntegratorsHaveTheirOrders) {
  const Vector3 exact = planet_at_2(1e-3, Type::pc5);
  struct Expected {
    Type type;
    double order;
  };
  for (const Expected& expected :
       {Expected{Type::euler, 1}, Expected{Type::verlet, 2}, Expected{Type::rk4, 4}, Expected{Type::pc5, 5}}) {
    const double coarse = (planet_at_2(0.02, expected.type) - exact).norm(),
                 fine = (planet_at_2(0.01, expected.type) - exact).norm();
    EXPECT_NEAR(std::log2(coarse / fine), expected.order, 0.35);
  }
}

TEST(Particle, VerletKeepsThePlanetsEnergyInABand) {
  World world(scenes::planet(0.01, Type::verlet), {FrameInput{}});
  const double energy = world.energy().total();
  double first = 0, last = 0;
  const int steps = 200000, tenth = steps / 10;
  for (int i = 0; i < steps; ++i) {
    scenes::run(world, 1);
    const double error = world.energy().total() - energy;
    ASSERT_LT(std::abs(error), 1e-4);
    if (i < tenth) first += error / tenth;
    if (i >= steps - tenth) last += error / tenth;
  }
  // The tenths are no whole number of orbits: a part of one in 22, of a band of 5e-6.
  EXPECT_LT(std::abs(last - first), 1e-7);
}

TEST(Particle, RungeKuttaLosesEnergySteadily) {
  World world(scenes::planet(0.05, Type::rk4), {FrameInput{}});
  double before = world.energy().total();
  for (int part = 0; part < 4; ++part) {
    scenes::run(world, 20000);
    EXPECT_LT(world.energy().total(), before);
    before = world.energy().total();
  }
}

TEST(Particle, BouncesElasticallyInABox) {
  SceneDesc scene;
  const double half_turn = M_PI, quarter = M_PI / 2;
  const InitialPose walls[] = {{0, 0, -1, 0, 0, 0},       {0, 0, 1, half_turn, 0, 0}, {-1, 0, 0, 0, quarter, 0},
                               {1, 0, 0, 0, -quarter, 0}, {0, -1, 0, -quarter, 0, 0}, {0, 1, 0, quarter, 0, 0}};
  for (const InitialPose& pose : walls) {
    ObstacleDesc wall;
    wall.name = "wall_" + std::to_string(scene.obstacles.size());
    wall.pose = pose;
    scene.obstacles.push_back(wall);
  }
  for (int i = 0; i < 20; ++i) {
    ParticleDesc particle;
    particle.name = "p" + std::to_string(i);
    particle.mass = 0.1;
    particle.position = {0.09 * i - 0.9, 0.5 * std::sin(i), 0.5 * std::cos(3 * i)};
    particle.velocity = {3 * std::sin(7 * i), 3 * std::cos(5 * i), 0.1 * i};
    scene.particles.push_back(particle);
  }
  World world(scene, {FrameInput{}});
  const double energy = world.energy().total();
  for (int i = 0; i < 5000; ++i) {
    scenes::run(world, 1);
    for (const SimulatedParticle& particle : world.particles()) ASSERT_LT(particle.position.cwiseAbs().maxCoeff(), 1 + 1e-9);
  }
  EXPECT_NEAR(world.energy().total(), energy, 1e-6 * 20);
}

TEST(Particle, LiesWhereNothingBounces) {
  SceneDesc scene;
  scene.particles = scenes::planet(1, Type::verlet).particles;
  scene.particles[0].restitution = 0;
  ObstacleDesc floor;
  floor.name = "floor";
  floor.pose = {0, 0, -0.5, 0, 0, 0};
  floor.friction = 0.5;
  scene.obstacles = {floor};
  World world(scene, {FrameInput{}});
  scenes::run(world, 2000);
  EXPECT_NEAR(world.particles()[0].position.z(), -0.5, 1e-6);
  EXPECT_NEAR(world.particles()[0].velocity.norm(), 0, 1e-2);
}

/// A box of 0.4 m, or the same as a mesh.
ObstacleDesc box_obstacle(bool is_mesh, const Vector3& size = {0.4, 0.4, 0.4}) {
  ObstacleDesc box;
  box.name = "box";
  box.type = is_mesh ? ShapeType::mesh : ShapeType::box;
  box.size = size;
  if (is_mesh) box.mesh = box_triangles(size).mesh();
  return box;
}

SceneDesc above_a_box(bool is_mesh, double restitution) {
  SceneDesc scene;
  scene.particles = scenes::planet(1, Type::verlet).particles;
  scene.particles[0].position = {0.02, 0.01, 0.35};
  scene.particles[0].velocity = {0.1, 0, 0};
  scene.particles[0].restitution = restitution;
  scene.particles[0].friction = 0.2;
  scene.obstacles = {box_obstacle(is_mesh)};
  return scene;
}

TEST(Particle, BouncesOffAMeshAsOffTheShapeItCovers) {
  for (const Type type : {Type::verlet, Type::rk4})
    for (const double restitution : {1.0, 0.5, 0.0}) {
      SceneDesc of_box = above_a_box(false, restitution), of_mesh = above_a_box(true, restitution);
      of_box.integrator.type = of_mesh.integrator.type = type;
      World box(of_box, {FrameInput{}}), mesh(of_mesh, {FrameInput{}});
      for (int i = 0; i < 1000; ++i) {
        scenes::run(box, 1);
        scenes::run(mesh, 1);
        ASSERT_GT(mesh.particles()[0].position.z(), 0.2 - 1e-9);
        ASSERT_LT((mesh.particles()[0].position - box.particles()[0].position).norm(), 1e-9) << restitution << " " << i;
      }
    }
}

TEST(Particle, IsPushedByAMeshThatRises) {
  SceneDesc scene = above_a_box(true, 0);
  scene.particles[0].velocity.setZero();
  scene.particles[0].position.z() = 0.21;
  scene.obstacles[0].frame = "lift";
  World world(scene, initial_frames(scene));
  BoundaryInputs inputs(world.frames().size());
  for (int i = 1; i <= 1000; ++i) {
    inputs.back().pose.position = {0, 0, 0.3e-3 * i};
    world.step(inputs);
    ASSERT_GT(world.particles()[0].position.z(), 0.2 + 0.3e-3 * i - 1e-9) << i;
  }
  EXPECT_NEAR(world.particles()[0].position.z(), 0.5, 1e-3);
}

TEST(Particle, ThatIsFastDoesNotPassThroughAThinWall) {
  for (const bool is_mesh : {false, true})
    for (const double speed : {10.0, 100.0, 300.0}) {
      SceneDesc scene = scenes::weightless();
      scene.particles = scenes::planet(1, Type::verlet).particles;
      scene.particles[0].position = {0.02, 0.01, 1.03};
      scene.particles[0].velocity = {0, 0, -speed};
      scene.obstacles = {box_obstacle(is_mesh, {1, 1, 0.02})};
      World world(scene, {FrameInput{}});
      scenes::run(world, static_cast<int>(1500 / speed));
      EXPECT_NEAR(world.particles()[0].velocity.z(), speed, 1e-9);
      EXPECT_NEAR(world.particles()[0].position.z(), 0.01 + 1e-3 * speed * std::floor(1500 / speed) - 1.02, 1e-6);
    }
}

TEST(Particle, ThatStartsInsideIsPutOnTheSurface) {
  for (const bool is_mesh : {false, true}) {
    SceneDesc scene = above_a_box(is_mesh, 0);
    scene.particles[0].position = {0.02, 0.01, 0.15};
    scene.particles[0].velocity.setZero();
    World world(scene, {FrameInput{}});
    scenes::run(world, 1000);
    EXPECT_NEAR(world.particles()[0].position.z(), 0.2, 1e-6);
  }
}

TEST(Particle, CentralGravityActsOnCablesNodeByNode) {
  // A free cable of one segment falls like its two nodes: its middle is pulled by the mean of two different forces.
  SceneDesc scene = scenes::one_cable(1, 1.0);
  scene.gravity.type = GravityDesc::Type::central;
  scene.gravity.mu = 4;
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.from = {1, 0, 0};
  scene.cables[0].initial.to = {2, 0, 0};
  World world(scene, {FrameInput{}});
  const double energy = world.energy().total();
  EXPECT_NEAR(world.energy().gravity, -0.05 * 4 * (1 + 0.5), 1e-12);
  scenes::run(world, 10);
  const double middle = 0.5 * (world.cables()[0].state.velocities[0].x() + world.cables()[0].state.velocities[1].x());
  EXPECT_NEAR(middle, -0.01 * 0.5 * (4.0 / 1 + 4.0 / 4), 1e-5);
  EXPECT_GT(world.cables()[0].state.tension[0], 0);
  scenes::run(world, 190);
  EXPECT_NEAR(world.energy().total(), energy, 1e-5);
}

TEST(Particle, ThatRunsAwayIsReportedAndStaysFinite) {
  SceneDesc scene = scenes::planet(0.01, Type::euler);
  scene.gravity.mu = 1e12;
  scene.particles[0].position = {1e-3, 0, 0};
  World world(scene, {FrameInput{}});
  const StepResult result = world.step({FrameInput{}});
  EXPECT_EQ(result.status, StepResult::Status::degraded);
  EXPECT_EQ(result.cause, DegradedCause::unstable);
  EXPECT_TRUE(result.body == particle_id(0));
  EXPECT_TRUE(world.particles()[0].position.allFinite());
}

}  // namespace
}  // namespace verlet_cable
