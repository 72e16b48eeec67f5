#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "../support/scenes.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

GuideDesc guide(const std::string& name, std::optional<double> at, const Vector3& offset,
                GuideDesc::Type type = GuideDesc::Type::eyelet) {
  GuideDesc desc;
  desc.name = name;
  desc.cable = "cable";
  if (at) desc.place = PlaceDesc{PlaceDesc::At::arc_length, *at};
  desc.offset = offset;
  desc.type = type;
  if (type == GuideDesc::Type::sheave) desc.rotation = {0.5 * M_PI, 0, 0};
  return desc;
}

/// Over an eyelet at the origin, down on both sides with loads [kg] at the ends.
SceneDesc two_loads(double at_start, double at_end, double length = 2) {
  SceneDesc scene = scenes::one_cable(50, length);
  scene.cables[0].point_masses = {scenes::payload(at_start), scenes::payload(at_end)};
  scene.cables[0].point_masses[0].place.at = PlaceDesc::At::start;
  const Vector3 side(0.25 * length, 0, -0.25 * std::sqrt(3.0) * length);
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  scene.cables[0].initial.points = {{-side.x(), 0, side.z()}, Vector3::Zero(), side};
  scene.guides = {guide("eye", 0.5 * length, Vector3::Zero())};
  return scene;
}

void run(World& world, double duration, const BoundaryInputs& inputs = {}) {
  const int steps = static_cast<int>(std::lround(duration / world.time_step()));
  for (int i = 0; i < steps; ++i) ASSERT_EQ(world.step(inputs).status, Status::ok) << "at " << world.time() << " s";
}

double mass_of(const SimulatedCable& cable) {
  return std::accumulate(cable.state.masses.begin(), cable.state.masses.end(), 0.0);
}

TEST(Guides, areNoAttachmentsByName) {
  SceneDesc scene = two_loads(0.1, 0.1);
  scene.cables[0].initial = {};
  scene.cables[0].point_masses.clear();
  scene.cables[0].attachments = {scenes::attachment("eye", PlaceDesc::At::start, {-0.2, 0, -0.9}),
                                 scenes::attachment("other", PlaceDesc::At::end, {0.2, 0, -0.9})};
  World world(scene, {});
  EXPECT_LT(world.attachments()[find(world.attachments(), "eye")].guide, 0);
  EXPECT_TRUE(world.apply(edit::Unpin{"eye"}).ok);
  const EditResult refused = world.apply(edit::Unpin{"eye"});
  EXPECT_FALSE(refused.ok);
  EXPECT_NE(refused.message.find("is a guide, which cannot be unpinned"), std::string::npos) << refused.message;
}

/// Whatever the cable is: its law of motion is another where it bends, twists or is of several materials.
struct Kind {
  const char* name;
  void (*make)(SceneDesc&);
};

void PrintTo(const Kind& kind, std::ostream* stream) {
  *stream << kind.name;
}

const Kind kinds[] = {
    {"chain", [](SceneDesc&) {}},
    {"elastic", [](SceneDesc& scene) { scene.materials[0].material.axial_stiffness = 1e4; }},
    {"steel",
     [](SceneDesc& scene) {
       scene.materials[0].material.axial_stiffness = 6e5;
       scene.materials[0].material.axial_damping = 60;
     }},
    {"bending", [](SceneDesc& scene) { scene.materials[0].material.bending_stiffness = 1e-4; }},
    {"ribbon",
     [](SceneDesc& scene) {
       scene.materials[0].material.bending_stiffness = BendingStiffness(1e-4, 2e-4);
       scene.materials[0].material.torsional_stiffness = 1e-4;
     }},
    {"coil",
     [](SceneDesc& scene) {
       scene.materials[0].material.bending_stiffness = 1e-4;
       scene.materials[0].material.torsional_stiffness = 1e-4;
       scene.cables[0].rest_curvature.type = RestCurvatureDesc::Type::constant;
       scene.cables[0].rest_curvature.curvature = {0.5, 0};
     }},
    {"sections",
     [](SceneDesc& scene) {
       scene.materials.push_back({"lead", scene.materials[0].material});
       scene.materials[1].material.linear_density = 0.3;
       scene.cables[0].sections = {{0.6, 0.9, "lead"}};
     }},
};

class GuidedKinds : public testing::TestWithParam<Kind> {};

