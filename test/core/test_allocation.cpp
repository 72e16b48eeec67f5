#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "../support/scenes.h"

namespace {
long allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
// Not inlined: a compiler that sees only these two from within warns of memory that comes from `new` and goes to `free`.
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace verlet_cable {
namespace {

TEST(Allocation, StepAllocatesNothing) {
  SceneDesc scene = scenes::held_by_a_hand(50, AttachmentType::clamp);
  const SceneDesc whip = scenes::released(50, 1.5);
  scene.cables.push_back(whip.cables[0]);
  scene.cables.back().name = "whip";
  scene.cables.back().attachments[0].name = "top";
  scene.materials.push_back({"ribbon", scene.materials[0].material});
  scene.materials.back().material.bending_stiffness = {0.02, 0.005};
  scene.materials.back().material.torsional_stiffness = 0.01;
  scene.materials.back().material.yield_curvature = 1;
  CableDesc& ribbon = scene.cables.emplace_back();
  ribbon.name = "ribbon";
  ribbon.material = "ribbon";
  ribbon.length = 1;
  ribbon.segments = 41;
  ribbon.rest_curvature.type = RestCurvatureDesc::Type::constant;
  ribbon.rest_curvature.curvature = {1, 2};
  ribbon.attachments = {scenes::attachment("first", PlaceDesc::At::start, Vector3::Zero(), "", AttachmentType::clamp),
                        scenes::attachment("inside", PlaceDesc::At::arc_length, Vector3::Zero(), "hand", AttachmentType::clamp)};
  ribbon.attachments.back().place.arc_length = 0.7;
  // Of three materials, one of them elastic, with limits that it is beyond.
  scene.materials.push_back({"rubber", scene.materials[0].material});
  scene.materials.back().material.axial_stiffness = 100;
  scene.materials.back().material.maximum_tension = 1e-3;
  scene.materials[1].material.minimum_bend_radius = 1;
  CableDesc& mixed = scene.cables.emplace_back(scene.cables[0]);
  mixed.name = "mixed";
  mixed.sections = {{0.2, 0.5, "rubber"}, {0.5, 0.7, "ribbon"}};
  for (AttachmentDesc& attachment : mixed.attachments) attachment.name += "_mixed";
  for (NamedMaterial& named : scene.materials) named.material.torsional_stiffness = 0.01;
  BoundaryInputs inputs = scenes::hand_at({0.6, 0, 0});
  World world(scene, inputs);
  world.step(inputs);
  const long before = allocations;
  for (int i = 0; i < 1000; ++i) {
    inputs[1].pose.position.z() = 1e-4 * i;
    world.step(inputs);
  }
  EXPECT_EQ(allocations - before, 0);
}

/// A load that swings on a rope and carries a link.
TEST(Allocation, StepOfBodiesAllocatesNothing) {
  SceneDesc scene = scenes::one_cable(20);
  scene.cables[0].attachments = {scenes::attachment("top", PlaceDesc::At::start, Vector3::Zero(), "hand"),
                                 scenes::attachment("hook", PlaceDesc::At::end, Vector3::Zero())};
  scene.cables[0].attachments[1].body = "load";
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  for (const char* name : {"load", "link"}) {
    BodyDesc& body = scene.bodies.emplace_back();
    body.name = name;
    body.mass = 1;
    body.inertia = Vector3(0.01, 0.02, 0.015);
    body.pose = InitialPose{1, 0, 0, 0, 0, 0};
  }
  BodyAttachmentDesc& joint = scene.bodies[1].attachments.emplace_back();
  joint.name = "joint";
  joint.body = "load";
  joint.at = {-0.1, 0, 0, 0, 0, 0};
  joint.offset = {0.1, 0, 0};
  scene.bodies[1].pose = InitialPose{1.2, 0, 0, 0, 0, 0};
  BoundaryInputs inputs = scenes::hand_at({0, 0, 0});
  inputs.resize(frame_names(scene).size());
  World world(scene, inputs);
  for (int i = 0; i < 10; ++i) world.step(inputs);
  const long before = allocations;
  for (int i = 0; i < 1000; ++i) {
    inputs[1].pose.position.z() = 1e-4 * i;
    world.step(inputs);
  }
  EXPECT_EQ(allocations - before, 0);
}

/// A buoy floats on its tether.
TEST(Allocation, StepInWavesAllocatesNothing) {
  SceneDesc scene = scenes::one_cable(20);
  scene.fluid.density = 1000;
  scene.fluid.surface = 0;
  scene.fluid.waves = {{0.1, 3, 0, 0}, {0.05, 1.5, 1, 0}};
  scene.cables[0].attachments = {scenes::attachment("anchor", PlaceDesc::At::start, {0, 0, -1}),
                                 scenes::attachment("shackle", PlaceDesc::At::end, Vector3::Zero())};
  scene.cables[0].attachments[1].body = "buoy";
  BodyDesc& buoy = scene.bodies.emplace_back();
  buoy.name = "buoy";
  buoy.mass = 2;
  buoy.inertia = Vector3(0.01, 0.02, 0.015);
  buoy.pose = InitialPose{0.1, 0, -0.1, 0, 0, 0};
  buoy.fluid.volume = 0.005;
  buoy.fluid.drag_area = {0.01, 0.01, 0.02};
  buoy.fluid.added_mass = {1, 1, 2};
  const BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  for (int i = 0; i < 1000; ++i) world.step(inputs);
  const long before = allocations;
  for (int i = 0; i < 1000; ++i) world.step(inputs);
  EXPECT_EQ(allocations - before, 0);
}

/// A cable lies over a box on a floor.
TEST(Allocation, StepOfBodiesThatTouchAllocatesNothing) {
  SceneDesc scene = scenes::one_cable(20);
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.from = {-0.5, 0.01, 0.22};
  scene.cables[0].initial.to = {0.5, 0.01, 0.22};
  scene.obstacles.emplace_back().name = "floor";
  BodyDesc& body = scene.bodies.emplace_back();
  body.name = "box";
  body.mass = 1;
  body.pose = InitialPose{0, 0, 0.1, 0, 0, 0};
  body.shapes.emplace_back().type = ShapeType::box;
  body.shapes[0].size = {0.2, 0.2, 0.2};
  const BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  for (int i = 0; i < 1500; ++i) world.step(inputs);
  const long before = allocations;
  for (int i = 0; i < 500; ++i) world.step(inputs);
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace verlet_cable
