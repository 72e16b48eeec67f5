#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rods.h"
#include "validation.h"

/// What a rod does does not depend on how it is looked at: turned in space, in a mirror, counted from its other end, in other
/// units, or with other parts of the same law.
namespace verlet_cable::validation {
namespace {

/// A flat rod, curved and twisted at rest, that starts as an arc from the origin along x, in gravity; what holds it moves.
struct Motion {
  const char* name;
  std::vector<std::pair<double, AttachmentType>> holders;  ///< arc length, ascending
  /// Where a holder's frame is: x along the rod
  std::function<Pose(double arc_length, double time)> pose;
  double axial_stiffness = infinity;
  double damping = 0;  ///< [N m^2 s] of bending and of twist; along the rod a thousand times that
  bool numerical_damping = true;
};

constexpr double length = 1, duration = 0.25, time_step = 5e-4;
constexpr double arc = 1;  // [rad] in the xy plane
constexpr double rest_twist = 2;

/// The rod's own axes where it starts: rolled by its twist at rest.
Pose on_arc(double arc_length) {
  const double angle = arc * arc_length / length, radius = length / arc;
  return {radius * Vector3(std::sin(angle), 1 - std::cos(angle), 0),
          Eigen::AngleAxisd(angle, Vector3::UnitZ()) * Quaternion(Eigen::AngleAxisd(rest_twist * arc_length, Vector3::UnitX()))};
}

Pose resting(double arc_length, double) {
  return on_arc(arc_length);
}

/// Draws near, aside, yaws and rolls, from rest.
Pose moving(double arc_length, double time) {
  const double way = arc_length * time * time;
  const Pose motion{way * Vector3(-2, 1, 0.5), quaternion_from_rpy(way * Vector3(6, 2, -4))};
  const Pose start = on_arc(arc_length);
  return {start.position + motion.position, motion.orientation * start.orientation};
}

std::ostream& operator<<(std::ostream& stream, const Motion& motion) {
  return stream << motion.name;
}

const AttachmentType clamp = AttachmentType::clamp, hinge = AttachmentType::hinge;
const Motion motions[]{
    {"clamped, falling", {{0, clamp}}, resting},
    {"clamped at both ends, moving", {{0, clamp}, {1, clamp}}, moving},
    {"clamped at both ends, moving, elastic and damped", {{0, clamp}, {1, clamp}}, moving, 1e3, 2e-4},
    {"clamp and hinge, moving", {{0, clamp}, {1, hinge}}, moving},
    {"clamped inside, falling", {{0.5, clamp}}, resting},
    {"clamped inside, moving", {{0, clamp}, {0.5, clamp}, {1, hinge}}, moving},
    {"hinge inside, damped", {{0, clamp}, {0.5, hinge}}, moving, infinity, 2e-4},
};

/// How else the same is looked at.
struct View {
  Eigen::Matrix3d space = Eigen::Matrix3d::Identity();  ///< orthogonal; a reflection, too
  bool reversed = false;                                ///< counted from the other end
  double lengths = 1, times = 1, densities = 1;         ///< factors of the units
};

/// The pose of a right-handed frame: where space is mirrored its z is turned round; where the rod is reversed its x and z are.
Pose seen(const Pose& pose, const View& view) {
  const double handedness = view.space.determinant(), direction = view.reversed ? -1 : 1;
  const Vector3 axes(direction, 1, handedness * direction);
  return {view.lengths * (view.space * pose.position),
          Quaternion(Eigen::Matrix3d(view.space * pose.orientation.toRotationMatrix() * axes.asDiagonal()))};
}

/// Positions of the nodes at the end of a motion, and at rest after it, seen as ever: as if there were no view.
struct Outcome {
  std::vector<Vector3> moving, at_rest;
};

Outcome outcome(const Motion& motion, const View& view, int segments, const BendingStiffness& bending_stiffness = {0.01, 0.03},
                bool curved = true, double radius = 0.005) {
  const double l = view.lengths, t = view.times, handedness = view.space.determinant(), direction = view.reversed ? -1 : 1;
  const double force = view.densities * l * l / (t * t), stiffness = force * l * l;
  SceneDesc scene = scenes::one_cable(segments, l * length);
  scene.time_step = time_step * t;
  scene.numerical_damping = motion.numerical_damping;
  scene.gravity.acceleration = l / (t * t) * (view.space * Vector3(0, -3, -9));
  material(scene).linear_density *= view.densities;
  material(scene).radius = l * radius;
  material(scene).axial_stiffness = motion.axial_stiffness * force;
  material(scene).bending_stiffness = {stiffness * bending_stiffness.front(), stiffness * bending_stiffness.back()};
  material(scene).torsional_stiffness = stiffness * 0.0075;
  material(scene).bending_damping = material(scene).torsional_damping = stiffness * t * motion.damping;
  material(scene).axial_damping = force * t * 1000 * motion.damping;
  if (curved) {
    // Curvature and twist are parts of an axial vector: mirrored, those about axes in the mirror turn round.
    bend_at_rest(scene, handedness * direction * 2.5 / l, 1.7 / l);
    scene.cables[0].rest_twist = handedness * rest_twist / l;
  }
  CableDesc& cable = scene.cables[0];
  std::vector<std::pair<double, AttachmentType>> holders = motion.holders;
  for (std::size_t i = 0; i < holders.size(); ++i) {
    const auto [arc_length, type] = holders[i];
    const std::string name = "h" + std::to_string(i);
    cable.attachments.push_back(scenes::attachment(name, PlaceDesc::At::arc_length, Vector3::Zero(), name, type));
    cable.attachments.back().place.arc_length = l * (view.reversed ? length - arc_length : arc_length);
  }
  start_at(scene, [&](double s) -> Vector3 { return l * (view.space * on_arc(length * (view.reversed ? 1 - s : s)).position); });
  const auto place_frames = [&](BoundaryInputs& inputs, double time) {
    for (std::size_t i = 0; i < holders.size(); ++i) {
      inputs[i + 1] = {};
      inputs[i + 1].pose = seen(motion.pose(holders[i].first, time), view);
    }
  };
  BoundaryInputs frames = initial_frames(scene);
  place_frames(frames, 0);
  Simulation run(scene, frames);
  for (long i = 1; i <= std::lround(duration / time_step) && !testing::Test::HasFatalFailure(); ++i) {
    place_frames(run.inputs, time_step * i);
    run.step();
  }
  const auto seen_as_ever = [&](std::vector<Vector3> positions) {
    if (view.reversed) std::reverse(positions.begin(), positions.end());
    for (Vector3& p : positions) p = view.space.transpose() * p / l;
    return positions;
  };
  Outcome result{seen_as_ever(run.positions()), {}};
  EXPECT_TRUE(run.world.settle());
  result.at_rest = seen_as_ever(run.positions());
  return result;
}

double distance(const std::vector<Vector3>& first, const std::vector<Vector3>& second) {
  double largest = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const double apart = (first[i] - second[i]).norm();
    if (!(apart <= largest)) largest = apart;
  }
  return largest;
}

constexpr double rounding = 1e-9;
/// Rounding may end an iteration earlier or later, at the solver's tolerance of 1e-5 segment lengths a second: what is left of a
/// velocity adds up over the steps.
double tolerance(int segments) {
  return 1e-5 * (length / segments) * (duration / time_step) * duration;
}

void expect_same(const Outcome& first, const Outcome& second, int segments, const std::string& what) {
  EXPECT_LT(distance(first.moving, second.moving), tolerance(segments)) << what;
  EXPECT_LT(distance(first.at_rest, second.at_rest), rounding) << what << ", at rest";
}

class Symmetries : public testing::TestWithParam<Motion> {
 protected:
  static constexpr int segments = 20;
  const Outcome plain = outcome(GetParam(), {}, segments);
  void expect_same_in(const View& view, const std::string& what) const {
    expect_same(plain, outcome(GetParam(), view, segments), segments, std::string(GetParam().name) + " " + what);
  }
};

TEST_P(Symmetries, TurnedInSpace) {
  View view;
  view.space = (Eigen::AngleAxisd(2.1, Vector3(0.3, -0.5, 0.8).normalized())).toRotationMatrix();
  expect_same_in(view, "turned");
  view.space = Vector3(-1, -1, 1).asDiagonal();
  expect_same_in(view, "turned by pi");
}

TEST_P(Symmetries, InAMirror) {
  View view;
  view.space = Vector3(1, 1, -1).asDiagonal();
  expect_same_in(view, "mirrored");
}

TEST_P(Symmetries, CountedFromTheOtherEnd) {
  View view;
  view.reversed = true;
  expect_same_in(view, "reversed");
}

/// Gravity is the same in them: to it the core scales the stiffness of what is inextensible.
TEST_P(Symmetries, InOtherUnits) {
  expect_same_in({Eigen::Matrix3d::Identity(), false, 4, 2, 0.125}, "large");
  expect_same_in({Eigen::Matrix3d::Identity(), false, 0.25, 0.5, 16}, "small");
}

INSTANTIATE_TEST_SUITE_P(Motions, Symmetries, testing::ValuesIn(motions));

class SegmentCounts : public testing::TestWithParam<int> {};

/// Any number of segments can be simulated, in every way of being held that it has nodes for.
TEST_P(SegmentCounts, CanBeSimulated) {
  const int n = GetParam();
  const Outcome fine = outcome(motions[0], {}, 40);
  EXPECT_LT((outcome(motions[0], {}, n).at_rest.back() - fine.at_rest.back()).norm(), 1.0 / n);
  View turned;
  turned.space = Eigen::AngleAxisd(1, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  for (const Motion& motion : motions) {
    const auto inside = [](const auto& holder) { return holder.first == 0.5; };
    if (n % 2 == 1 && std::any_of(motion.holders.begin(), motion.holders.end(), inside)) continue;  // no node in the middle
    if (n < 3 && motion.holders.size() > 1) continue;                                               // no room to give way
    expect_same(outcome(motion, {}, n), outcome(motion, turned, n), n, motion.name);
  }
}

INSTANTIATE_TEST_SUITE_P(Few, SegmentCounts, testing::Values(1, 2, 3, 5, 11));

/// A clamp inside parts a rod: each half is a rod of its own.
TEST(InnerClamp, PartsARod) {
  constexpr int n = 20;
  const Outcome whole = outcome(motions[4], {}, n);
  SceneDesc scene = scenes::one_cable(n / 2, 0.5);
  scene.time_step = time_step;
  scene.gravity.acceleration = {0, -3, -9};
  material(scene).bending_stiffness = {0.01, 0.03};
  material(scene).torsional_stiffness = 0.0075;
  bend_at_rest(scene, 2.5, 1.7);
  scene.cables[0].rest_twist = rest_twist;
  scene.cables[0].attachments = {scenes::attachment("h", PlaceDesc::At::start, Vector3::Zero(), "h", clamp)};
  start_at(scene, [](double s) { return on_arc(0.5 * (1 + s)).position; });
  BoundaryInputs frames = initial_frames(scene);
  frames[1] = {};
  frames[1].pose = on_arc(0.5);
  Simulation half(scene, frames);
  half.run(duration);
  const std::vector<Vector3> second_half(whole.moving.begin() + n / 2, whole.moving.end());
  EXPECT_LT(distance(half.positions(), second_half), tolerance(n));
}

/// A straight rod alike about all axes has a cheaper law of its own; a difference of its stiffnesses that is nothing has it
/// follow its material axes. The first leaves out the inertia of sections about the rod, of which there is next to none here, and
/// strains, in the angles between segments. What is taken for motion that a step cannot resolve is another matter.
class BothLaws : public testing::TestWithParam<Motion> {};

TEST_P(BothLaws, Agree) {
  constexpr int n = 40;
  constexpr double radius = 1e-5, strain = 1e-6;
  Motion motion = GetParam();
  motion.damping = 0;
  motion.numerical_damping = false;
  if (motion.axial_stiffness < infinity) motion.axial_stiffness = 1 / strain;
  const Outcome cheap = outcome(motion, {}, n, {0.01, 0.01}, false, radius);
  const Outcome whole = outcome(motion, {}, n, {0.01, 0.01 * (1 + 1e-12)}, false, radius);
  EXPECT_LT(distance(cheap.moving, whole.moving), tolerance(n));
  EXPECT_LT(distance(cheap.at_rest, whole.at_rest), 0.1 * strain);
}

INSTANTIATE_TEST_SUITE_P(Motions, BothLaws, testing::ValuesIn(motions));

class Turns : public testing::TestWithParam<BendingStiffness> {};

/// A clamp that turns thrice winds a taut rod up, and back.
TEST_P(Turns, AreCounted) {
  constexpr double strain = 0.01, turns = 6 * M_PI;
  SceneDesc scene = rod(20, 0.01);
  material(scene).axial_stiffness = 1e5;
  material(scene).bending_stiffness = GetParam();
  material(scene).torsional_stiffness = 1;
  material(scene).torsional_damping = 1e-3;
  damp(scene, 100);
  hold_ends(scene, clamp, 1 + strain);
  start_at(scene, [](double s) { return Vector3((1 + strain) * s, 0, 0); });
  Simulation run(scene);
  constexpr int steps = 200;
  for (const int way : {1, -1}) {
    for (int i = 1; i <= steps; ++i) {
      const double angle = turns * (way > 0 ? i : steps - i) / steps;
      run.inputs[1].pose.orientation = Eigen::AngleAxisd(angle, Vector3::UnitX());
      run.step();
    }
    EXPECT_TRUE(run.world.settle());
    const double torque = way > 0 ? turns : 0;  // GJ / L = 1
    EXPECT_NEAR(run.torque("end").x(), -torque, 1e-6 * turns);
    EXPECT_NEAR(run.torque("start").x(), torque, 1e-6 * turns);
    for (const Vector3& p : run.positions()) EXPECT_LT(p.tail<2>().norm(), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Sections, Turns,
                         testing::Values(BendingStiffness(1, 1), BendingStiffness(1, 1 + 1e-12), BendingStiffness(1, 0.2)));

/// A heavy rod that is straight unloaded, sags, and is turned about its axis at one end or both: damping in the material that
/// turns pushes it aside. In the cheap law of straight rods the torque that damping passes along the rod acts on the clamp only.
/// `second`: of its bending stiffnesses, to the first.
Simulation turning_shaft(bool both_ends, double second) {
  SceneDesc scene = scenes::one_cable(30);
  material(scene).bending_stiffness = {0.05, second * 0.05};
  material(scene).torsional_stiffness = 0.0375;
  material(scene).bending_damping = 5e-3;
  material(scene).torsional_damping = 5e-3;
  material(scene).drag = 0.2;
  scene.cables[0].attachments = {
      scenes::attachment("start", PlaceDesc::At::start, Vector3::Zero(), "hand", AttachmentType::clamp)};
  if (both_ends)
    scene.cables[0].attachments.push_back(
        scenes::attachment("end", PlaceDesc::At::end, {0.6, 0, 0}, "hand", AttachmentType::clamp));
  for (AttachmentDesc& clamped : scene.cables[0].attachments) clamped.initial_pose = InitialPose{0, 0, 0, 0, 0, 0};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  Simulation run(scene);
  while (run.world.time() < 6) {
    run.inputs.back().pose.orientation = Eigen::AngleAxisd(3 * run.world.time(), Vector3::UnitX());
    run.step();
  }
  return run;
}

TEST(TurningShaft, IsPushedAsideLikeARodOfMaterialFrames) {
  for (const bool both_ends : {false, true}) {
    const Simulation straight = turning_shaft(both_ends, 1), whole = turning_shaft(both_ends, 1 + 1e-12);
    const int node = both_ends ? 15 : 30;
    EXPECT_GT(std::abs(whole.positions()[node].y()), 0.01);
    report(std::string("turning shaft, damped, ") + (both_ends ? "both ends" : "one end") + ", against a rod of material frames",
           {{30, (straight.positions()[node] - whole.positions()[node]).norm() / std::abs(whole.positions()[node].y())}}, 0.15,
           Order::none);
  }
}

/// A cable that whirls on a hinge takes its material round with it: only that it nods as well is damped.
TEST(Whirl, IsDampedLikeARodOfMaterialFrames) {
  SceneDesc scene = scenes::one_cable(30);
  material(scene).bending_stiffness = 0.02;
  material(scene).bending_damping = 2e-3;
  scene.cables[0].attachments = {scenes::attachment("start", PlaceDesc::At::start, Vector3::Zero(), "")};
  InitialShapeDesc& initial = scene.cables[0].initial;
  initial.type = InitialShapeDesc::Type::points;
  for (int i = 0; i <= 30; ++i) {
    const double s = i / 30.0;
    initial.points.push_back({0.5 * s, 0, -std::sqrt(0.75) * s});
    initial.velocities.push_back(Vector3(0, 0, 4.5).cross(initial.points.back()));
  }
  Simulation straight(scene);
  material(scene).torsional_stiffness = 0.015;
  material(scene).bending_stiffness = {0.02, 0.02 * (1 + 1e-12)};
  Simulation whole(scene);
  const auto lost = [](Simulation& run) {
    const double energy = run.world.energy().total();
    run.run(15);
    return energy - run.world.energy().total();
  };
  report("whirl on a hinge: energy lost to damping, against a rod of material frames",
         {{30, std::abs(lost(straight) / lost(whole) - 1)}}, 0.05, Order::none);
}

}  // namespace
}  // namespace verlet_cable::validation
