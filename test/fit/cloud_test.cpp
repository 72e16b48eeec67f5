#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cable_fit/cloud_fit.h"
#include "cable_fit_fixture.h"
#include "scene/frame_source.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/world.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr double pi = 3.141592653589793;
constexpr double bending_stiffness = 0.004, bending_damping = 1.5e-4, drag = 0.02, length = 1.0, radius = 0.006;

std::string filmed_scene(const std::string& material, double cable_length, int segments, double time_step) {
  return "time_step: " + number_text(time_step) + "\nmaterials: {m: {linear_density: 0.08, radius: 0.006, " + material +
         "}}\ncables:\n  - {name: c, length: " + number_text(cable_length) + ", segments: " + std::to_string(segments) +
         ", material: m, attachments: [\n"
         "      {name: a, at: start, frame: left, type: clamp, initial_pose: [0, 0, 1, 0, 0, 0]},\n"
         "      {name: b, at: end, frame: right, type: clamp, initial_pose: [0.7, 0, 1, 0, 0, 0]}]}\n";
}

const std::string true_material = "bending_stiffness: 0.004, bending_damping: 1.5e-4, drag: 0.02";
const std::string wrong_material = "bending_stiffness: 0.001, bending_damping: 1.0e-5, drag: 0.1";

/// Hands that begin at rest, and then shake.
Motion shaking_hands() {
  Motion motion;
  for (int row = 0; row <= 300; ++row) {
    const double time = 0.01 * row, begun = std::min(time / 0.5, 1.0), amount = 0.1 * begun * begun * (3 - 2 * begun);
    motion["left"].add(time, {{0, amount * std::sin(2 * pi * 0.8 * time), 1}, Quaternion::Identity()});
    motion["right"].add(time,
                        {{0.7 - amount * begun, 0, 1 + 0.5 * amount * std::sin(2 * pi * 0.6 * time)}, Quaternion::Identity()});
  }
  return motion;
}

/// What a camera that looks along y sees of a cable with fine segments, the left half of which is hidden; its depth has noise
/// [m].
Clouds filmed(const Motion& motion, double noise, int seed, double time_step = 0.001) {
  SceneDesc scene = read_scene_text(filmed_scene(true_material, length, 120, time_step));
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  const FrameSource frames(scene, motion);
  World world(scene, frames.at(0));
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1, 1);
  Clouds clouds;
  for (int cloud = 0; cloud <= 40; ++cloud) {
    while (world.time() < 0.07 * cloud - 1e-9) world.step(frames.at(world.time() + time_step));
    clouds.times.push_back(world.time());
    std::vector<Vector3>& points = clouds.points.emplace_back();
    const std::vector<Vector3>& nodes = world.cables()[0].state.positions;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const Vector3 middle = 0.5 * (nodes[i] + nodes[i + 1]), along = (nodes[i + 1] - nodes[i]).normalized();
      if (middle.x() < 0.35) continue;
      const Vector3 up = along.cross(Vector3::UnitY()).normalized(), towards = up.cross(along);
      for (int k = 0; k < 4; ++k) {
        const double across = 0.95 * uniform(random);
        const Vector3 on_surface =
            middle + radius * (across * up - std::sqrt(1 - across * across) * (towards.y() > 0 ? 1 : -1) * towards);
        points.push_back(on_surface + noise * normal(random) * Vector3::UnitY());
      }
    }
  }
  return clouds;
}

CloudProblem problem_of(const Motion& motion, const Clouds& clouds) {
  return {read_scene_text(filmed_scene(wrong_material, 1.04, 30, 0.004)), 0, motion, clouds, [] {}};
}

double found(const CloudFit& fit, std::size_t parameter) {
  return scene_value(fit.parameters[parameter], fit.values[parameter]);
}

TEST(Clouds, ofAMovedCableHalfOfWhichIsHiddenTellItsStiffnessAndLength) {
  const Motion motion = shaking_hands();
  const CloudFit fit = fit_clouds(problem_of(motion, filmed(motion, 0.003, 1)));
  ASSERT_EQ(fit.parameters.size(), 4u);
  EXPECT_EQ(fit.parameters[0].key, "materials.m.bending_stiffness");
  EXPECT_EQ(fit.parameters[3].key, "cables[0].length");
  EXPECT_NEAR(found(fit, 0) / bending_stiffness, 1, 0.05);
  EXPECT_NEAR(found(fit, 1) / bending_damping, 1, 0.1);
  EXPECT_NEAR(found(fit, 2) / drag, 1, 0.15);
  EXPECT_NEAR(found(fit, 3) / length, 1, 0.003);
  for (const Confidence& confidence : fit.confidence) EXPECT_TRUE(confidence.told);
  EXPECT_LT(std::abs(fit.values[0] - std::log10(bending_stiffness)), fit.confidence[0].half_width);
  EXPECT_LT(std::abs(fit.values[3] - length), fit.confidence[3].half_width);
  EXPECT_LT(fit.mean_distance, 0.0026);
  EXPECT_EQ(fit.scene.cables[0].length, fit.values[3]);
}

TEST(Clouds, withoutNoiseTellTheMaterialToAPercent) {
  const Motion motion = shaking_hands();
  const CloudFit fit = fit_clouds(problem_of(motion, filmed(motion, 0, 1)));
  EXPECT_NEAR(found(fit, 0) / bending_stiffness, 1, 0.01);
  EXPECT_NEAR(found(fit, 3) / length, 1, 1e-3);
}

