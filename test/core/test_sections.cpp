#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "../support/scenes.h"
#include "rod/joint_material.h"
#include "verlet_cable/core/cable_materials.h"

// Cables of several materials: what edits, tuning and limits make of them. Their physics is validated against closed forms.

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

MaterialDesc& add_material(SceneDesc& scene, const std::string& name) {
  scene.materials.push_back({name, scene.materials[0].material});
  return scene.materials.back().material;
}

/// 1 m that hangs from a hand, of "rope" and from 0.5 m on of "wire", which weighs three times as much.
SceneDesc rope_and_wire(int segments = 40) {
  SceneDesc scene = scenes::one_cable(segments);
  scene.materials[0].material.bending_stiffness = 0.002;
  scene.materials[0].material.bending_damping = 1e-4;
  scene.materials[0].material.torsional_stiffness = 0.001;
  MaterialDesc& wire = add_material(scene, "wire");
  wire.linear_density = 0.3;
  wire.radius = 0.002;
  wire.bending_stiffness = 0.02;
  scene.cables[0].sections = {{0.5, 1, "wire"}};
  scene.cables[0].attachments = {scenes::attachment("hold", PlaceDesc::At::start, {0, 0, 0}, "hand")};
  scene.cables[0].attachments[0].initial_pose = InitialPose{};
  return scene;
}

/// One letter a segment, the first of its material's name.
std::string letters(const SimulatedCable& cable) {
  const CableMaterials materials(cable);
  std::string text;
  for (int i = 0; i < cable.state.segments(); ++i) text += materials.name(i)[0];
  return text;
}

std::string letters(int ropes, int wires) {
  return std::string(ropes, 'r') + std::string(wires, 'w');
}

double mass(const SimulatedCable& cable) {
  return std::accumulate(cable.state.masses.begin(), cable.state.masses.end(), 0.0);
}

/// What its segments weigh.
double weight_of_segments(const SimulatedCable& cable) {
  const CableMaterials materials(cable);
  double sum = 0;
  for (int i = 0; i < cable.state.segments(); ++i) sum += materials[i].linear_density * cable.state.rest_lengths[i];
  return sum;
}

void run(World& world, const BoundaryInputs& inputs, int steps) {
  for (int i = 0; i < steps; ++i) ASSERT_EQ(world.step(inputs).status, Status::ok) << "step " << i;
}

double largest_difference(const World& a, const World& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.cables()[0].state.positions.size(); ++i)
    largest = std::max(largest, (a.cables()[0].state.positions[i] - b.cables()[0].state.positions[i]).norm());
  return largest;
}

/// Swings from a hand that moves.
World after_a_swing(const SceneDesc& scene) {
  BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  for (int i = 1; i <= 200; ++i) {
    inputs[1].pose.position = {0.1 * std::sin(0.01 * i), 0.1 * std::sin(0.013 * i), 0};
    inputs[1].pose.orientation = Eigen::AngleAxisd(0.3 * std::sin(0.01 * i), Vector3(1, 1, 0).normalized());
    EXPECT_EQ(world.step(inputs).status, Status::ok);
  }
  return world;
}

struct Kind {
  const char* name;
  std::function<void(MaterialDesc&)> change;
};

class SameMaterial : public testing::TestWithParam<Kind> {};