/// With loads so different that nodes pass all the time.
TEST_P(GuidedKinds, keepMassLengthAndEnergyWhileNodesPass) {
  SceneDesc scene = two_loads(1, 3);
  GetParam().make(scene);
  scene.numerical_damping = false;
  World world(scene, {});
  const double mass = mass_of(world.cables()[0]), energy = world.energy().total();
  run(world, 0.35);
  const GuideView view = world.view_guide(0);
  EXPECT_LT(view.arc_length, 0.8);
  EXPECT_NEAR(mass_of(world.cables()[0]), mass, 1e-12);
  EXPECT_NEAR(world.cables()[0].state.length(), 2, 2e-3);
  EXPECT_NEAR(world.energy().total(), energy, 5e-3 * world.energy().kinetic);
}

TEST_P(GuidedKinds, goOnFromSnapshotsInTheMiddleOfAPass) {
  SceneDesc scene = two_loads(1, 3);
  GetParam().make(scene);
  World world(scene, {});
  const std::size_t nodes = world.cables()[0].state.masses.size();
  // Until a node has just been taken in, or given out.
  run(world, 0.2);
  for (int i = 0; i < 200 && world.cables()[0].state.masses.size() == nodes; ++i) run(world, world.time_step());
  World copy = world;
  EXPECT_EQ(copy.hash(), world.hash());
  run(world, 0.2);
  run(copy, 0.2);
  EXPECT_EQ(copy.hash(), world.hash());
  World again(scene, {});
  run(again, world.time());
  EXPECT_EQ(again.hash(), world.hash());
}

INSTANTIATE_TEST_SUITE_P(All, GuidedKinds, testing::ValuesIn(kinds), [](const auto& info) { return info.param.name; });

TEST(Clips, letGoWhatIsDrawnAcrossThem) {
  SceneDesc scene = scenes::one_cable(40, 1);
  scene.cables[0].attachments = {scenes::attachment("left", PlaceDesc::At::start, {-0.45, 0, 0}),
                                 scenes::attachment("right", PlaceDesc::At::end, {0.45, 0, 0}, "hand")};
  scene.cables[0].attachments[1].offset.setZero();
  scene.cables[0].attachments[1].initial_pose = InitialPose{0.45, 0, 0, 0, 0, 0};
  scene.guides = {guide("clip", 0.5, Vector3::Zero(), GuideDesc::Type::clip)};
  scene.guides[0].retention = 5;
  scene.guides[0].capture = 0.01;
  World world(scene, initial_frames(scene));
  BoundaryInputs inputs = initial_frames(scene);
  // The hand goes up, and draws the cable out of the clip.
  int released = 0, caught = 0;
  double force = 0;
  const auto move_to = [&](const Vector3& place, int steps) {
    const Vector3 from = inputs[1].pose.position;
    for (int i = 1; i <= steps; ++i) {
      const double part = static_cast<double>(i) / steps;
      inputs[1].pose.position = from + part * part * (3 - 2 * part) * (place - from);
      if (world.view_guide(0).cable >= 0) force = world.attachments()[find(world.attachments(), "clip")].force.norm();
      world.step(inputs);
      released += static_cast<int>(world.findings().released.size());
      caught += static_cast<int>(world.findings().caught.size());
    }
  };
  move_to({0.2, 0, 0.7}, 1500);
  EXPECT_EQ(released, 1);
  EXPECT_EQ(caught, 0);
  EXPECT_NEAR(force, 5, 0.6);
  EXPECT_EQ(world.view_guide(0).cable, -1);
  EXPECT_EQ(find(world.attachments(), "clip"), -1);
  // Back again: it was away, so that the clip takes it.
  const Vector3 high = inputs[1].pose.position;
  for (int i = 1; i <= 1500 && caught == 0; ++i) move_to(high + i / 1500.0 * (Vector3(0.45, 0, 0.05) - high), 1);
  EXPECT_EQ(caught, 1);
  EXPECT_EQ(world.view_guide(0).cable, 0);
}

TEST(Clips, waitUntilTheCableWasAway) {
  SceneDesc scene = scenes::between_two_points(40, 0.9);
  scene.guides = {guide("clip", 0.5, {0, 0, 0}, GuideDesc::Type::clip)};
  scene.guides[0].offset = {0.45, 0, -0.15};
  scene.guides[0].retention = 1e-3;
  scene.guides[0].capture = 0.5;
  World world(scene, {});
  int released = 0, caught = 0;
  for (int i = 0; i < 500; ++i) {
    world.step({});
    released += static_cast<int>(world.findings().released.size());
    caught += static_cast<int>(world.findings().caught.size());
  }
  // Never 2 * 0.5 m away.
  EXPECT_EQ(released, 1);
  EXPECT_EQ(caught, 0);
}

