// Joints of whole rods: moment and stiffness are the first and second derivative of their energy.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "rod/rod_joints.h"

namespace verlet_cable {
namespace {

Eigen::Matrix3d turned(const Vector3& rotation) {
  return rotation.norm() > 0 ? Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix()
                             : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

/// Two joints, as they are computed with together: one that bends by `bend` [rad] and one that is straight.
struct Joints {
  explicit Joints(const JointStiffness& stiffness, const Vector3& bend) : stiffness(stiffness) {
    before_frame = turned({0.3, -0.8, 0.5});
    after_frame = before_frame * turned(bend);
    before.resize(3);
    after.resize(3);
    joints.resize(2);
    joints.set(0, stiffness, 0);
    joints.set(1, stiffness, 0);
    put_frames();
    joints.start(before.start, 0, after.start, 0, 0, 2);
    joints.evaluate(1, before, 0, after, 0, 0, 2);
  }

  void put_frames() {
    for (FrameArrays* frames : {&before.start, &before.end, &before.middle}) set(*frames, 0, before_frame);
    for (FrameArrays* frames : {&after.start, &after.end, &after.middle}) set(*frames, 0, after_frame);
  }

  /// [J] Once the frame after has turned by `rotation` [rad] against the one before.
  double energy(const Vector3& rotation) const {
    const JointAngles angles = joint_angles(before_frame, turned(rotation) * after_frame, joints.start_twist(0));
    const JointEnergy found = joint_energy(stiffness, angles);
    return found.bend + found.twist;
  }

  JointStiffness stiffness;
  Eigen::Matrix3d before_frame, after_frame;
  FrameMotion before, after;
  RodJoints joints;
};

JointStiffness of_joint(double twist, double bend_y, double bend_z, const JointAngles& rest) {
  JointStiffness stiffness;
  stiffness.twist = twist;
  stiffness.bend_y = bend_y;
  stiffness.bend_z = bend_z;
  stiffness.rest = rest;
  return stiffness;
}

TEST(RodJoints, MomentAndStiffnessAreDerivativesOfTheEnergy) {
  for (const JointStiffness& stiffness : {of_joint(0.7, 1, 1, {}), of_joint(0.7, 2, 0.3, {}),
                                          of_joint(2, 0.4, 1.5, {0.3, 0.5, -0.7}), of_joint(0, 1, 1, {0.2, 0.4, 0})})
    for (const Vector3& bend :
         {Vector3(0, 0, 0), Vector3(0, 0, 1), Vector3(0.4, 0.9, -0.6), Vector3(-1.5, 0.2, 1.1), Vector3(2, 0, 0)}) {
      const Joints joint(stiffness, bend);
      // Of central differences of fourth order: truncation 1e-3⁴, rounding 1e-16 / 1e-3².
      constexpr double step = 1e-3, tolerance = 1e-8;
      const auto energy = [&](const Vector3& v) { return joint.energy(step * v); };
      const Vector3 moment = get(joint.joints.moment, 0);
      const Eigen::Matrix3d exact = get(joint.joints.exact_stiffness, 0);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) {
          const Vector3 v = Vector3::Unit(i) + (i == j ? Vector3(Vector3::Zero()) : Vector3(Vector3::Unit(j)));
          const double slope = (8 * (energy(v) - energy(-v)) - (energy(2 * v) - energy(-2 * v))) / (12 * step);
          const double curvature =
              (16 * (energy(v) + energy(-v)) - (energy(2 * v) + energy(-2 * v)) - 30 * energy(Vector3::Zero())) /
              (12 * step * step);
          EXPECT_NEAR(v.dot(moment), slope, tolerance) << i << j << " bend " << bend.transpose();
          EXPECT_NEAR(v.dot(exact * v), curvature, tolerance) << i << j << " bend " << bend.transpose();
        }
      // What is left out of the convex part is that of the stresses.
      const Eigen::Matrix3d convex = get(joint.joints.convex_stiffness, 0);
      EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(convex).eigenvalues().minCoeff(), -tolerance);
      if (bend.isZero() && stiffness.rest.y == 0) {
        EXPECT_TRUE(convex.isApprox(exact, 1e-12));
      }
    }
}

}  // namespace
}  // namespace verlet_cable
