#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "../support/meshes.h"
#include "verlet_cable/core/shape.h"

namespace verlet_cable {
namespace {

constexpr double rounding = 1e-12;  // [m] of sums of a few products of numbers near 1

struct NamedShape {
  const char* name;
  Shape shape;
  std::function<double(const Vector3&)> distance;  // by another way than the code under test
};

double distance_to_segment(const Vector3& p, double half) {
  return Vector3(p.x(), p.y(), p.z() - std::max(-half, std::min(half, p.z()))).norm();
}

/// Distance of a solid that is an interval in each of its coordinates: Euclidean outside, the nearest face inside.
double distance_to_intervals(const std::vector<double>& beyond) {
  double outside = 0, inside = -infinity;
  for (const double b : beyond) {
    outside += std::max(b, 0.0) * std::max(b, 0.0);
    inside = std::max(inside, b);
  }
  return inside > 0 ? std::sqrt(outside) : inside;
}

double box_distance(const Vector3& p) {
  return distance_to_intervals({std::abs(p.x()) - 0.5, std::abs(p.y()) - 0.3, std::abs(p.z()) - 0.2});
}

std::vector<NamedShape> shapes() {
  const Vector3 size(1.0, 0.6, 0.4);
  return {{"plane", PlaneShape{}, [](const Vector3& p) { return p.z(); }},
          {"sphere", SphereShape{0.4}, [](const Vector3& p) { return p.norm() - 0.4; }},
          {"capsule", CapsuleShape{0.3, 0.8}, [](const Vector3& p) { return distance_to_segment(p, 0.4) - 0.3; }},
          {"cylinder", CylinderShape{0.3, 0.8},
           [](const Vector3& p) {
             return distance_to_intervals({std::hypot(p.x(), p.y()) - 0.3, std::abs(p.z()) - 0.4});
           }},
          {"box", BoxShape{size}, box_distance},
          {"mesh", MeshShape{box_triangles(size).mesh()}, box_distance}};
}

class RandomPoints {
 public:
  Vector3 next() { return {coordinate_(generator_), coordinate_(generator_), coordinate_(generator_)}; }