/// A clip behind a socket has caught the cable of a plug that a hand has pushed in. What pulls at the cable does not pull the
/// plug through the clip; the hand that draws the plug back has it out again.
struct PluggedIn {
  SceneDesc scene;
  BoundaryInputs inputs;
  World world;

  explicit PluggedIn(double capture) : scene(make(capture)), inputs(initial_frames(scene)), world(scene, inputs) {}

  static SceneDesc make(double capture) {
    SceneDesc scene = scenes::one_cable(60, 0.6);
    MaterialDesc& material = scene.materials[0].material;
    material.axial_stiffness = 1e4;
    material.bending_stiffness = 5e-3;
    material.bending_damping = 5e-5;
    BodyDesc plug;
    plug.name = "plug";
    plug.mass = 0.02;
    plug.inertia = Vector3(1e-5, 1e-5, 1e-5);
    plug.attachments.resize(1);
    plug.attachments[0].name = "grip";
    plug.attachments[0].frame = "hand";
    plug.attachments[0].type = AttachmentType::clamp;
    plug.attachments[0].initial_pose = InitialPose{0, 0, 0, 0, 0, 0};
    scene.bodies = {plug};
    AttachmentDesc far = scenes::attachment("far", PlaceDesc::At::start, Vector3::Zero(), "far_hand");
    far.initial_pose = InitialPose{-0.45, 0, 0, 0, 0, 0};
    far.type = AttachmentType::clamp;
    AttachmentDesc back = scenes::attachment("back", PlaceDesc::At::end, Vector3::Zero());
    back.body = "plug";
    back.type = AttachmentType::clamp;
    scene.cables[0].attachments = {far, back};
    scene.guides = {guide("clip", 0.56, {-0.04, 0, 0}, GuideDesc::Type::clip)};
    scene.guides[0].capture = capture;
    return scene;
  }

  /// Moves a frame by `way` [m] along x at 5 cm/s. Returns the largest force on the hand [N].
  double move(const std::string& frame, double way) {
    const std::vector<std::string> names = frame_names(scene);
    const auto id = static_cast<std::size_t>(std::find(names.begin(), names.end(), frame) - names.begin());
    const double start = inputs[id].pose.position.x();
    const int steps = static_cast<int>(std::abs(way) / 0.05 / world.time_step());
    double largest = 0;
    for (int i = 1; i <= steps; ++i) {
      inputs[id].pose.position.x() = start + way * i / steps;
      EXPECT_EQ(world.step(inputs).status, StepResult::Status::ok) << world.time();
      released += static_cast<int>(world.findings().released.size());
      const int grip = find(world.attachments(), "grip");
      if (grip >= 0) largest = std::max(largest, world.attachments()[grip].force.norm());
    }
    return largest;
  }
  int released = 0;
};

TEST(Clips, letGoOfAnEndThatIsPushedBackThroughThem) {
  for (const double capture : {0.0, 0.004}) {
    PluggedIn plugged(capture);
    EXPECT_LT(plugged.move("hand", -0.08), capture > 0 ? 30 : 200) << capture;
    EXPECT_EQ(plugged.released, 1) << capture;
    EXPECT_NEAR(plugged.world.bodies()[0].pose.position.x(), -0.08, 1e-9) << capture;
  }
}

TEST(Clips, stopAnEndThatIsPulledThroughThem) {
  PluggedIn plugged(0.004);
  ASSERT_TRUE(plugged.world.apply(edit::Unpin{"grip"}).ok);
  // The clip is 0.6 m away from the hand then.
  plugged.move("far_hand", -0.192);
  EXPECT_EQ(plugged.released, 0);
  EXPECT_NE(find(plugged.world.attachments(), "clip"), -1);
  EXPECT_NEAR(plugged.world.bodies()[0].pose.position.x(), -0.04, 0.002);
  EXPECT_GT(plugged.world.attachments()[find(plugged.world.attachments(), "far")].force.norm(), 10);
}

