#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "../support/scenes.h"
#include "verlet_cable/core/sensitivity.h"

namespace verlet_cable {
namespace {

using Start = Sensitivity::Start;

struct Kind {
  const char* name;
  AttachmentType attachment;
  double bending_stiffness, bending_damping, axial_stiffness;
  bool held_twice;
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {"chain", AttachmentType::hinge, 0, 0, infinity, true},
      {"hanging", AttachmentType::hinge, 0, 0, infinity, false},
      {"clamped_chain", AttachmentType::clamp, 0, 0, infinity, true},
      {"elastic", AttachmentType::hinge, 0, 0, 500, true},
      {"bent", AttachmentType::hinge, 0.01, 0, infinity, true},
      {"clamped", AttachmentType::clamp, 0.01, 0, infinity, true},
      {"cantilever", AttachmentType::clamp, 0.01, 0, infinity, false},
      {"elastic_clamped", AttachmentType::clamp, 0.01, 0, 500, true},
      {"stiff", AttachmentType::clamp, 1, 0, infinity, false},
      {"stiff_twice", AttachmentType::clamp, 1, 0, infinity, true},
      {"stiff_elastic", AttachmentType::clamp, 1, 0, 2e4, true},
      {"stiff_damped", AttachmentType::clamp, 1, 1e-3, infinity, false},
      {"damped", AttachmentType::hinge, 0.01, 1e-3, infinity, true},
      {"damped_cantilever", AttachmentType::clamp, 0.01, 1e-3, infinity, false},
      {"elastic_damped", AttachmentType::clamp, 0.01, 1e-3, 500, true},
  };
  return all;
}

/// What a scene is made with, all of it a number.
struct Numbers {
  double linear_density = 0.1, drag = 0.02, length = 1;
  double bending_stiffness = 0, bending_damping = 0, axial_stiffness = infinity, axial_damping = 0;
  Vector3 gravity{0.1, 0, -10}, translation = Vector3::Zero(), rotation = Vector3::Zero();
};

/// One of them, by the name of a parameter and its column.
double& number(Numbers& numbers, const std::string& parameter, int column) {
  if (parameter == "linear_density:cable") return numbers.linear_density;
  if (parameter == "drag:cable") return numbers.drag;
  if (parameter == "length:cable") return numbers.length;
  if (parameter == "bending_stiffness:cable") return numbers.bending_stiffness;
  if (parameter == "bending_damping:cable") return numbers.bending_damping;
  if (parameter == "axial_stiffness:cable") return numbers.axial_stiffness;
  if (parameter == "axial_damping:cable") return numbers.axial_damping;
  if (parameter == "gravity") return numbers.gravity[column];
  return column < 3 ? numbers.translation[column] : numbers.rotation[column - 3];
}

std::vector<std::string> parameters_of(const Kind& kind) {
  std::vector<std::string> parameters{"linear_density:cable", "drag:cable", "length:cable", "pose:hand", "gravity"};
  if (kind.bending_stiffness > 0) parameters.push_back("bending_stiffness:cable");
  if (kind.bending_damping > 0) parameters.push_back("bending_damping:cable");
  if (kind.axial_stiffness < infinity) {
    parameters.push_back("axial_stiffness:cable");
    parameters.push_back("axial_damping:cable");
  }
  return parameters;
}

int columns_of(const std::string& parameter) {
  return parameter == "gravity" ? 3 : parameter == "pose:hand" ? 6 : 1;
}

Numbers numbers_of(const Kind& kind) {
  Numbers numbers;
  numbers.bending_stiffness = kind.bending_stiffness;
  numbers.bending_damping = kind.bending_damping;
  numbers.axial_stiffness = kind.axial_stiffness;
  numbers.axial_damping = kind.axial_stiffness < infinity ? 1 : 0;
  return numbers;
}

/// Held by a hand at its start, and at its end where it is held twice; settled.
SceneDesc scene_of(const Kind& kind, const Numbers& numbers, bool cleans) {
  SceneDesc scene = scenes::one_cable(12, numbers.length);
  scene.time_step = 0.002;
  scene.tolerance = 1e-6;
  scene.numerical_damping = cleans;
  scene.gravity.acceleration = numbers.gravity;
  scene.fluid.velocity = {0.5, 2, 0};
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = numbers.linear_density;
  material.drag = numbers.drag;
  material.bending_stiffness = numbers.bending_stiffness;
  material.bending_damping = numbers.bending_damping;
  material.axial_stiffness = numbers.axial_stiffness;
  material.axial_damping = numbers.axial_damping;
  scene.cables[0].attachments = {scenes::attachment("grip", PlaceDesc::At::start, {0.02, 0, 0}, "hand", kind.attachment)};
  if (kind.held_twice)
    scene.cables[0].attachments.push_back(scenes::attachment("base", PlaceDesc::At::end, {0.7, 0.05, 0.1}, "", kind.attachment));
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  return scene;
}

/// Swings to and fro, from rest, displaced by the numbers all the time.
BoundaryInputs hand_at(const Numbers& numbers, double t) {
  const double rise = t * t / (t * t + 0.0025);
  BoundaryInputs inputs(2);
  Pose& pose = inputs[1].pose;
  const Vector3 place(0.05 * rise * std::sin(9 * t), 0.08 * rise * std::sin(14 * t), 0.03 * rise * std::sin(20 * t));
  const Quaternion orientation(Eigen::AngleAxisd(0.4 * rise * std::sin(11 * t), Vector3(0.2, 1, 0.3).normalized()));
  const double angle = numbers.rotation.norm();
  const Quaternion turn(angle > 0 ? Eigen::AngleAxisd(angle, numbers.rotation / angle) : Eigen::AngleAxisd(0, Vector3::UnitX()));
  pose.position = place + numbers.translation;
  pose.orientation = turn * orientation;
  return inputs;
}

struct Outputs {
  std::vector<double> positions, velocities, tension, wrench;
};

Outputs outputs_of(const World& world) {
  Outputs outputs;
  const CableState& state = world.cables()[0].state;
  for (const Vector3& x : state.positions) outputs.positions.insert(outputs.positions.end(), x.data(), x.data() + 3);
  for (const Vector3& v : state.velocities) outputs.velocities.insert(outputs.velocities.end(), v.data(), v.data() + 3);
  outputs.tension = state.tension;
  const Attachment& grip = world.attachments()[find(world.attachments(), "grip")];
  for (const Vector3& v : {grip.force, grip.torque}) outputs.wrench.insert(outputs.wrench.end(), v.data(), v.data() + 3);
  return outputs;
}

Outputs run(const Kind& kind, const Numbers& numbers, int steps, bool cleans) {
  World world(scene_of(kind, numbers, cleans), hand_at(numbers, 0));
  for (int i = 1; i <= steps; ++i) world.step(hand_at(numbers, 0.002 * i));
  return outputs_of(world);
}

using Member = std::vector<double> Outputs::*;
constexpr Member members[] = {&Outputs::positions, &Outputs::velocities, &Outputs::tension, &Outputs::wrench};

/// Of all outputs by one number: central differences, extrapolated twice.
Outputs difference(const Kind& kind, const std::string& parameter, int column, int steps, bool cleans, double size) {
  constexpr int levels = 3;
  std::vector<Outputs> table;
  for (int level = 0; level < levels; ++level) {
    const double change = size / (1 << level);
    Numbers more = numbers_of(kind), less = more;
    number(more, parameter, column) += change;
    number(less, parameter, column) -= change;
    Outputs a = run(kind, more, steps, cleans);
    const Outputs b = run(kind, less, steps, cleans);
    for (const Member member : members)
      for (std::size_t i = 0; i < (a.*member).size(); ++i) (a.*member)[i] = ((a.*member)[i] - (b.*member)[i]) / (2 * change);
    table.push_back(a);
  }
  for (int order = 1; order < levels; ++order)
    for (int level = levels - 1; level >= order; --level) {
      const double factor = 1 << (2 * order);
      for (const Member member : members)
        for (std::size_t i = 0; i < (table[level].*member).size(); ++i)
          (table[level].*member)[i] = (factor * (table[level].*member)[i] - (table[level - 1].*member)[i]) / (factor - 1);
    }
  return table.back();
}

/// Derivatives of an output, one number a row and column.
std::vector<double> read(const Sensitivity& sensitivity, const World& world, Member member) {
  std::vector<double> found((outputs_of(world).*member).size() * sensitivity.columns());
  if (member == &Outputs::positions) sensitivity.read_positions(world, 0, found.data());
  if (member == &Outputs::velocities) sensitivity.read_velocities(world, 0, found.data());
  if (member == &Outputs::tension) sensitivity.read_tension(world, 0, found.data());
  if (member == &Outputs::wrench) sensitivity.read_wrench(world, find(world.attachments(), "grip"), found.data());
  return found;
}

double norm_of(const std::vector<double>& numbers) {
  double square = 0;
  for (const double x : numbers) square += x * x;
  return std::sqrt(square);
}

/// What of a parameter is a change that can be seen.
double typical_change(const std::string& parameter, double value) {
  return parameter == "gravity" ? 0.2 : parameter == "pose:hand" ? 0.02 : 0.05 * value;
}

/// By how much derivatives may differ from differences: of themselves, and, for a typical change, of the output [m, m/s, N, N m]:
/// what the tolerance of the solver leaves of it.
struct Allowed {
  double part = 0, absolute = 0;
};

/// Compares some outputs. `size`: of the differences' steps, in typical changes.
void compare(const Kind& kind, const Sensitivity& sensitivity, const World& world, int steps, bool cleans, double size,
             const std::vector<Member>& of, const Allowed& allowed) {
  const int columns = sensitivity.columns();
  int first = 0;
  for (const std::string& parameter : parameters_of(kind)) {
    for (int column = 0; column < columns_of(parameter); ++column) {
      Numbers numbers = numbers_of(kind);
      const double change = typical_change(parameter, number(numbers, parameter, column));
      const Outputs reference = difference(kind, parameter, column, steps, cleans, size * change);
      for (const Member member : of) {
        const std::vector<double> found = read(sensitivity, world, member);
        std::vector<double> error = reference.*member;
        for (std::size_t row = 0; row < error.size(); ++row) error[row] -= found[row * columns + first + column];
        EXPECT_LT(norm_of(error) * change, allowed.part * norm_of(reference.*member) * change + allowed.absolute)
            << kind.name << ", " << parameter << " " << column << ", " << world.steps() << " steps, output "
            << std::find(std::begin(members), std::end(members), member) - std::begin(members) << " "
            << norm_of(reference.*member);
      }
    }
    first += columns_of(parameter);
  }
}

TEST(Sensitivity, OfAnEquilibriumIsThatOfDifferences) {
  for (const Kind& kind : kinds()) {
    const Numbers numbers = numbers_of(kind);
    const World world(scene_of(kind, numbers, true), hand_at(numbers, 0));
    const Sensitivity sensitivity(world, parameters_of(kind), Start::settled);
    compare(kind, sensitivity, world, 0, true, 0.2, {&Outputs::positions, &Outputs::tension}, {1e-6, 1e-9});
  }
}

/// Steps are solved to a tolerance, which differences of runs contain, and derivatives do not.
TEST(Sensitivity, CarriedAlongIsThatOfDifferences) {
  constexpr int steps = 60;
  for (const Kind& kind : kinds()) {
    const Numbers numbers = numbers_of(kind);
    World world(scene_of(kind, numbers, true), hand_at(numbers, 0));
    Sensitivity sensitivity(world, parameters_of(kind), Start::settled);
    for (int i = 1; i <= steps; ++i) sensitivity.step(world, hand_at(numbers, 0.002 * i));
    ASSERT_EQ("", sensitivity.lost(world, 0)) << kind.name;
    // Damping of bending has kinks, where differences have to be of small steps, and are the less accurate.
    const bool is_damped = kind.bending_damping > 0;
    compare(kind, sensitivity, world, steps, true, 0.02, {&Outputs::positions}, {is_damped ? 5e-6 : 1e-6, 1e-9});
    compare(kind, sensitivity, world, steps, true, 0.1, {&Outputs::velocities, &Outputs::tension, &Outputs::wrench},
            {2e-4, 1e-6});
  }
}

TEST(Sensitivity, IsThatOfDifferencesWithoutNumericalDamping) {
  constexpr int steps = 20;
  const Kind kind{"clamped", AttachmentType::clamp, 0.01, 0, infinity, true};
  const Numbers numbers = numbers_of(kind);
  World world(scene_of(kind, numbers, false), hand_at(numbers, 0));
  Sensitivity sensitivity(world, parameters_of(kind), Start::settled);
  for (int i = 1; i <= steps; ++i) sensitivity.step(world, hand_at(numbers, 0.002 * i));
  compare(kind, sensitivity, world, steps, false, 0.02, {&Outputs::positions}, {1e-6, 1e-9});
}

/// From a state in motion, which is as it is whatever the drag.
TEST(Sensitivity, OfAGivenStateIsThatOfDifferences) {
  const Kind kind{"bent", AttachmentType::hinge, 0.01, 0, infinity, true};
  const Numbers numbers = numbers_of(kind);
  World world(scene_of(kind, numbers, true), hand_at(numbers, 0));
  const auto step = [&](World& stepped, int first, int last, Sensitivity* sensitivity) {
    for (int i = first; i <= last; ++i) {
      const BoundaryInputs inputs = hand_at(numbers, 0.002 * i);
      if (sensitivity != nullptr)
        sensitivity->step(stepped, inputs);
      else
        stepped.step(inputs);
    }
  };
  step(world, 1, 30, nullptr);
  const auto with_drag = [&](double drag) {
    Numbers changed = numbers;
    changed.drag = drag;
    World copy = world;
    copy.tune(scene_of(kind, changed, true));
    step(copy, 31, 60, nullptr);
    return outputs_of(copy).positions;
  };
  const std::vector<double> more = with_drag(1.01 * numbers.drag), less = with_drag(0.99 * numbers.drag);
  Sensitivity sensitivity(world, {"drag:cable"}, Start::given);
  step(world, 31, 60, &sensitivity);
  const std::vector<double> found = read(sensitivity, world, &Outputs::positions);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], (more[i] - less[i]) / (0.02 * numbers.drag), 1e-6) << i;
}

