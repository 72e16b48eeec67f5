#include <gtest/gtest.h>

#include <cmath>

#include "../support/meshes.h"
#include "body/mass_properties.h"
#include "verlet_cable/core/rotation.h"
#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {
namespace {

constexpr double rounding = 1e-12;  // relative, of sums of some hundred products

void expect_same(const MassProperties& found, const MassProperties& expected) {
  const double size = std::sqrt(expected.inertia.trace() / expected.mass);
  EXPECT_NEAR(found.mass, expected.mass, rounding * expected.mass);
  EXPECT_LT((found.center_of_mass - expected.center_of_mass).norm(), rounding * size);
  EXPECT_LT((found.inertia - expected.inertia).norm(), rounding * expected.inertia.norm()) << found.inertia;
}

Eigen::Matrix3d diagonal(double x, double y, double z) {
  return Vector3(x, y, z).asDiagonal();
}

/// By the midpoint rule over layers of circles of radius r(z) from -top to top.
template <class Radius>
MassProperties body_of_revolution(double top, const Radius& radius) {
  constexpr int layers = 200000;
  const double thickness = 2 * top / layers;
  MassProperties sum;
  for (int i = 0; i < layers; ++i) {
    const double z = -top + (i + 0.5) * thickness, square = radius(z) * radius(z), mass = M_PI * square * thickness;
    const double across = mass * (0.25 * square + z * z);
    sum.mass += mass;
    sum.inertia += diagonal(across, across, 0.5 * mass * square);
  }
  return sum;
}

ShapeDesc box(const Vector3& size, const InitialPose& pose) {
  ShapeDesc desc;
  desc.type = ShapeType::box;
  desc.size = size;
  desc.pose = pose;
  return desc;
}

TEST(MassProperties, AreThoseOfTheClosedForms) {
  const double pi = M_PI;
  expect_same(mass_properties(SphereShape{0.5}), {pi / 6, Vector3::Zero(), diagonal(1, 1, 1) * 0.1 * pi / 6});
  expect_same(mass_properties(CylinderShape{0.5, 2}), {pi / 2, Vector3::Zero(), pi / 2 * diagonal(4.75 / 12, 4.75 / 12, 0.125)});
  expect_same(mass_properties(BoxShape{{1, 2, 3}}), {6, Vector3::Zero(), 0.5 * diagonal(13, 10, 5)});
  EXPECT_EQ(mass_properties(PlaneShape{}).mass, 0);
}

TEST(MassProperties, OfACapsuleAreThoseOfItsLayers) {
  const double radius = 0.3, half = 0.4;
  const MassProperties layers = body_of_revolution(half + radius, [&](double z) {
    const double beyond = std::max(0.0, std::abs(z) - half);
    return std::sqrt(radius * radius - beyond * beyond);
  });
  const MassProperties capsule = mass_properties(CapsuleShape{radius, 2 * half});
  // Layers of 7 um: the midpoint rule is off by some 1e-10 of it.
  EXPECT_NEAR(capsule.mass, layers.mass, 1e-8 * layers.mass);
  EXPECT_LT((capsule.inertia - layers.inertia).norm(), 1e-8 * layers.inertia.norm()) << capsule.inertia - layers.inertia;
}

TEST(MassProperties, OfAMeshAreThoseOfItsShapeWhereverItIs) {
  const Vector3 size(1, 0.6, 0.4), away(3, -2, 5);
  Triangles triangles = box_triangles(size);
  MassProperties expected = mass_properties(BoxShape{size});
  expect_same(mass_properties(MeshShape{triangles.mesh()}), expected);
  for (Vector3& vertex : triangles.vertices) vertex += away;
  expected.center_of_mass = away;
  expect_same(mass_properties(MeshShape{triangles.mesh()}), expected);
}

TEST(MassProperties, OfAFineMeshConvergeToThoseOfTheTorus) {
  // Of a ring with radius R and a tube of radius r: 2 pi^2 R r^2, m (R^2 + 3/4 r^2) about its axis, m (R^2 / 2 + 5/8 r^2) across.
  const double ring = 0.5, tube = 0.2, mass = 2 * M_PI * M_PI * ring * tube * tube;
  const double along = mass * (ring * ring + 0.75 * tube * tube), across = mass * (0.5 * ring * ring + 0.625 * tube * tube);
  double last_error = 0;
  for (const int sides : {40, 80, 160}) {
    const MassProperties found = mass_properties(MeshShape{torus_triangles(ring, tube, sides, sides).mesh()});
    const double error = (found.inertia - diagonal(across, across, along)).norm() / along;
    EXPECT_LT(error, 30.0 / (sides * sides));
    // Chords are within the circle by the square of their length.
    if (last_error > 0) {
      EXPECT_NEAR(last_error / error, 4, 0.05);
    }
    last_error = error;
  }
}

TEST(MassProperties, OfATurnedBoxAreTurned) {
  BodyDesc body;
  body.mass = 3;
  body.shapes = {box({1, 2, 3}, {0.1, 0.2, 0.3, 0.4, -0.5, 0.6})};
  const Eigen::Matrix3d axes = quaternion_from_rpy({0.4, -0.5, 0.6}).toRotationMatrix();
  const Eigen::Matrix3d inertia = axes * diagonal(13, 10, 5) * axes.transpose() * 0.25;
  expect_same(*mass_properties(body), {3, {0.1, 0.2, 0.3}, inertia});
}

TEST(MassProperties, ShapesShareTheMassByTheirVolume) {
  // A box of 1 x 1 x 3 in two parts of unequal size, and the same in one.
  BodyDesc parts, whole;
  parts.mass = whole.mass = 2;
  parts.shapes = {box({1, 1, 1}, {0, 0, -1, 0, 0, 0}), box({1, 1, 2}, {0, 0, 0.5, 0, 0, 0})};
  whole.shapes = {box({1, 1, 3}, {0, 0, 0, 0, 0, 0})};
  expect_same(*mass_properties(parts), *mass_properties(whole));
}

TEST(MassProperties, WhatIsGivenIsTaken) {
  BodyDesc body;
  body.mass = 2;
  EXPECT_FALSE(mass_properties(body));
  body.inertia = Vector3(1, 2, 2.5);
  expect_same(*mass_properties(body), {2, Vector3::Zero(), diagonal(1, 2, 2.5)});
  body.shapes = {box({1, 2, 3}, {0.5, 0, 0, 0, 0, 0})};
  expect_same(*mass_properties(body), {2, {0.5, 0, 0}, diagonal(1, 2, 2.5)});
  body.center_of_mass = Vector3(0, 1, 0);
  expect_same(*mass_properties(body), {2, {0, 1, 0}, diagonal(1, 2, 2.5)});
  // Of the shapes, about another point than their own center: (0.5, -1, 0) from it.
  body.inertia.reset();
  Eigen::Matrix3d shift;
  shift << 1, 0.5, 0, 0.5, 0.25, 0, 0, 0, 1.25;
  expect_same(*mass_properties(body), {2, {0, 1, 0}, Eigen::Matrix3d(diagonal(13, 10, 5) / 6 + 2 * shift)});
}

TEST(MassProperties, InertiaObeysTheTriangleInequalities) {
  EXPECT_TRUE(is_inertia({1, 1, 1}));
  EXPECT_TRUE(is_inertia({0.1, 0.2, 0.3}));  // a thin plate; 0.1 + 0.2 is not quite 0.3
  EXPECT_FALSE(is_inertia({1, 1, 2.01}));
  EXPECT_FALSE(is_inertia({2.01, 1, 1}));
  EXPECT_FALSE(is_inertia({0, 1, 1}));
  EXPECT_FALSE(is_inertia({-1, 1, 1}));
  EXPECT_FALSE(is_inertia({NAN, 1, 1}));
  EXPECT_FALSE(is_inertia({1, 1, infinity}));
}

}  // namespace
}  // namespace verlet_cable