TEST(Guides, cablesThatBendSettleInThem) {
  for (const double stiffness : {0.0, 0.01, 0.1}) {
    for (const bool whole_rod : {false, true}) {
      SceneDesc scene = scenes::between_two_points(50, 1.2, 1.6);
      MaterialDesc& material = scene.materials[0].material;
      material.bending_stiffness = stiffness;
      material.bending_damping = 1e-3 * stiffness;
      if (whole_rod) material.bending_stiffness = BendingStiffness(stiffness, 2 * stiffness + 1e-4);
      if (whole_rod) material.torsional_stiffness = 1e-3;
      scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
      scene.guides = {guide("eye", 0.8, {0.6, 0, 0.2})};
      World world(scene, {});
      EXPECT_TRUE(world.findings().unsettled.empty()) << stiffness << whole_rod;
      const double arc_length = world.view_guide(0).arc_length;
      run(world, 0.3);
      EXPECT_LT(world.energy().kinetic, 1e-12) << stiffness << whole_rod;
      EXPECT_NEAR(world.view_guide(0).arc_length, arc_length, 1e-6) << stiffness << whole_rod;
    }
  }
}

/// Once it stands: while its ends are in motion the rope lags behind them, and without drag it sways about for long.
TEST(Guides, materialComesBackWithItsSections) {
  SceneDesc scene = two_loads(0, 0);
  scene.materials[0].material.drag = 0.3;
  scene.materials.push_back({"lead", scene.materials[0].material});
  scene.materials[1].material.linear_density = 0.3;
  CableDesc& cable = scene.cables[0];
  cable.initial = {};
  cable.sections = {{0.8, 1.2, "lead"}};
  cable.point_masses.clear();
  cable.attachments = {scenes::attachment("left", PlaceDesc::At::start, Vector3::Zero(), "left"),
                       scenes::attachment("right", PlaceDesc::At::end, Vector3::Zero(), "right")};
  cable.attachments[0].initial_pose = InitialPose{-0.9, 0, 0, 0, 0, 0};
  cable.attachments[1].initial_pose = InitialPose{0.9, 0, 0, 0, 0, 0};
  World world(scene, initial_frames(scene));
  BoundaryInputs inputs = initial_frames(scene);
  const auto lead = [&] {
    const CableState& state = world.cables()[0].state;
    std::array<double, 2> found{2, 0};
    double at = 0;
    for (int i = 0; i < state.segments(); ++i) {
      if (state.section_material[i] == 1) found = {std::min(found[0], at), std::max(found[1], at + state.rest_lengths[i])};
      at += state.rest_lengths[i];
    }
    return found;
  };
  const double mass = mass_of(world.cables()[0]);
  for (int i = 1; i <= 6000; ++i) {
    const double shift = 0.5 * std::sin(M_PI * std::min(i, 4000) / 2000);
    inputs[1].pose.position.x() = -0.9 + shift;
    inputs[2].pose.position.x() = 0.9 + shift;
    ASSERT_EQ(world.step(inputs).status, Status::ok);
    EXPECT_NEAR(lead()[0], 0.8, 0.05) << i;
    EXPECT_NEAR(lead()[1], 1.2, 0.05) << i;
  }
  EXPECT_NEAR(mass_of(world.cables()[0]), mass, 1e-12);
  EXPECT_NEAR(world.view_guide(0).arc_length, 1, 0.02);
}

/// A cable that bends, from a hand through an eyelet [0.17 m away], with a load at its end; the hand draws it back within 0.33 s.
SceneDesc drawn_through_an_eyelet(int segments, double bending_stiffness) {
  SceneDesc scene = scenes::one_cable(segments, 0.64);
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = 0.026;
  material.radius = 0.00225;
  material.axial_stiffness = 8.4e4;
  material.bending_stiffness = bending_stiffness;
  CableDesc& cable = scene.cables[0];
  cable.point_masses = {scenes::payload(0.05)};
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = {{0, 0, 0}, {0.64, 0, 0}};
  cable.attachments = {scenes::attachment("hand", PlaceDesc::At::start, Vector3::Zero(), "hand")};
  cable.attachments[0].initial_pose = InitialPose{0, 0, 0, 0, 0, 0};
  scene.guides = {guide("eye", 0.17, {0.17, 0, 0})};
  return scene;
}