TEST_P(SameMaterial, IsNoSection) {
  SceneDesc plain = rope_and_wire();
  GetParam().change(plain.materials[0].material);
  plain.cables[0].sections.clear();
  plain.cables[0].attachments[0].type = AttachmentType::clamp;
  plain.fluid.density = 100;
  SceneDesc named = plain, other = plain;
  named.cables[0].sections = {{0.2, 0.4, "rope"}, {0.4, 0.8, "rope"}};
  // The same numbers by another name.
  add_material(other, "other");
  other.cables[0].sections = {{0.2, 0.4, "other"}, {0.7, 1, "other"}};
  const World expected = after_a_swing(plain), same = after_a_swing(named), alike = after_a_swing(other);
  EXPECT_TRUE(same.cables()[0].state.section_material.empty());
  EXPECT_EQ(largest_difference(expected, same), 0);
  EXPECT_FALSE(alike.cables()[0].state.section_material.empty());
  EXPECT_LT(largest_difference(expected, alike), 1e-12);
  EXPECT_NEAR(alike.energy().total(), expected.energy().total(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, SameMaterial,
    testing::Values(Kind{"rigid", [](MaterialDesc&) {}}, Kind{"elastic", [](MaterialDesc& m) { m.axial_stiffness = 1000; }},
                    Kind{"ribbon",
                         [](MaterialDesc& m) {
                           m.bending_stiffness = {0.002, 0.01};
                         }},
                    Kind{"limp", [](MaterialDesc& m) { m.bending_stiffness = m.bending_damping = m.torsional_stiffness = 0; }}),
    [](const auto& info) { return info.param.name; });

TEST(Sections, OneAllAlongIsTheCablesMaterial) {
  SceneDesc plain = rope_and_wire(), section = rope_and_wire();
  plain.cables[0].sections.clear();
  plain.cables[0].material = "wire";
  section.cables[0].sections = {{0, 1, "wire"}};
  const World expected = after_a_swing(plain), world = after_a_swing(section);
  EXPECT_EQ(largest_difference(expected, world), 0);
  EXPECT_EQ(world.cables()[0].model->material_name, "wire");
}

TEST(Sections, AreSegmentsByTheirMiddle) {
  SceneDesc scene = rope_and_wire(10);
  scene.cables[0].sections = {{0.25, 0.349, "wire"}, {0.751, 0.851, "wire"}};
  const World world(scene, initial_frames(scene));
  EXPECT_EQ(letters(world.cables()[0]), "rrwrrrrrwr");
  EXPECT_NEAR(mass(world.cables()[0]), weight_of_segments(world.cables()[0]), 1e-15);
  EXPECT_NEAR(mass(world.cables()[0]), 0.1 * 0.8 + 0.3 * 0.2, 1e-15);
}

/// Two halves in series: compliances add, and what their dampers take under one moment.
TEST(Sections, JointsAreHalvesInSeries) {
  SceneDesc scene = rope_and_wire(2);
  MaterialDesc &rope = scene.materials[0].material, &wire = scene.materials[1].material;
  rope.bending_damping = 0.004;
  wire.bending_damping = 0.01;
  const auto joint = [&] {
    const World world(scene, initial_frames(scene));
    return joint_material(CableMaterials(world.cables()[0]), world.cables()[0].state, 1);
  };
  // One moment bends them by shares 10/11 and 1/11.
  EXPECT_NEAR(joint().bending_stiffness.front(), 2 / (1 / 0.002 + 1 / 0.02), 1e-15);
  EXPECT_NEAR(joint().bending_damping, 2 * (0.004 * 100 + 0.01) / 121, 1e-15);
  wire.bending_stiffness = 0;
  EXPECT_EQ(joint().bending_stiffness.front(), 0);
  EXPECT_NEAR(joint().bending_damping, 2 * 0.01, 1e-15);
  rope.bending_stiffness = 0;
  EXPECT_NEAR(joint().bending_damping, 2 / (1 / 0.004 + 1 / 0.01), 1e-15);
  wire.bending_damping = 0;
  EXPECT_EQ(joint().bending_damping, 0);
}

TEST(Sections, FreeRodsOfTwoMaterialsKeepEnergyAndMomenta) {
  for (const bool ribbon : {false, true}) {
    SceneDesc scene = rope_and_wire(20);
    scene.time_step = 5e-4;
    scene.numerical_damping = false;
    scene.gravity.acceleration.setZero();
    for (NamedMaterial& named : scene.materials) named.material.bending_damping = 0;
    scene.materials[0].material.axial_stiffness = 200;
    if (ribbon) scene.materials[1].material.bending_stiffness = {0.02, 0.01};
    scene.cables[0].attachments.clear();
    scene.cables[0].initial.type = InitialShapeDesc::Type::points;
    for (int i = 0; i <= 20; ++i) {
      const double s = 0.05 * i;
      scene.cables[0].initial.points.push_back({s, 0, 0});
      scene.cables[0].initial.velocities.push_back({0, std::cos(M_PI * s), 0.5 * s * s});
    }
    World world(scene, initial_frames(scene));
    const auto momenta = [&] {
      const CableState& state = world.cables()[0].state;
      std::array<Vector3, 2> sums{Vector3::Zero(), Vector3::Zero()};
      for (int i = 0; i < state.nodes(); ++i) {
        sums[0] += state.masses[i] * state.velocities[i];
        sums[1] += state.masses[i] * state.positions[i].cross(state.velocities[i]);
      }
      return sums;
    };
    const double energy = world.energy().total();
    const auto before = momenta();
    run(world, initial_frames(scene), 2000);
    EXPECT_NEAR(world.energy().total(), energy, 1e-6 * energy) << ribbon;
    EXPECT_LT((momenta()[0] - before[0]).norm(), 1e-9) << ribbon;
    // A ribbon's spin is a part of it.
    EXPECT_LT((momenta()[1] - before[1]).norm(), ribbon ? 1e-3 : 1e-8) << ribbon;
    EXPECT_GT(world.energy().bend, 1e-3 * energy) << ribbon;
  }
}

TEST(Sections, PiecesOfACutKeepTheirMaterials) {
  const SceneDesc scene = rope_and_wire();
  World world(scene, initial_frames(scene));
  run(world, initial_frames(scene), 10);
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), 29}).ok);
  EXPECT_EQ(letters(world.cables()[0]), letters(20, 9));
  EXPECT_EQ(letters(world.cables()[1]), letters(0, 10));
  run(world, initial_frames(scene), 100);
  // And back, from either side.
  for (const bool turned : {false, true}) {
    World joined = world;
    ASSERT_TRUE(joined.apply(turned ? edit::Join{1, false, 0, true} : edit::Join{0, true, 1, false}).ok);
    run(joined, initial_frames(scene), 500);
    EXPECT_EQ(letters(joined.cables()[0]), letters(20, 19));
    EXPECT_NEAR(mass(joined.cables()[0]), mass(world.cables()[0]) + mass(world.cables()[1]), 1e-12);
  }
}