 private:
  std::mt19937 generator_{7};
  std::uniform_real_distribution<double> coordinate_{-1, 1};
};

void expect_surface_point(const NamedShape& shape, const Vector3& p) {
  const SurfacePoint found = closest_point(shape.shape, p);
  EXPECT_NEAR(found.distance, shape.distance(p), rounding) << shape.name << " at " << p.transpose();
  EXPECT_NEAR(shape.distance(found.point), 0, rounding) << shape.name << " at " << p.transpose();
  EXPECT_NEAR(found.normal.norm(), 1, rounding) << shape.name << " at " << p.transpose();
  EXPECT_LT((found.point + found.distance * found.normal - p).norm(), rounding) << shape.name << " at " << p.transpose();
}

TEST(Shape, ClosestPointsAreThoseOfTheClosedForms) {
  RandomPoints points;
  for (const NamedShape& shape : shapes())
    for (int i = 0; i < 2000; ++i) expect_surface_point(shape, points.next());
}

TEST(Shape, ClosestPointsAreDefinedOnCentersAxesFacesEdgesAndCorners) {
  for (const NamedShape& shape : shapes())
    for (const double x : {0.0, 0.3, 0.5, -0.5})
      for (const double y : {0.0, 0.3, -0.3})
        for (const double z : {0.0, 0.2, -0.2, 0.4, 0.7}) expect_surface_point(shape, {x, y, z});
}

TEST(Shape, NormalsOnTheSurfacePointOut) {
  RandomPoints points;
  for (const NamedShape& shape : shapes()) {
    for (int i = 0; i < 500; ++i) {
      const SurfacePoint on_surface = closest_point(shape.shape, closest_point(shape.shape, points.next()).point);
      EXPECT_NEAR(shape.distance(on_surface.point + 1e-3 * on_surface.normal), 1e-3, rounding) << shape.name;
    }
  }
}

TEST(Shape, DeepestPointsAreTheSmallestOfManyAlongTheSegment) {
  // Between samples a thousandth apart the distance cannot be smaller by more than half of that.
  constexpr int samples = 1000;
  RandomPoints points;
  for (const NamedShape& shape : shapes()) {
    for (int i = 0; i < 500; ++i) {
      const Vector3 start = points.next(), end = i % 3 ? points.next() : Vector3(start + 0.1 * points.next());
      const double length = (end - start).norm();
      double smallest = infinity;
      for (int k = 0; k <= samples; ++k) smallest = std::min(smallest, shape.distance(start + k * (end - start) / samples));
      const SegmentSurfacePoint deepest = deepest_point(shape.shape, start, end);
      EXPECT_NEAR(deepest.surface.distance, smallest, 0.5 * length / samples + rounding) << shape.name;
      // A mesh's depth is searched to a thousandth of the segment.
      const double tolerance = std::string(shape.name) == "mesh" && smallest < 0 ? length / 1000 : rounding;
      EXPECT_LE(deepest.surface.distance, smallest + tolerance) << shape.name;
      EXPECT_GE(deepest.fraction, 0);
      EXPECT_LE(deepest.fraction, 1);
      const Vector3 at = start + deepest.fraction * (end - start);
      EXPECT_LT((deepest.surface.point + deepest.surface.distance * deepest.surface.normal - at).norm(), rounding) << shape.name;
    }
  }
}

TEST(Shape, DeepestPointOfASegmentBesideAnEdgeIsAtTheEdge) {
  // A box' upper edge at x = 0.5, z = 0.2, passed at 45 degrees: the foot of the perpendicular.
  const Vector3 start(0.5, 0, 0.4), end(0.8, 0, 0.1);
  for (const Shape& shape : {Shape(BoxShape{{1.0, 0.6, 0.4}}), Shape(MeshShape{box_triangles({1.0, 0.6, 0.4}).mesh()})}) {
    const SegmentSurfacePoint deepest = deepest_point(shape, start, end);
    EXPECT_NEAR(deepest.fraction, 1.0 / 3, 1e-7);  // the minimum is flat: half the digits of its value
    EXPECT_NEAR(deepest.surface.distance, std::sqrt(0.5) * 0.2, rounding);
    EXPECT_LT((deepest.surface.point - Vector3(0.5, 0, 0.2)).norm(), rounding);
  }
}

TEST(Shape, DeepestPointOfASegmentAlongASurfaceIsOnIt) {
  for (const Shape& shape : {Shape(PlaneShape{}), Shape(BoxShape{{2, 2, 0}}), Shape(CylinderShape{2, 0})}) {
    const SegmentSurfacePoint deepest = deepest_point(shape, {-0.3, 0.1, 0}, {0.4, 0.2, 0});
    EXPECT_EQ(deepest.surface.distance, 0);
    EXPECT_EQ(deepest.surface.normal, Vector3::UnitZ());
  }
  const Vector3 here(0.1, 0.2, 0.9);
  for (const NamedShape& shape : shapes()) {
    EXPECT_NEAR(deepest_point(shape.shape, here, here).surface.distance, shape.distance(here), rounding) << shape.name;
  }
}

TEST(Shape, ReachCutsOffOnlyWhatIsFurtherAway) {
  constexpr double reach = 0.1;
  RandomPoints points;
  for (const NamedShape& shape : shapes()) {
    for (int i = 0; i < 1000; ++i) {
      const Vector3 start = points.next(), end = start + 0.1 * points.next();
      const double distance = shape.distance(start);
      const SurfacePoint cut_off = closest_point(shape.shape, start, reach);
      if (distance < reach) {
        EXPECT_NEAR(cut_off.distance, distance, rounding) << shape.name;
      } else {
        EXPECT_GE(cut_off.distance, reach) << shape.name;
      }
      const double along = deepest_point(shape.shape, start, end).surface.distance;
      const double along_cut_off = deepest_point(shape.shape, start, end, reach).surface.distance;
      if (along < reach) {
        EXPECT_EQ(along_cut_off, along) << shape.name;
      } else {
        EXPECT_GE(along_cut_off, reach) << shape.name;
      }
    }
  }
}

TEST(Shape, BoundsHoldTheShapeTightly) {
  RandomPoints points;
  const Pose pose{{0.3, -0.2, 0.5}, quaternion_from_rpy({0.4, 1.1, -0.7})};
  for (const NamedShape& shape : shapes()) {
    const Aabb box = bounds(shape.shape, pose);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        // The furthest point in a direction is the one below a point very far away in it, to the sagitta of what is round.
        const Vector3 direction = side * Vector3::Unit(axis);
        const Vector3 far = pose.inverse().orientation * (1e6 * direction - pose.position);
        const double furthest = (pose.position + pose.orientation * closest_point(shape.shape, far).point)[axis];
        const double bound = side > 0 ? box.max()[axis] : box.min()[axis];
        if (std::isinf(bound)) {
          EXPECT_EQ(std::string(shape.name), "plane");
        } else {
          EXPECT_NEAR(furthest, bound, 1e-6) << shape.name;
        }
      }
    }
  }
}