TEST(Guides, makeNoEnergyAsNodesOfABentCablePass) {
  for (const double stiffness : {1e-4, 3.7e-4, 1e-2})
    for (const int segments : {20, 35}) {
      SceneDesc scene = drawn_through_an_eyelet(segments, stiffness);
      World world(scene, initial_frames(scene));
      BoundaryInputs inputs = initial_frames(scene);
      double energy = 0, gain = 0;
      for (int i = 1; i <= 2000; ++i) {
        const double part = std::clamp((i * world.time_step() - 0.3) / 0.33, 0.0, 1.0);
        inputs[1].pose.position.x() = -0.145 * part;
        EXPECT_EQ(world.step(inputs).status, Status::ok) << stiffness << " " << segments;
        const double before = std::exchange(energy, world.energy().total());
        if (i > 900) gain = std::max(gain, energy - before);
      }
      EXPECT_LT(gain, 1e-5) << stiffness << " " << segments;
      EXPECT_NEAR(world.cables()[0].state.length(), 0.64, 1e-3) << stiffness << " " << segments;
    }
}

/// Where nodes pass forward and back again, nothing is gained either.
TEST(Guides, giveBackWhatTheyHoldOfNodesThatPass) {
  SceneDesc scene = drawn_through_an_eyelet(35, 1e-3);
  scene.numerical_damping = false;
  scene.cables[0].attachments[0].frame.clear();
  scene.cables[0].attachments[0].initial_pose.reset();
  World world(scene, {});
  const double energy = world.energy().total();
  double held = 0;
  for (int i = 0; i < 2000; ++i) {
    run(world, world.time_step());
    EXPECT_LT(world.energy().total(), energy + 1e-5) << i;
    held = std::max(held, std::abs(world.guides()[0].held_energy));
  }
  EXPECT_GT(held, 1e-9);
  EXPECT_NEAR(world.ledger().unaccounted(), 0, 1e-5);
}

/// Whatever the cable is, and where it stretches: friction takes what is lacking.
TEST(Guides, accountForTheirFriction) {
  for (const double axial_stiffness : {infinity, 2e3}) {
    SceneDesc scene = two_loads(1, 3);
    scene.materials[0].material.axial_stiffness = axial_stiffness;
    scene.materials[0].material.axial_damping = axial_stiffness < infinity ? 1 : 0;
    scene.guides[0].friction = 0.2;
    scene.numerical_damping = false;
    World world(scene, {});
    run(world, 0.3);
    const Ledger ledger = world.ledger();
    EXPECT_GT(ledger.balance.dissipated.guides, 0.05) << axial_stiffness;
    EXPECT_NEAR(ledger.unaccounted(), 0, 1e-5 * ledger.balance.dissipated.guides) << axial_stiffness;
  }
}

/// Near the guide a free end is no obstacle: it goes through, though nothing else drives it there.
TEST(Guides, letFreeEndsRunOut) {
  for (const double stiffness : {0.0, 1e-3})
    for (const double friction : {0.0, 0.3})
      for (const double time_step : {1e-3, 5e-3}) {
        SceneDesc scene = scenes::one_cable(40, 0.6);
        scene.time_step = time_step;
        scene.gravity.acceleration.setZero();
        scene.materials[0].material.bending_stiffness = stiffness;
        scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
        scene.cables[0].initial.from = Vector3::Zero();
        scene.cables[0].initial.to = {0.6, 0, 0};
        scene.cables[0].attachments = {scenes::attachment("h", PlaceDesc::At::start, Vector3::Zero(), "hand")};
        scene.cables[0].attachments[0].initial_pose = InitialPose{};
        scene.guides = {guide("eye", 0.25, {0.25, 0, 0})};
        scene.guides[0].friction = friction;
        BoundaryInputs inputs = initial_frames(scene);
        World world(scene, inputs);
        double largest = 0;
        std::size_t released = 0;
        for (int i = 0; i < std::lround(4 / time_step); ++i) {
          inputs[1].pose.position.x() = -0.1 * (i + 1) * time_step;
          EXPECT_EQ(world.step(inputs).status, Status::ok);
          released += world.findings().released.size();
          if (world.time() > 0.1) largest = std::max(largest, world.attachments()[0].force.norm());
        }
        EXPECT_EQ(released, 1u) << stiffness << " " << friction << " " << time_step;
        EXPECT_LT(largest, 1e-6) << stiffness << " " << friction << " " << time_step;
      }
}

