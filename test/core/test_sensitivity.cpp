#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
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
  Vector3 gravity{0, 0, -9.81}, translation = Vector3::Zero(), rotation = Vector3::Zero();
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
    scene.cables[0].attachments.push_back(
        scenes::attachment("base", PlaceDesc::At::end, {0.7, 0.05, 0.1}, "", kind.attachment));
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

/// Of an output by one number: central differences, extrapolated twice.
std::vector<double> difference(const Kind& kind, const std::string& parameter, int column, int steps, bool cleans, double size,
                               Member output) {
  std::vector<std::vector<double>> table;
  for (int level = 0; level < 3; ++level) {
    const double change = size / (1 << level);
    Numbers more = numbers_of(kind), less = more;
    number(more, parameter, column) += change;
    number(less, parameter, column) -= change;
    std::vector<double> a = run(kind, more, steps, cleans).*output, b = run(kind, less, steps, cleans).*output;
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = (a[i] - b[i]) / (2 * change);
    table.push_back(a);
  }
  for (int order = 1; order < 3; ++order)
    for (int level = 2; level >= order; --level) {
      const double factor = 1 << (2 * order);
      for (std::size_t i = 0; i < table[0].size(); ++i)
        table[level][i] = (factor * table[level][i] - table[level - 1][i]) / (factor - 1);
    }
  return table[2];
}

double norm_of(const std::vector<double>& numbers) {
  double square = 0;
  for (const double x : numbers) square += x * x;
  return std::sqrt(square);
}

/// The largest error of any column, relative to the column.
double error_of(const Kind& kind, const std::vector<double>& found, int columns, int steps, bool cleans, Member output) {
  double largest = 0;
  int first = 0;
  const Numbers numbers = numbers_of(kind);
  for (const std::string& parameter : parameters_of(kind)) {
    for (int column = 0; column < columns_of(parameter); ++column) {
      Numbers copy = numbers;
      const double value = number(copy, parameter, column);
      const double size = parameter == "gravity" || parameter == "pose:hand" ? (parameter == "gravity" ? 0.1 : 0.01) : 0.01 * value;
      const std::vector<double> reference = difference(kind, parameter, column, steps, cleans, size, output);
      std::vector<double> error;
      for (std::size_t row = 0; row < reference.size(); ++row) error.push_back(found[row * columns + first + column] - reference[row]);
      const double scale = norm_of(reference);
      const double relative = norm_of(error) / std::max(scale, 1e-6);
      if (std::getenv("SHOW")) printf("%s %s[%d]: %.2e of %.3g\n", kind.name, parameter.c_str(), column, relative, scale);
      if (!(relative <= largest)) largest = relative;
    }
    first += columns_of(parameter);
  }
  return largest;
}

TEST(Sensitivity, OfEquilibriumIsThatOfDifferences) {
  for (const Kind& kind : kinds()) {
    const Numbers numbers = numbers_of(kind);
    World world(scene_of(kind, numbers, true), hand_at(numbers, 0));
    const Sensitivity sensitivity(world, parameters_of(kind), Start::settled);
    std::vector<double> found(3 * world.cables()[0].state.positions.size() * sensitivity.columns());
    sensitivity.read_positions(world, 0, found.data());
    EXPECT_LT(error_of(kind, found, sensitivity.columns(), 0, true, &Outputs::positions), 1e-6) << kind.name;
  }
}

TEST(Sensitivity, CarriedAlongIsThatOfDifferences) {
  for (const bool cleans : {false, true})
    for (const Kind& kind : kinds()) {
      const int steps = std::getenv("STEPS") ? atoi(std::getenv("STEPS")) : 100;
      const Numbers numbers = numbers_of(kind);
      World world(scene_of(kind, numbers, cleans), hand_at(numbers, 0));
      Sensitivity sensitivity(world, parameters_of(kind), Start::settled);
      for (int i = 1; i <= steps; ++i) sensitivity.step(world, hand_at(numbers, 0.002 * i));
      ASSERT_EQ("", sensitivity.lost(0)) << kind.name;
      const int columns = sensitivity.columns();
      std::vector<double> found(3 * world.cables()[0].state.positions.size() * columns);
      sensitivity.read_positions(world, 0, found.data());
      EXPECT_LT(error_of(kind, found, columns, steps, cleans, &Outputs::positions), 1e-6) << kind.name << cleans;
      if (std::getenv("FEW")) continue;
      sensitivity.read_velocities(world, 0, found.data());
      EXPECT_LT(error_of(kind, found, columns, steps, cleans, &Outputs::velocities), 1e-6) << kind.name << cleans;
      sensitivity.read_tension(world, 0, found.data());
      EXPECT_LT(error_of(kind, found, columns, steps, cleans, &Outputs::tension), 1e-6) << kind.name << cleans;
      sensitivity.read_wrench(world, find(world.attachments(), "grip"), found.data());
      EXPECT_LT(error_of(kind, found, columns, steps, cleans, &Outputs::wrench), 1e-6) << kind.name << cleans;
    }
}

}  // namespace
}  // namespace verlet_cable
