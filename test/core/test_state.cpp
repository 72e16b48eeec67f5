#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>

#include "../support/nets.h"
#include "../support/scenes.h"
#include "../support/world_inspector.h"
#include "verlet_cable/core/bytes.h"
#include "world/implementation.h"
#include "world/state_fields.h"

// What decides the future is the state, all of it is hashed, and what is done to one cable is nothing to another.

namespace verlet_cable {

namespace {

/// Something of everything: clamps, twist, rest curvature, stiff ends, breaking, a winch, a joint, contacts, nets of each kind,
/// each integrator's memory, a mesh, a robot, waiting cables and nets.
SceneDesc rich_scene() {
  SceneDesc scene = scenes::held_by_a_hand(8, AttachmentType::clamp);
  MaterialDesc& rope = scene.materials[0].material;
  rope.bending_stiffness = 1e-3;
  rope.torsional_stiffness = 1e-3;
  rope.axial_stiffness = 1000;
  scene.cables[0].rest_curvature.type = RestCurvatureDesc::Type::profile;
  scene.cables[0].rest_curvature.profile = {{1, 0}, {0, 1}};
  scene.cables[0].stiff_ends = {0.05, 0.05};
  for (const double x : {0.0, 0.008}) {
    CableDesc lying = scenes::one_cable(4, 0.4).cables[0];
    lying.name = "lying_" + std::to_string(scene.cables.size());
    lying.initial.type = InitialShapeDesc::Type::straight;
    lying.initial.from = {x, 0, -0.99};
    lying.initial.to = {x, 1, -0.99};
    scene.cables.push_back(lying);
  }
  CableDesc waiting = scenes::held_by_a_hand(4).cables[0];
  waiting.name = "waiting";
  for (AttachmentDesc& attachment : waiting.attachments) attachment.name += "_waiting";
  waiting.attachments[1].frame = "unknown";
  waiting.initial.points = {{0, 0, 0}, {1, 0, 0}};
  waiting.point_masses = {scenes::payload(0.1)};
  scene.cables.push_back(waiting);
  NetDesc flag = scenes::grid(2, 3, 0.1, LinkType::spring);
  flag.attachments = {scenes::net_attachment("corner", 0, {0, 0, 0})};
  NetDesc chain = scenes::chain({{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}}, LinkType::limited);
  chain.minimum_distances = {{{0, 2}, 0.05}};
  chain.attachments = {scenes::net_attachment("first", 0, {0, 0, 0})};
  NetDesc absent = chain;
  absent.name = "absent";
  absent.attachments[0].name = "absent_first";
  absent.attachments[0].frame = "unknown";
  scene.nets = {flag, chain, absent};
  ParticleDesc particle;
  particle.name = "particle";
  particle.mass = 1;
  scene.particles = {particle};
  ObstacleDesc floor;
  floor.name = "floor";
  floor.pose = {0, 0, -1, 0, 0, 0};
  ObstacleDesc ball;
  ball.name = "ball";
  ball.type = ShapeType::sphere;
  ball.radius = 0.1;
  ball.friction = 0.2;
  ball.frame = "hand";
  ball.pose = {0, 1, 0, 0, 0, 0};
  scene.obstacles = {floor, ball};
  scene.robot = RobotDesc{};
  scene.robot->tree.resize(2);
  scene.robot->tree[0].name = "base_link";
  scene.robot->tree[1].name = "hand";
  scene.robot->tree[1].parent = 0;
  scene.contact = ContactDesc{};
  return scene;
}

World rich_world() {
  const SceneDesc scene = rich_scene();
  BoundaryInputs inputs = initial_frames(scene);
  inputs[1] = {Pose{{0.6, 0, 0}, Quaternion::Identity()}, true};
  World world(scene, inputs);
  for (int i = 0; i < 100; ++i) {
    inputs[1].pose.position.z() = 1e-3 * i;
    world.step(inputs);
  }
  EXPECT_TRUE(world.apply(edit::SetLength{0, true, 1.2, 0.5}).ok);
  EXPECT_TRUE(world.apply(edit::ApplyLoad{"push", cable_id(1), 2, {}, {0.01, 0, 0}, Vector3::Zero(), false, 1}).ok);
  for (int i = 0; i < 20; ++i) world.step(inputs);
  return world;
}

/// What a multistep integrator remembers.
World remembering_world() {
  SceneDesc scene = scenes::flag(2, 3, 0.1, LinkType::spring);
  scene.integrator.type = IntegratorDesc::Type::pc5;
  ParticleDesc particle;
  particle.name = "particle";
  particle.mass = 1;
  scene.particles = {particle};
  World world(scene, initial_frames(scene));
  scenes::run(world, 10);
  return world;
}

/// Changes the lowest bit of the number that is visited as the `chosen`-th, and puts it back when called again.
class Flip {
 public:
  explicit Flip(long chosen) : chosen_(chosen) {}
  template <class Number>
  void operator()(Number& number) {
    if (count_++ != chosen_) return;
    if constexpr (!std::is_const_v<Number>) {
      unsigned char low;
      std::memcpy(&low, &number, 1);
      low ^= 1;
      std::memcpy(&number, &low, 1);
      flipped = true;
    }
  }
  long count() const { return count_; }
  bool flipped = false;