/// A stiff straight wire that a hand pushes along lies in two eyelets: what rubs is what they bear of it, however little it is
/// drawn.
TEST(Guides, rubByHowHardTheyPress) {
  SceneDesc scene = scenes::one_cable(40, 1);
  MaterialDesc& material = scene.materials[0].material;
  material.bending_stiffness = 0.5;
  material.bending_damping = 0.005;
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.to = {1, 0, 0};
  scene.cables[0].attachments = {scenes::attachment("hand", PlaceDesc::At::start, Vector3::Zero(), "hand")};
  scene.cables[0].attachments[0].initial_pose = InitialPose{0, 0, 0, 0, 0, 0};
  scene.guides = {guide("first", 0.25, {0.25, 0, 0}), guide("second", 0.75, {0.75, 0, 0})};
  for (GuideDesc& eyelet : scene.guides) eyelet.friction = 0.3;
  BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  const auto force_on = [&](const char* name) { return world.attachments()[find(world.attachments(), name)].force; };
  double pushing = 0, pressing = 0;
  const int steps = 1000;
  for (int i = 1; i <= steps; ++i) {
    inputs[1].pose.position.x() = 0.1 * i * world.time_step();
    ASSERT_EQ(world.step(inputs).status, Status::ok) << "at " << world.time() << " s";
    if (2 * i <= steps) continue;
    pushing += 2.0 / steps * std::abs(force_on("hand").x());
    pressing += 2.0 / steps * (std::abs(force_on("first").z()) + std::abs(force_on("second").z()));
  }
  EXPECT_NEAR(pushing, 0.3 * pressing, 0.01 * pressing);
  EXPECT_GT(pressing, 0.9 * mass_of(world.cables()[0]) * 9.81);
}

/// What falls back through many eyelets, hardly drawn and here and there pressed, slides in some of them and sticks in others.
TEST(Guides, rubOnWhatIsHardlyDrawn) {
  SceneDesc scene = scenes::one_cable(160, 2);
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = 0.07;
  material.axial_stiffness = 4e4;
  material.axial_damping = 4;
  material.bending_stiffness = 2.8e-3;
  material.bending_damping = 2.8e-5;
  scene.cables[0].attachments = {scenes::attachment("hand", PlaceDesc::At::start, Vector3::Zero())};
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  scene.cables[0].initial.points = {Vector3::Zero()};
  double arc_length = 0;
  for (int i = 1; i < 7; ++i) {
    const Vector3 place(0.25 * i, i % 2 == 0 ? 0.03 : 0.04, 0);
    arc_length += (place - scene.cables[0].initial.points.back()).norm();
    scene.cables[0].initial.points.push_back(place);
    scene.guides.push_back(guide("eye" + std::to_string(i), arc_length, place));
    scene.guides.back().friction = 0.3;
  }
  scene.cables[0].initial.points.push_back({1.5 + 2 - arc_length, 0.03, 0});
  World world(scene, {});
  run(world, 0.5);
}

/// Nothing but its own weight holds a rope that a load draws through eyelets by a good part of a segment a step: the nodes keep
/// up.
TEST(Guides, passNodesOfWhatRuns) {
  SceneDesc scene = two_loads(0.01, 0.2);
  scene.cables[0].segments = 120;
  scene.time_step = 0.005;
  scene.guides[0].friction = 0.1;
  scene.guides.push_back(guide("second", 1.2, {0.1, 0, -0.1 * std::sqrt(3.0)}));
  World world(scene, {});
  run(world, 0.4);
}