TEST(Clouds, ofACableAtRestTellNoDamping) {
  const CloudFit fit = fit_clouds(problem_of({}, filmed({}, 0.003, 1)));
  EXPECT_NEAR(found(fit, 0) / bending_stiffness, 1, 0.1);
  EXPECT_TRUE(fit.confidence[0].told);
  EXPECT_FALSE(fit.confidence[1].told);
  EXPECT_FALSE(fit.confidence[2].told);
}

TEST(Clouds, sameInputSameBytes) {
  const Motion motion = shaking_hands();
  CloudProblem problem = problem_of(motion, filmed(motion, 0.003, 2));
  problem.clouds.times.resize(8);
  problem.clouds.points.resize(8);
  EXPECT_EQ(fit_clouds(problem).values, fit_clouds(problem).values);
}

TEST(Clouds, distancesAreFromTheSurface) {
  const std::vector<double> distances =
      distances_from_tube({{0.5, 0.3, 0}, {-1, 0, 0}, {0.5, 0, 0}, {1.3, 1.4, 0}}, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 0.1);
  const std::vector<double> right{0.2, 0.9, -0.1, 0.4};
  for (std::size_t i = 0; i < right.size(); ++i) EXPECT_NEAR(distances[i], right[i], 1e-12) << i;
}

/// cable_fit with clouds, in a directory of its own.
class CloudProgram : public CableFitProgram {
 protected:
  std::string write_clouds(const Clouds& clouds) {
    std::string text = "t,x,y,z\n";
    for (std::size_t i = 0; i < clouds.times.size(); ++i)
      for (const Vector3& point : clouds.points[i]) {
        text += number_text(clouds.times[i]);
        for (int axis = 0; axis < 3; ++axis) text += "," + number_text(point[axis]);
        text += "\n";
      }
    return write("clouds.csv", text);
  }
};

TEST_F(CloudProgram, writesTheCableAndAReport) {
  const std::string clouds = write_clouds(filmed({}, 0.003, 1));
  const std::string scene = write("filmed.yaml", filmed_scene(wrong_material, 1.04, 30, 0.004));
  ASSERT_EQ(
      fit("--clouds " + clouds + " --scene " + scene + " --output " + path("found.yaml") + " --report " + path("found.json")), 0)
      << err;
  const SceneDesc found = read_scene_file(path("found.yaml"));
  ASSERT_EQ(found.cables.size(), 1u);
  EXPECT_NEAR(found.cables[0].length, length, 0.003);
  EXPECT_EQ(found.cables[0].segments, 30);
  EXPECT_NEAR(found.materials[0].material.bending_stiffness.front(), bending_stiffness, 0.1 * bending_stiffness);
  EXPECT_NE(content(path("found.json")).find("\"told_by_the_data\": \"no\""), std::string::npos);
  EXPECT_NE(out.find("written: " + path("found.yaml") + ", " + path("found.json") + "\n"), std::string::npos) << out;
}

TEST_F(CloudProgram, refusesAllThatIsWrongAtOnce) {
  const std::string clouds = write("clouds.csv", "t,x,y,z\n-1,0,0,0\n0,0,nan,0\n1,0,0,0\n0.5,0,0,0\n");
  const std::string scene = write("filmed.yaml", filmed_scene(wrong_material, 0.6, 30, 0.004) + "colour: red\n");
  EXPECT_EQ(fit("take.csv --clouds " + clouds + " --scene " + scene + " --name rope --linear-density 0.1 --report " + scene), 2);
  for (const char* error :
       {"--output: missing", "--name: \"rope\"; allowed: none with --clouds",
        "\"take.csv\": a recording of markers; allowed: none with",
        "--linear-density, --radius: given; allowed: none with --clouds", "line 2: t -1; allowed: times from 0",
        "line 3: y \"nan\"; allowed: ", "line 5: t 0.5; allowed: times that do not descend, the last one is 1", "colour",
        "filmed.yaml\"; allowed: another file", "nothing was fitted"})
    EXPECT_NE(err.find(error), std::string::npos) << error << "\n" << err;
  EXPECT_EQ(fit("take.csv --name rope --output " + path("x.yaml") + " --scene " + scene), 2);
  EXPECT_NE(err.find("--scene: "), std::string::npos);
  EXPECT_NE(err.find("; allowed: with --clouds only"), std::string::npos);
}

TEST_F(CloudProgram, asksWhichCableItIs) {
  const std::string clouds = write("clouds.csv", "t,x,y,z\n0,0,0,0\n0,1,0,0\n");
  const std::string scene = write(
      "filmed.yaml", filmed_scene(wrong_material, 1.04, 30, 0.004) + "  - {name: other, length: 1, segments: 10, material: m}\n");
  const std::string arguments = "--clouds " + clouds + " --scene " + scene + " --output " + path("found.yaml");
  EXPECT_EQ(fit(arguments), 2);
  EXPECT_NE(err.find("--cable: missing; allowed: c, other"), std::string::npos) << err;
  EXPECT_EQ(fit(arguments + " --cable third"), 2);
  EXPECT_NE(err.find("--cable: \"third\"; allowed: c, other"), std::string::npos) << err;
}

}  // namespace
}  // namespace verlet_cable::cable_fit
