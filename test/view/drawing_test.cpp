#include "verlet_cable/view/drawing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../support/scenes.h"
#include "pictures.h"

namespace verlet_cable::view {
namespace {

SceneDesc scene_of_everything() {
  SceneDesc scene = scenes::between_two_points(10, 0.8);
  scene.cables[0].color = {1, 0, 0, 1};
  SectionDesc thick;
  thick.from = 0.5;
  thick.to = 1;
  thick.material = "thick";
  scene.materials.push_back({"thick", scene.materials[0].material});
  scene.materials.back().material.radius = 0.02;
  scene.cables[0].sections.push_back(thick);
  BodyDesc body;
  body.name = "plug";
  body.mass = 0.1;
  body.shapes.emplace_back();
  body.shapes.back().type = ShapeType::sphere;
  body.shapes.back().radius = 0.05;
  body.pose = InitialPose{0, 0, 1, 0, 0, 0};
  scene.bodies.push_back(body);
  ParticleDesc particle;
  particle.name = "particle";
  particle.mass = 0.1;
  particle.position = {0, 1, 0};
  scene.particles.push_back(particle);
  ObstacleDesc floor;
  floor.name = "floor";
  floor.pose[2] = -2;
  scene.obstacles.push_back(floor);
  return scene;
}

World world_of_everything() {
  const SceneDesc scene = scene_of_everything();
  return World(scene, initial_frames(scene));
}

TEST(Drawing, HasAllThatAWorldHas) {
  const World world = world_of_everything();
  const Drawing drawing = drawing_of(world);
  EXPECT_EQ(labels(drawing), (std::vector<std::string>{"cable", "particle", "plug", "floor"}));
  EXPECT_TRUE(validate(drawing).empty());
  const Thing& cable = drawing.things[0];
  EXPECT_EQ(cable.kind, Thing::Kind::cable);
  EXPECT_EQ(cable.look.color, (Color{1, 0, 0}));
  ASSERT_EQ(cable.tubes.size(), 1u);
  EXPECT_EQ(cable.tubes[0].centers, world.cables()[0].state.positions);
  ASSERT_EQ(cable.tubes[0].radii.size(), 10u);
  EXPECT_EQ(cable.tubes[0].radii.front(), 0.005);
  EXPECT_EQ(cable.tubes[0].radii.back(), 0.02);
  EXPECT_EQ(cable.tubes[0].orientations.size(), 10u);
  EXPECT_EQ(drawing.things[1].kind, Thing::Kind::particle);
  EXPECT_EQ(drawing.things[2].kind, Thing::Kind::body);
  EXPECT_EQ(drawing.things[2].pose.position, Vector3(0, 0, 1));
  EXPECT_EQ(drawing.things[3].look.pattern, Look::Pattern::checks);
}

TEST(Drawing, ColorsAreToldApartWhereThatIsWanted) {
  SceneDesc scene = scenes::one_cable(4);
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.to = {1, 0, 0};
  scene.cables.push_back(scene.cables[0]);
  scene.cables[1].name = "other";
  const World world(scene, initial_frames(scene));
  DrawingOptions options;
  EXPECT_EQ(drawing_of(world, options).things[0].look.color, drawing_of(world, options).things[1].look.color);
  options.distinct_colors = true;
  EXPECT_NE(drawing_of(world, options).things[0].look.color, drawing_of(world, options).things[1].look.color);
}

TEST(Drawing, ErrorsAreNamedAllAtOnce) {
  Drawing drawing;
  drawing.things.push_back(thing_of("ball", SphereShape{-1}));
  drawing.things.push_back(cable("cable", {{{0, 0, 0}, {1, NAN, 0}}, {0.1}, {}}, {0, 0, 0}));
  drawing.things.push_back(thing_of("mesh", MeshShape{}));
  drawing.things[2].look.color = {0, 2, 0};
  drawing.light.direction = Vector3::Zero();
  const std::vector<std::string> errors = validate(drawing);
  ASSERT_EQ(errors.size(), 6u);
  EXPECT_EQ(errors[0], "things[0].parts[0].shape: out of range; allowed: sizes above 0, and a mesh that is there");
  EXPECT_EQ(errors[1], "things[1]: out of order; allowed: cables, nets, particles, bodies and the others, in this order");
  EXPECT_EQ(errors[2].rfind("things[1].tubes[0]: out of range; allowed: two finite centers or more", 0), 0u);
  EXPECT_EQ(errors[3].rfind("things[2].look: out of range", 0), 0u);
  EXPECT_EQ(errors[4].rfind("things[2].parts[0].shape", 0), 0u);
  EXPECT_EQ(errors[5].rfind("light.direction: [0, 0, 0]; allowed: ", 0), 0u);
  EXPECT_THROW(Stage{drawing}, std::invalid_argument);
}

TEST(Drawing, NothingIsSeenOfAnEmptyOne) {
  const Picture picture = picture_of(Stage(Drawing{}), model_of(8, 8), {});
  for (const float depth : picture.depth) EXPECT_TRUE(std::isnan(depth));
  for (const auto number : picture.mask) EXPECT_EQ(number, 0);
}

}  // namespace
}  // namespace verlet_cable::view