TEST(Sections, OfJoinedCablesComeAlong) {
  for (const bool first_at_end : {false, true})
    for (const bool second_at_end : {false, true}) {
      SceneDesc scene = rope_and_wire(10);
      add_material(scene, "tube").linear_density = 0.2;
      scene.cables.push_back(scene.cables[0]);
      scene.cables[1].name = "other";
      scene.cables[1].attachments.clear();
      scene.cables[1].initial.type = InitialShapeDesc::Type::straight;
      scene.cables[1].initial.from = {0.1, 0, 0};
      scene.cables[1].initial.to = {0.1, 0, -1};
      scene.cables[0].sections = {{0.7, 1, "wire"}};
      scene.cables[1].sections = {{0.8, 1, "tube"}, {0, 0.1, "wire"}};
      World world(scene, initial_frames(scene));
      const double both = mass(world.cables()[0]) + mass(world.cables()[1]);
      std::string first = letters(world.cables()[0]), second = letters(world.cables()[1]);
      ASSERT_EQ(first + second, "rrrrrrrwwwwrrrrrrrtt");
      ASSERT_TRUE(world.apply(edit::Join{0, first_at_end, 1, second_at_end}).ok);
      run(world, initial_frames(scene), 1000);
      if (first_at_end == second_at_end) std::reverse(second.begin(), second.end());
      EXPECT_EQ(letters(world.cables()[0]), first_at_end ? first + second : second + first);
      EXPECT_NEAR(mass(world.cables()[0]), both, 1e-12);
    }
}