/// The solid angle of all triangles over 4 pi: 1 inside, 0 outside (van Oosterom and Strackee 1983).
double winding_number(const Triangles& mesh, const Vector3& p) {
  double angle = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vector3 a = mesh.vertices[i] - p, b = mesh.vertices[j] - p, c = mesh.vertices[k] - p;
    angle += 2 * std::atan2(a.dot(b.cross(c)),
                            a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() + b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  return angle / (4 * M_PI);
}

/// By the distances of projections onto the plane and the three edges of a triangle.
double distance_to_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 normal = (b - a).cross(c - a).normalized();
  const Vector3 foot = p - normal.dot(p - a) * normal;
  const auto inside_of = [&](const Vector3& from, const Vector3& to) { return normal.dot((to - from).cross(foot - from)) >= 0; };
  if (inside_of(a, b) && inside_of(b, c) && inside_of(c, a)) return (p - foot).norm();
  const auto to_edge = [&](const Vector3& from, const Vector3& to) {
    const double t = std::max(0.0, std::min(1.0, (p - from).dot(to - from) / (to - from).squaredNorm()));
    return (p - from - t * (to - from)).norm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

TEST(TriangleMesh, DistancesOfATorusAreThoseOfItsTrianglesAndItsWindingNumber) {
  const Triangles torus = torus_triangles(0.6, 0.25, 24, 12);
  const auto mesh = torus.mesh();
  RandomPoints points;
  for (int i = 0; i < 300; ++i) {
    const Vector3 p = points.next();
    double distance = infinity;
    for (const auto& [a, b, c] : torus.triangles)
      distance = std::min(distance, distance_to_triangle(p, torus.vertices[a], torus.vertices[b], torus.vertices[c]));
    const double sign = winding_number(torus, p) > 0.5 ? -1 : 1;
    EXPECT_NEAR(mesh->closest_point(p).distance, sign * distance, rounding);
  }
}

TEST(TriangleMesh, DeepestPointsOfSegmentsThroughATorus) {
  const auto mesh = torus_triangles(0.6, 0.25, 24, 12).mesh();
  RandomPoints points;
  constexpr int samples = 2000;
  for (int i = 0; i < 200; ++i) {
    const Vector3 start = points.next(), end = points.next();
    const double length = (end - start).norm();
    double smallest = infinity;
    for (int k = 0; k <= samples; ++k)
      smallest = std::min(smallest, mesh->closest_point(start + k * (end - start) / samples).distance);
    EXPECT_NEAR(mesh->deepest_point(start, end).surface.distance, smallest, length / 1000);
  }
}

TEST(TriangleMesh, TurnedInsideOutIsTheSameSolid) {
  Triangles box = box_triangles({1, 1, 1});
  for (auto& triangle : box.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_NEAR(box.mesh()->closest_point({0, 0, 0.4}).distance, -0.1, rounding);
}

TEST(TriangleMesh, RefusesWhatIsNoMesh) {
  const Triangles box = box_triangles({1, 1, 1});
  const auto problem = [](const Triangles& t) { return TriangleMesh::problem(t.vertices, t.triangles); };
  EXPECT_EQ(problem(box), "");
  EXPECT_EQ(problem({box.vertices, {}}), "it has no triangles");
  EXPECT_EQ(problem({box.vertices, {{0, 1, 1}}}), "it has no triangles");
  Triangles stray = box;
  stray.triangles[3][1] = 8;
  EXPECT_EQ(problem(stray), "a triangle names a vertex that does not exist");
  Triangles infinite = box;
  infinite.vertices[2].y() = infinity;
  EXPECT_EQ(problem(infinite), "a vertex is not finite");
  EXPECT_THROW(stray.mesh(), std::invalid_argument);
}

}  // namespace
}  // namespace verlet_cable