/// A load that comes to a wheel is stopped there, on an elastic rope again and again: what stops it only takes energy, also where
/// the rope turns round within a step.
TEST(Guides, stopLoadsAndNeverPushThem) {
  constexpr double radius = 0.05, hanging = 0.7;
  for (const double bearing_friction : {0.0, 0.005}) {
    SceneDesc scene = two_loads(0.27, 0.22, M_PI * radius + 2 * hanging);
    scene.materials[0].material.linear_density = 0.03;
    scene.materials[0].material.axial_stiffness = 2e4;
    scene.materials[0].material.axial_damping = 2;
    scene.cables[0].segments = 60;
    std::vector<Vector3>& points = scene.cables[0].initial.points;
    points = {{-radius, 0, -hanging}};
    for (int i = 0; i <= 24; ++i) points.emplace_back(-radius * std::cos(M_PI * i / 24), 0, radius * std::sin(M_PI * i / 24));
    points.emplace_back(radius, 0, -hanging);
    scene.guides[0] = guide("wheel", 0.5 * scene.cables[0].length, Vector3::Zero(), GuideDesc::Type::sheave);
    scene.guides[0].radius = radius;
    scene.guides[0].bearing_friction = bearing_friction;
    World world(scene, {});
    double taken = 0;
    for (int i = 0; i < 4000; ++i) {
      run(world, world.time_step());
      const double guides = world.ledger().balance.dissipated.guides;
      EXPECT_GE(guides, taken - 1e-12) << bearing_friction << " at " << world.time() << " s";
      taken = guides;
    }
    EXPECT_GT(taken, 0.1) << bearing_friction;
    EXPECT_NEAR(world.ledger().unaccounted(), 0, 1e-5) << bearing_friction;
  }
}

/// A load that swings round a wheel on what is left of its rope, which comes off and onto the wheel meanwhile.
TEST(Guides, keepTheEnergyOfWhatSwingsRoundAWheel) {
  SceneDesc scene = two_loads(0.2, 0.3);
  scene.materials[0].material.axial_stiffness = 2e4;
  scene.materials[0].material.axial_damping = 2;
  scene.guides = {guide("wheel", 1, {0, 0, -0.05}, GuideDesc::Type::sheave)};
  scene.guides[0].radius = 0.05;
  World world(scene, {});
  run(world, 1.5);
  EXPECT_NEAR(world.ledger().unaccounted(), 0, 1e-4);
}

/// An elastic rope that swings over a wheel: what comes onto it and leaves it is strained.
TEST(Guides, keepTheStretchOfWhatLiesOnAWheel) {
  SceneDesc scene = two_loads(1, 1.5);
  scene.materials[0].material.axial_stiffness = 2e3;
  scene.guides = {guide("wheel", 1, {0, 0, -0.05}, GuideDesc::Type::sheave)};
  scene.guides[0].radius = 0.05;
  scene.numerical_damping = false;
  World world(scene, {});
  const double energy = world.energy().total();
  for (int i = 0; i < 300; ++i) {
    run(world, world.time_step());
    EXPECT_NEAR(world.energy().total(), energy, 5e-5) << i;
  }
}

/// Nodes on a wheel are taken out: the end has another number then.
TEST(Guides, leaveABodyAtTheEndThatItPlaces) {
  SceneDesc scene = two_loads(1, 1);
  scene.cables[0].point_masses.clear();
  scene.cables[0].attachments = {scenes::attachment("top", PlaceDesc::At::start, {-0.5, 0, -0.8}),
                                 scenes::attachment("hook", PlaceDesc::At::end, Vector3::Zero())};
  scene.cables[0].attachments[1].body = "load";
  scene.guides = {guide("wheel", 1, {0, 0, -0.05}, GuideDesc::Type::sheave)};
  scene.guides[0].radius = 0.05;
  BodyDesc& load = scene.bodies.emplace_back();
  load.name = "load";
  load.mass = 1;
  load.inertia = Vector3::Constant(1e-3);
  World world(scene, {});
  const CableState& cable = world.cables()[0].state;
  EXPECT_LT(cable.segments(), 50);
  EXPECT_LT((world.bodies()[0].pose.position - cable.positions.back()).norm(), 1e-12);
  run(world, 0.1);
}

TEST(Guides, thatAShapeWindsAroundMoreThanOnceAreRefused) {
  SceneDesc scene = two_loads(1, 1);
  scene.guides = {guide("wheel", 1, {0, 0, -0.05}, GuideDesc::Type::sheave)};
  scene.guides[0].radius = 0.05;
  std::vector<Vector3>& points = scene.cables[0].initial.points;
  points.clear();
  for (int i = 0; i <= 60; ++i) {
    const double angle = 3 * M_PI * i / 60;
    points.emplace_back(-0.05 * std::cos(angle), 0, 0.05 * std::sin(angle) - 0.05);
  }
  const std::vector<std::string> errors = validate(scene);
  const std::string wound =
      "guides[0]: the initial shape of \"cable\" winds around it 1.5 times; allowed: less than one turn, for now";
  EXPECT_EQ(std::count(errors.begin(), errors.end(), wound), 1);
}

}  // namespace
}  // namespace verlet_cable