/// A winch pays out what its end is of, and weighs no more or less than its segments, whatever goes in and out.
TEST(Sections, WinchesPayOutWhatTheirEndIsOf) {
  for (const bool at_end : {false, true}) {
    SceneDesc scene = rope_and_wire();
    scene.cables[0].attachments[0].place.at = at_end ? PlaceDesc::At::end : PlaceDesc::At::start;
    World world(scene, initial_frames(scene));
    const auto wind = [&](double length) {
      ASSERT_TRUE(world.apply(edit::SetLength{0, at_end, length, 1}).ok);
      for (int i = 0; i < 3000; ++i) {
        ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok);
        ASSERT_NEAR(mass(world.cables()[0]), weight_of_segments(world.cables()[0]), 1e-12) << i;
      }
      EXPECT_NEAR(world.cables()[0].state.length(), length, 1e-6);
    };
    wind(1.5);
    EXPECT_EQ(letters(world.cables()[0]), at_end ? letters(20, 40) : letters(40, 20));
    // Beyond where one material ends.
    wind(0.3);
    EXPECT_EQ(letters(world.cables()[0]), at_end ? letters(12, 0) : letters(0, 12));
    wind(1.0);
    EXPECT_EQ(letters(world.cables()[0]), at_end ? letters(40, 0) : letters(0, 40));
  }
}

TEST(Sections, AreTunedByTheirMaterial) {
  SceneDesc scene = rope_and_wire();
  scene.cables[0].sections = {{0, 0.5, "wire"}};
  scene.cables[0].attachments[0].type = AttachmentType::clamp;
  const auto tip = [&](double stiffness, bool tunes) {
    SceneDesc other = scene;
    other.materials[1].material.bending_stiffness = stiffness;
    World world(tunes ? scene : other, initial_frames(scene));
    if (tunes) world.tune(other);
    EXPECT_TRUE(world.settle());
    return world.cables()[0].state.positions.back();
  };
  EXPECT_GT((tip(0.2, false) - tip(0.02, false)).norm(), 1e-3);
  EXPECT_LT((tip(0.2, true) - tip(0.2, false)).norm(), 1e-6);
}

TEST(Sections, BreakWhereTheyAreWeak) {
  SceneDesc scene = rope_and_wire();
  scene.materials[1].material.breaking_tension = 1;
  scene.cables[0].point_masses = {scenes::payload(1)};
  World world(scene, initial_frames(scene));
  world.step(initial_frames(scene));
  ASSERT_EQ(world.findings().breaks.size(), 1u);
  EXPECT_EQ(world.findings().breaks[0].segment, 20);
  EXPECT_EQ(world.findings().breaks[0].limit, 1);
}

TEST(Sections, CopiesGoOnAlike) {
  SceneDesc scene = rope_and_wire();
  scene.materials[0].material.maximum_tension = 1;
  World world(scene, initial_frames(scene));
  run(world, initial_frames(scene), 20);
  World copy = world;
  run(world, initial_frames(scene), 20);
  run(copy, initial_frames(scene), 20);
  EXPECT_EQ(world.hash(), copy.hash());
}