/// The length of a rope that hangs is that of its segments, each strained by what hangs below its middle.
TEST(Sensitivity, OfTheStretchOfAHangingRope) {
  constexpr int n = 10;
  constexpr double stiffness = 200, density = 0.1, g = 9.81;
  SceneDesc scene = scenes::one_cable(n);
  scene.materials[0].material.axial_stiffness = stiffness;
  scene.cables[0].attachments = {scenes::attachment("top", PlaceDesc::At::start, {0, 0, 0})};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  const World world(scene, {});
  const Sensitivity sensitivity(world, {"axial_stiffness:cable", "linear_density:cable"}, Start::settled);
  std::vector<double> found(3 * (n + 1) * 2);
  sensitivity.read_positions(world, 0, found.data());
  // The sum of the weights below the segments, (n - i - 1/2) / n of it, times the length of a segment
  const double stretch = density * g * 0.5 / stiffness;
  EXPECT_NEAR(found[(3 * n + 2) * 2], stretch / stiffness, 1e-9 * stretch / stiffness);
  EXPECT_NEAR(found[(3 * n + 2) * 2 + 1], -stretch / density, 1e-9 * stretch / density);
}

/// What bends little sinks in inverse proportion to its stiffness.
TEST(Sensitivity, OfTheTipOfAStiffCantilever) {
  constexpr int n = 20;
  constexpr double stiffness = 50;
  SceneDesc scene = scenes::one_cable(n);
  scene.materials[0].material.bending_stiffness = stiffness;
  scene.cables[0].attachments = {scenes::attachment("wall", PlaceDesc::At::start, {0, 0, 0}, "", AttachmentType::clamp)};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  const World world(scene, {});
  const Sensitivity sensitivity(world, {"bending_stiffness:cable"}, Start::settled);
  std::vector<double> found(3 * (n + 1));
  sensitivity.read_positions(world, 0, found.data());
  const double tip = world.cables()[0].state.positions.back().z();
  EXPECT_NEAR(found[3 * n + 2], -tip / stiffness, 2e-5 * std::abs(tip / stiffness));  // it turns by 0.003 rad
}