 private:
  long chosen_;
  long count_ = 0;
};

void expect_all_hashed(State& state) {
  const std::uint64_t before = hash(state);
  Flip counter(-1);
  visit(state, counter);
  long flipped = 0;
  for (long i = 0; i < counter.count(); ++i) {
    Flip there(i), back(i);
    visit(state, there);
    if (!there.flipped) continue;
    ++flipped;
    EXPECT_NE(hash(state), before) << "number " << i;
    visit(state, back);
    ASSERT_EQ(hash(state), before) << "number " << i;
  }
  EXPECT_GT(flipped, 200);
}

TEST(State, EveryNumberOfItIsHashed) {
  World world = rich_world();
  State& state = WorldInspector::state(world);
  ASSERT_FALSE(state.cable_progress[1].contacts.empty());
  ASSERT_TRUE(state.cable_progress[0].drive);
  ASSERT_EQ(state.waiting_cables.size(), 1u);
  ASSERT_EQ(state.waiting_nets.size(), 1u);
  expect_all_hashed(state);
  World remembering = remembering_world();
  ASSERT_EQ(WorldInspector::state(remembering).particle_integrators[0].known, 4);
  expect_all_hashed(WorldInspector::state(remembering));
}

TEST(State, GoesOnFromItsBytes) {
  World remembering = remembering_world();
  World rich = rich_world();
  for (World* world : {&rich, &remembering}) {
    const std::string bytes = world->save();
    World restored(world->scene());
    restored.restore(bytes);
    EXPECT_EQ(restored.hash(), world->hash());
    EXPECT_EQ(restored.save(), bytes);
    const BoundaryInputs inputs = [&] {
      BoundaryInputs now;
      for (std::size_t frame = 0; frame < world->frames().size(); ++frame)
        now.push_back({world->frame_pose(static_cast<int>(frame)), world->frame_known(static_cast<int>(frame))});
      return now;
    }();
    for (int i = 0; i < 50; ++i) {
      world->step(inputs);
      restored.step(inputs);
      ASSERT_EQ(restored.hash(), world->hash()) << i;
    }
  }
}

TEST(State, RefusesBytesThatAreNotItsOwn) {
  World world = rich_world();
  const std::string bytes = world.save();
  const std::uint64_t before = world.hash();
  for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 500)
    EXPECT_THROW(world.restore(bytes.substr(0, length)), std::invalid_argument) << length;
  EXPECT_THROW(world.restore(bytes + "x"), std::invalid_argument);
  std::string damaged = bytes;
  damaged.back() = static_cast<char>(damaged.back() ^ 1);
  EXPECT_THROW(world.restore(damaged), std::invalid_argument);
  EXPECT_EQ(world.hash(), before);
}

TEST(State, FlagsAreReadAsSetOrUnset) {
  for (const int byte : {0, 1, 2, 255}) {
    const char given = static_cast<char>(byte);
    ByteReader bytes({&given, 1});
    bool flag = false;
    if (byte > 1) {
      EXPECT_THROW(bytes(flag), std::invalid_argument) << byte;
    } else {
      bytes(flag);
      EXPECT_EQ(flag, byte == 1);
    }
  }
}

TEST(State, EveryNumberOfTheModelIsHashed) {
  World world = rich_world();
  State& state = WorldInspector::state(world);
  const std::uint64_t before = hash(state);
  SceneDesc scene = *state.scene;
  Flip counter(-1);
  visit(scene, counter);
  for (long i = 0; i < counter.count(); ++i) {
    SceneDesc changed = scene;
    Flip flip(i);
    visit(changed, flip);
    if (!flip.flipped) continue;
    state.scene = std::make_shared<const SceneDesc>(changed);
    EXPECT_NE(hash(state), before) << "number " << i;
  }
}

TEST(State, EveryNumberOfACableIsHashed) {
  World world = rich_world();
  State& state = WorldInspector::state(world);
  const std::uint64_t before = hash(state);
  const CableModel model = *state.cables[0].model;
  Flip counter(-1);
  visit(model, counter);
  EXPECT_GT(counter.count(), 10);
  for (long i = 0; i < counter.count(); ++i) {
    CableModel changed = model;
    Flip flip(i);
    visit(changed, flip);
    if (!flip.flipped) continue;
    state.cables[0].model = std::make_shared<const CableModel>(changed);
    EXPECT_NE(hash(state), before) << "number " << i;
  }
}

/// What an object with these fields in this order takes in memory: more, if one is left out of the list.
template <class Type>
std::size_t size_of_fields() {
  Type object{};
  std::size_t size = 0, widest = 1;
  const auto add = [&](auto& field) {
    using Field = std::remove_reference_t<decltype(field)>;
    size = (size + alignof(Field) - 1) / alignof(Field) * alignof(Field) + sizeof(Field);
    widest = std::max(widest, alignof(Field));
  };
  std::apply([&](auto&... field) { (add(field), ...); }, fields(object, static_cast<const Type*>(nullptr)));
  return (size + widest - 1) / widest * widest;
}

template <class Type>
class Fields : public ::testing::Test {};
using Types = ::testing::Types<MaterialDesc, CableDesc, AttachmentDesc, NetDesc, ParticleDesc, GravityDesc, FluidDesc, CableModel,
                               CableState, KinematicTarget, DirectionTarget, TwistSpan, LengthDrive, CachedContact, CableProgress,
                               JointProgress, BodyProgress, NetModel, NetState, PointState, LinkMemory, NetProgress,
                               SimulatedParticle, Attachment, Obstacle, Load, Frames, State>;
TYPED_TEST_SUITE(Fields, Types);

TYPED_TEST(Fields, AreAllListed) {
  EXPECT_EQ(size_of_fields<TypeParam>(), sizeof(TypeParam));
}

SceneDesc two_cables(double apart, bool contact) {
  SceneDesc scene = scenes::between_two_points(20, 0.6);
  scene.materials[0].material.bending_stiffness = 1e-3;
  scene.cables.push_back(scene.cables[0]);
  scene.cables[1].name = "other";
  for (AttachmentDesc& attachment : scene.cables[1].attachments) {
    attachment.name += "_other";
    attachment.offset.y() = apart;
  }
  ObstacleDesc floor;
  floor.name = "floor";
  floor.pose = {0, 0, -0.3, 0, 0, 0};
  scene.obstacles = {floor};
  if (contact) scene.contact = ContactDesc{};
  return scene;
}

bool same(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

void expect_same_cable(const World& a, const World& b, int cable) {
  EXPECT_TRUE(same(a.cables()[cable].state.positions, b.cables()[cable].state.positions));
  EXPECT_TRUE(same(a.cables()[cable].state.velocities, b.cables()[cable].state.velocities));
}

TEST(State, AnEditOfOneCableLeavesTheBytesOfOthers) {
  using Edit = std::function<EditResult(World&)>;
  const std::vector<Edit> edits{
      [](World& w) {
        return w.apply(edit::Cut{cable_id(0), 9});
      },
      [](World& w) {
        return w.apply(edit::Pin{"pin", cable_id(0), 10, 0, Pose{{0.3, 0, -0.2}, Quaternion::Identity()}, AttachmentType::hinge});
      },
      [](World& w) {
        return w.apply(edit::SetLength{0, true, 1.1, 1});
      },
      [](World& w) { return w.apply(edit::Unpin{"left"}); },
      [](World& w) {
        return w.apply(edit::ApplyLoad{"push", cable_id(0), 9, {}, {0, 0, 0.2}});
      },
      [](World& w) {
        return w.apply(edit::MoveAttachment{"left", Pose{{0.05, 0, 0}, Quaternion::Identity()}});
      }};
  for (const bool contact : {false, true})
    for (const Edit& edit : edits) {
      const SceneDesc scene = two_cables(1, contact);
      World world(scene, initial_frames(scene));
      scenes::run(world, 300);
      World edited = world;
      ASSERT_TRUE(edit(edited).ok);
      for (int i = 0; i < 10; ++i) {
        scenes::run(world, 20);
        scenes::run(edited, 20);
        expect_same_cable(world, edited, 1);
      }
    }
}

TEST(State, ACableMovesAsItDoesAlone) {
  for (const bool contact : {false, true}) {
    const SceneDesc scene = two_cables(1, contact);
    SceneDesc only = scene;
    only.cables.pop_back();
    World both(scene, initial_frames(scene)), alone(only, initial_frames(only));
    scenes::run(both, 400);
    scenes::run(alone, 400);
    expect_same_cable(both, alone, 0);
  }
}

/// Cables of as many segments, but of different kinds: straight and curved, elastic and not, clamped, twisted, in a fluid's drag,
/// lying on the floor, thick and thin, held in the middle.
std::vector<SceneDesc> kinds() {
  std::vector<SceneDesc> all;
  for (int i = 0; i < 12; ++i) {
    SceneDesc scene = scenes::between_two_points(20, 0.6);
    scene.materials[0].name = "material_" + std::to_string(i);
    MaterialDesc& material = scene.materials[0].material;
    CableDesc& cable = scene.cables[0];
    cable.name = "kind_" + std::to_string(i);
    cable.material = scene.materials[0].name;
    if (i % 2 == 1) material.bending_stiffness = 1e-3;
    if (i % 3 == 1) material.axial_stiffness = 500;
    if (i % 4 == 1 || i == 3) material.torsional_stiffness = 1e-3;
    material.radius = 0.003 + 0.001 * (i % 3);
    if (i == 3 || i == 5 || i == 9) {
      cable.rest_curvature.type = RestCurvatureDesc::Type::constant;
      cable.rest_curvature.curvature = {3, -2};
    }
    if (i == 5 || i == 7) {
      for (AttachmentDesc& attachment : cable.attachments) attachment.type = AttachmentType::clamp;
    }
    if (i == 7) cable.stiff_ends = {0.1, 0};
    if (i == 8 || i == 11) {
      AttachmentDesc middle = cable.attachments[0];
      middle.name = "middle";
      middle.place.at = PlaceDesc::At::arc_length;
      middle.place.arc_length = 0.5;
      middle.offset = {0.3, 0, -0.1};
      cable.attachments.push_back(middle);
    }
    if (i == 10) cable.attachments.pop_back();
    for (AttachmentDesc& attachment : cable.attachments) {
      attachment.name += "_" + std::to_string(i);
      attachment.offset.y() = 3 * i;
    }
    scene.fluid.velocity = {0, 1, 0};
    scene.fluid.density = 1;
    ObstacleDesc floor;
    floor.name = "floor";
    floor.pose = {0, 0, -0.25, 0, 0, 0};
    scene.obstacles = {floor};
    scene.contact = ContactDesc{};
    all.push_back(scene);
  }
  return all;
}

/// Nothing of one cable is left in what the next one is solved with.
TEST(State, CablesOfAllKindsMoveAsTheyDoAlone) {
  const std::vector<SceneDesc> all = kinds();
  for (const SceneDesc& first : all)
    for (const SceneDesc& second : all) {
      if (first.cables[0].name == second.cables[0].name) continue;
      SceneDesc scene = first;
      scene.materials.push_back(second.materials[0]);
      scene.cables.push_back(second.cables[0]);
      World both(scene, initial_frames(scene)), alone(second, initial_frames(second));
      scenes::run(both, 60);
      scenes::run(alone, 60);
      ASSERT_TRUE(same(both.cables()[1].state.positions, alone.cables()[0].state.positions))
          << second.cables[0].name << " after " << first.cables[0].name;
    }
}

/// Each is brought to rest alone, whatever was brought to rest before it.
TEST(State, TheOrderOfCablesDoesNotMatterToTheirStarts) {
  SceneDesc scene = two_cables(1, true);
  scene.materials[0].material.bending_stiffness = 0.01;
  for (CableDesc& cable : scene.cables)
    for (AttachmentDesc& attachment : cable.attachments) attachment.type = AttachmentType::clamp;
  scene.cables[0].length = 0.8;
  SceneDesc turned = scene;
  std::swap(turned.cables[0], turned.cables[1]);
  const World first(scene, initial_frames(scene)), second(turned, initial_frames(turned));
  for (const int i : {0, 1}) EXPECT_TRUE(same(first.cables()[i].state.positions, second.cables()[1 - i].state.positions)) << i;
}

/// Cables that come at each other at any speed, and with any time step, are found before they meet.
TEST(State, CablesThatComeAtEachOtherMeet) {
  for (const double time_step : {1e-3, 5e-3})
    for (const double speed : {0.5, 5.0, 20.0}) {
      SceneDesc scene = scenes::one_cable(20);
      scene.gravity.acceleration.setZero();
      scene.time_step = time_step;
      scene.contact = ContactDesc{};
      scene.cables.push_back(scene.cables[0]);
      scene.cables[1].name = "other";
      for (const int i : {0, 1}) {
        InitialShapeDesc& initial = scene.cables[i].initial;
        const double side = i == 0 ? -1 : 1;
        initial.type = InitialShapeDesc::Type::points;
        initial.points = {{i == 0 ? -0.5 : 0.0, i == 0 ? 0.0 : -0.5, 0.3 * side},
                          {i == 0 ? 0.5 : 0.0, i == 0 ? 0.0 : 0.5, 0.3 * side}};
        initial.velocities = {{0, 0, -speed * side}, {0, 0, -speed * side}};
      }
      World world(scene, initial_frames(scene));
      // Until they would have passed each other.
      scenes::run(world, static_cast<int>(std::ceil(0.6 / (speed * time_step))));
      EXPECT_GE(world.cables()[1].state.positions[10].z() - world.cables()[0].state.positions[10].z(), 0.004)
          << time_step << " s, " << speed << " m/s";
    }
}

}  // namespace
}  // namespace verlet_cable