/// Crossing cables of sections rest as far apart as the sections that touch are thick.
TEST(Sections, TouchEachOtherAtTheirOwnRadii) {
  SceneDesc scene = scenes::between_two_points(40, 0.999);
  scene.contact = ContactDesc{};
  scene.materials[0].material.axial_stiffness = 1000;
  scene.materials[0].material.drag = 1;
  add_material(scene, "sleeve").radius = 0.02;
  scene.cables[0].sections = {{0.4, 0.6, "sleeve"}};
  CableDesc& over = scene.cables.emplace_back(scene.cables[0]);
  over.name = "over";
  over.sections.clear();
  for (const int k : {0, 1}) {
    over.attachments[k].name += "_over";
    over.attachments[k].offset = {0.5, k == 0 ? -0.5 : 0.5, 0.02};
  }
  over.initial.type = InitialShapeDesc::Type::straight;
  over.initial.from = {0.5, -0.5, 0.05};
  over.initial.to = {0.5, 0.5, 0.05};
  World world(scene, initial_frames(scene));
  run(world, initial_frames(scene), 3000);
  const double apart = world.cables()[1].state.positions[20].z() - world.cables()[0].state.positions[20].z();
  EXPECT_NEAR(apart, 0.025, 0.0005);
}

/// Immersed as a whole, each part loses the weight of the fluid in its place, and drags with its own coefficient.
TEST(Sections, FloatAndDragWithTheirOwnRadii) {
  SceneDesc scene = rope_and_wire();
  scene.fluid.density = 500;
  scene.fluid.velocity = {0.01, 0, 0};
  scene.fluid.normal_drag = scene.fluid.tangential_drag = 0;
  scene.materials[0].material.drag = 0.2;
  scene.materials[1].material.drag = 0.7;
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  World world(scene, initial_frames(scene));
  run(world, initial_frames(scene), 5000);
  const Vector3 force = world.attachments()[0].force;
  const double displaced = 500 * M_PI * 0.5 * (0.005 * 0.005 + 0.002 * 0.002);
  EXPECT_NEAR(force.z(), -9.81 * (0.5 * (0.1 + 0.3) - displaced), 1e-6);
  EXPECT_NEAR(force.x(), 0.01 * 0.5 * (0.2 + 0.7), 1e-6);
}

/// Any edits, one after the other: nothing is counted wrongly.
TEST(Sections, SurviveAnyEdits) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SceneDesc scene = rope_and_wire(20);
    scene.materials[0].material.maximum_tension = 0.5;
    scene.materials[1].material.axial_stiffness = seed % 2 == 0 ? 500 : infinity;
    if (seed % 3 == 0) scene.materials[1].material.bending_stiffness = {0.02, 0.005};
    scene.cables[0].sections = {{0.1, 0.3, "wire"}, {0.6, 0.75, "wire"}};
    World world(scene, initial_frames(scene));
    unsigned random = seed;
    const auto any = [&](int count) {
      random = random * 1664525u + 1013904223u;
      return static_cast<int>((random >> 16) % static_cast<unsigned>(count));
    };
    for (int round = 0; round < 12; ++round) {
      const int cables = static_cast<int>(world.cables().size()), cable = any(cables);
      const CableState& state = world.cables()[cable].state;
      switch (any(4)) {
        case 0:
          world.apply(edit::Cut{cable_id(cable), any(state.segments())});
          break;
        case 1:
          world.apply(edit::Join{cable, any(2) == 0, any(cables), any(2) == 0});
          break;
        case 2:
          world.apply(edit::SetLength{cable, any(2) == 0, state.length() * (0.6 + 0.1 * any(8)), 1});
          break;
        default:
          world.settle();
      }
      for (int i = 0; i < 60; ++i) ASSERT_NE(world.step(initial_frames(scene)).status, Status::fault) << seed;
      for (const SimulatedCable& piece : world.cables()) {
        const std::size_t n = piece.state.rest_lengths.size();
        ASSERT_TRUE(piece.state.section_material.empty() || piece.state.section_material.size() == n) << seed;
        ASSERT_TRUE(piece.state.beyond_limits.empty() || piece.state.beyond_limits.size() == n + 1) << seed;
        for (const int material : piece.state.section_material) {
          ASSERT_GE(material, 0);
          ASSERT_LE(material, static_cast<int>(piece.model->section_materials.size()));
        }
        for (const double m : piece.state.masses) ASSERT_GT(m, 0) << seed;
        for (const Vector3& x : piece.state.positions) ASSERT_TRUE(x.allFinite()) << seed;
      }
    }
  }
}