TEST(Sensitivity, LeavesTheWorldAsItIs) {
  const Kind& kind = kinds()[5];
  const Numbers numbers = numbers_of(kind);
  World world(scene_of(kind, numbers, true), hand_at(numbers, 0)), alone = world;
  Sensitivity sensitivity(world, {"drag:cable"}, Start::settled);
  for (int i = 1; i <= 20; ++i) {
    sensitivity.step(world, hand_at(numbers, 0.002 * i));
    alone.step(hand_at(numbers, 0.002 * i));
  }
  EXPECT_EQ(alone.hash(), world.hash());
}

std::string refusal(const World& world, const std::vector<std::string>& parameters, Start start = Start::settled) {
  try {
    const Sensitivity sensitivity(world, parameters, start);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(Sensitivity, RefusesWhatItDoesNotKnow) {
  const Kind chain{"chain", AttachmentType::hinge, 0, 0, infinity, true};
  const Numbers numbers = numbers_of(chain);
  SceneDesc scene = scene_of(chain, numbers, true);
  const World world(scene, hand_at(numbers, 0));
  EXPECT_EQ(
      "parameters: \"drag:rope\"; allowed: cables: cable\n"
      "parameters: \"pose:arm\"; allowed: frames: hand\n"
      "parameters: \"axial_stiffness:cable\"; allowed: where it is finite; it is .inf\n"
      "parameters: \"bending_stiffness:cable\"; allowed: where it is above 0; it is 0",
      refusal(world, {"drag:rope", "pose:arm", "axial_stiffness:cable", "bending_stiffness:cable"}));
  EXPECT_NE("", refusal(world, {"drag"}));
  EXPECT_NE("", refusal(world, {}));
  EXPECT_NE("", refusal(world, {"length:cable"}, Start::given));
  EXPECT_EQ("", refusal(world, {"drag:cable"}, Start::given));
  World moving = world;
  moving.step(hand_at(numbers, 0.05));
  EXPECT_NE("", refusal(moving, {"drag:cable"}));
  scene.materials[0].material.bending_stiffness = {0.01, 0.02};
  scene.materials[0].material.torsional_stiffness = 0.014;
  EXPECT_NE(std::string::npos, refusal(World(scene, hand_at(numbers, 0)), {"drag:cable"}).find("whole rod"));
}

TEST(Sensitivity, EndsWhereACableIsTouched) {
  const Kind kind{"hanging", AttachmentType::hinge, 0, 0, infinity, false};
  const Numbers numbers = numbers_of(kind);
  SceneDesc scene = scene_of(kind, numbers, true);
  ObstacleDesc wall;
  wall.name = "wall";
  wall.type = ShapeType::plane;
  wall.pose = {0, 0, -1.02, 0, 0, 0};
  scene.obstacles.push_back(wall);
  World world(scene, hand_at(numbers, 0));
  Sensitivity sensitivity(world, {"drag:cable"}, Start::settled);
  BoundaryInputs inputs = hand_at(numbers, 0);
  for (int i = 0; i < 100 && sensitivity.lost(world, 0).empty(); ++i) {
    inputs[1].pose.position.z() -= 0.002;
    sensitivity.step(world, inputs);
  }
  EXPECT_NE(std::string::npos, sensitivity.lost(world, 0).find("it touches something")) << sensitivity.lost(world, 0);
}

TEST(Sensitivity, EndsWithAnEdit) {
  const Kind& kind = kinds()[0];
  const Numbers numbers = numbers_of(kind);
  World world(scene_of(kind, numbers, true), hand_at(numbers, 0));
  Sensitivity sensitivity(world, {"drag:cable"}, Start::settled);
  sensitivity.step(world, hand_at(numbers, 0.002));
  EXPECT_EQ("", sensitivity.lost(world, 0));
  ASSERT_TRUE(world.apply(edit::Unpin{"base"}).ok);
  EXPECT_NE("", sensitivity.lost(world, 0));
  sensitivity.step(world, hand_at(numbers, 0.004));
  EXPECT_NE("", sensitivity.lost(world, 0));
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), 5}).ok);
  EXPECT_NE("", sensitivity.lost(world, 1));
}

}  // namespace
}  // namespace verlet_cable