TEST(Limits, AreToldOnceAnExcursion) {
  SceneDesc scene = rope_and_wire();
  scene.materials[1].material.maximum_tension = 2;
  scene.cables[0].point_masses = {scenes::payload(0.1)};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  // 0.15 kg of wire and 0.1 kg: 2.45 N at its upper end.
  std::vector<Excursion> told;
  const auto observe = [&](int steps, double acceleration) {
    for (int i = 0; i < steps; ++i) {
      SceneDesc other = scene;
      other.gravity.acceleration = {0, 0, -acceleration};
      world.tune(other);
      ASSERT_EQ(world.step(inputs).status, Status::ok);
      told.insert(told.end(), world.findings().excursions.begin(), world.findings().excursions.end());
    }
  };
  observe(300, 9.81);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].cable, 0);
  EXPECT_EQ(told[0].node, 20);
  EXPECT_EQ(told[0].kind, Excursion::Kind::tension);
  EXPECT_NEAR(told[0].value, 2.45, 0.06);
  EXPECT_EQ(told[0].allowed, 2);
  observe(50, 5);
  observe(50, 9.81);
  EXPECT_EQ(told.size(), 1u) << "shorter than a tenth of a second";
  observe(300, 5);
  EXPECT_EQ(told.size(), 1u);
  observe(300, 9.81);
  EXPECT_EQ(told.size(), 2u);
}

/// A cable that clamps push together bends most beside them, and the rope more than the wire.
TEST(Limits, BendsCountAtClampsAndOnTheSideThatBends) {
  SceneDesc scene = rope_and_wire(20);
  scene.gravity.acceleration.setZero();
  scene.cables[0].attachments = {scenes::attachment("start", PlaceDesc::At::start, {0, 0, 0}, "", AttachmentType::clamp),
                                 scenes::attachment("end", PlaceDesc::At::end, {0, 0, 0}, "hand", AttachmentType::clamp)};
  scene.cables[0].attachments[1].initial_pose = InitialPose{0.9, 0, 0, 0, 0, 0};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  const BoundaryInputs inputs = initial_frames(scene);
  const auto told = [&](double of_rope, double of_wire) {
    scene.materials[0].material.minimum_bend_radius = of_rope;
    scene.materials[1].material.minimum_bend_radius = of_wire;
    World world(scene, inputs);
    world.step(inputs);
    std::vector<int> nodes;
    for (const Excursion& excursion : world.findings().excursions) {
      EXPECT_EQ(excursion.kind, Excursion::Kind::bend);
      EXPECT_LT(excursion.value, excursion.allowed);
      nodes.push_back(excursion.node);
    }
    return nodes;
  };
  World world(scene, inputs);
  std::vector<JointView> joints;
  world.view_joints(0, joints);
  const double at_clamp = 1 / joints.front().curvature;
  EXPECT_EQ(told(1.001 * at_clamp, 0).front(), 0);
  const auto first = told(0.999 * at_clamp, 0);
  EXPECT_TRUE(first.empty() || first.front() > 0);
  // The wire's tightest bend is at its clamp, too.
  const double of_wire = 1 / joints.back().curvature;
  EXPECT_EQ(told(0, 1.001 * of_wire).back(), 20);
  EXPECT_TRUE(told(0, 0.999 * of_wire).empty());
  // Ten parts of eleven of the bend at the node between them are in the rope's half.
  const std::array<double, 2> sides = curvature_beside(CableMaterials(world.cables()[0]), world.cables()[0].state, 10, 0.11);
  EXPECT_NEAR(sides[0], 0.10 / 0.025, 1e-12);
  EXPECT_NEAR(sides[1], 0.01 / 0.025, 1e-12);
}

}  // namespace
}  // namespace verlet_cable
