#include <gtest/gtest.h>

#include <cmath>

#include "../support/meshes.h"
#include "geometry/winding_number.h"
#include "verlet_cable/core/shape.h"

namespace verlet_cable {
namespace {

/// Points in a box around the meshes, the same in each run.
std::vector<Vector3> points_around(int count, double reach) {
  std::vector<Vector3> points;
  std::uint32_t state = 1;
  const auto next = [&] {
    state = 1664525 * state + 1013904223;
    return reach * (2.0 * state / 4294967296.0 - 1);
  };
  for (int i = 0; i < count; ++i) {
    const double x = next(), y = next();
    points.emplace_back(x, y, next());
  }
  return points;
}

double exact_winding_number(const TriangleMesh& mesh, const Vector3& p) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles())
    sum += winding_number(mesh.vertices()[a] - p, mesh.vertices()[b] - p, mesh.vertices()[c] - p);
  return sum;
}

Triangles without_bottom(const Vector3& size) {
  Triangles box = box_triangles(size);
  box.triangles.erase(box.triangles.begin(), box.triangles.begin() + 2);
  return box;
}

Triangles torus_with_a_slit() {
  Triangles torus = torus_triangles(0.6, 0.25, 60, 40);
  torus.triangles.resize(torus.triangles.size() - 2 * 40);
  return torus;
}

const Triangles square{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};

TEST(WindingNumber, OfTheTreeIsTheSumOfAllTriangles) {
  const auto mesh = torus_with_a_slit().mesh();
  double largest = 0;
  for (const Vector3& p : points_around(2000, 1.2))
    largest = std::max(largest, std::abs(mesh->winding_number(p) - exact_winding_number(*mesh, p)));
  EXPECT_LT(largest, 5e-3);
  EXPECT_GT(largest, 0);
}

TEST(WindingNumber, OfATriangleIsItsSolidAngle) {
  // An eighth of a ball is seen through the corner of a cube, a half at the face itself; none of a line.
  EXPECT_NEAR(winding_number(Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()), 1.0 / 8, 1e-15);
  EXPECT_NEAR(std::abs(winding_number({-1, -1, 1e-9}, {2, -1, 1e-9}, {0, 2, 1e-9})), 0.5, 1e-8);
  EXPECT_EQ(winding_number({-1, 0, 0}, {1, 0, 0}, {2, 0, 0}), 0);
}

TEST(OpenMesh, InsideIsWhereTheWindingNumberIsAboveAHalf) {
  const auto mesh = torus_with_a_slit().mesh();
  EXPECT_FALSE(mesh->is_closed());
  EXPECT_FALSE(mesh->is_sheet());
  for (const Vector3& p : points_around(500, 1.0)) {
    const double winding = exact_winding_number(*mesh, p);
    if (std::abs(winding - 0.5) < 0.01) continue;
    EXPECT_EQ(mesh->closest_point(p).distance<0, winding> 0.5) << p.transpose();
  }
}

TEST(OpenMesh, FlippedTrianglesAreTurnedBack) {
  const auto sound = torus_with_a_slit().mesh();
  Triangles flipped = torus_with_a_slit();
  for (std::size_t i = 0; i < flipped.triangles.size(); i += 5) std::swap(flipped.triangles[i][0], flipped.triangles[i][1]);
  const auto mesh = flipped.mesh();
  for (const Vector3& p : points_around(200, 1.0))
    EXPECT_NEAR(mesh->closest_point(p).distance, sound->closest_point(p).distance, 1e-12);
}

TEST(OpenMesh, AnyTrianglesOfAClosedBoxMayBeFlipped) {
  for (int pattern = 0; pattern < 4096; pattern += 7) {
    Triangles box = box_triangles({1, 1, 0.2});
    for (int i = 0; i < 12; ++i)
      if (pattern >> i & 1) std::swap(box.triangles[i][0], box.triangles[i][1]);
    const auto mesh = box.mesh();
    EXPECT_TRUE(mesh->is_closed()) << pattern;
    EXPECT_NEAR(mesh->closest_point({0, 0, 0.09}).distance, -0.01, 1e-12) << pattern;
    EXPECT_NEAR(mesh->closest_point({0, 0, 0.11}).distance, 0.01, 1e-12) << pattern;
  }
}

TEST(OpenMesh, CopiesCountOnceAndLinesAreLeftOut) {
  Triangles box = box_triangles({1, 1, 1});
  const auto given = box.triangles;
  for (const auto& [a, b, c] : given)
    box.triangles.push_back(a % 2 ? TriangleMesh::Triangle{b, c, a} : TriangleMesh::Triangle{b, a, c});
  box.triangles.push_back({3, 3, 4});
  const auto mesh = box.mesh();
  EXPECT_EQ(mesh->triangles().size(), 12u);
  EXPECT_TRUE(mesh->is_closed());
  EXPECT_NEAR(mesh->closest_point({0, 0, 0.4}).distance, -0.1, 1e-12);
}

TEST(OpenMesh, AFinOnAnEdgeIsTouchedAndTheSolidStaysSolid) {
  Triangles box = box_triangles({1, 1, 1});
  box.vertices.emplace_back(0.5, 0.5, 2);
  box.vertices.emplace_back(-0.5, 0.5, 2);
  box.triangles.push_back({7, 8, 6});  // the edge from 6 to 7 has three triangles
  const auto mesh = box.mesh();
  EXPECT_FALSE(mesh->is_closed());
  EXPECT_FALSE(mesh->is_sheet());
  EXPECT_LT(mesh->closest_point({0, 0, 0}).distance, -0.49);
  EXPECT_NEAR(mesh->closest_point({0.3, 0.7, 1}).distance, 0.2, 1e-12);
}

TEST(OpenMesh, ClosedPartsFaceOutwardsWhereAnotherPartIsOpen) {
  Triangles both = without_bottom({1, 1, 0.2});
  for (const auto& vertex : box_triangles({0.5, 0.5, 0.5}).vertices) both.vertices.push_back(vertex + Vector3(3, 0, 0));
  for (const auto& [a, b, c] : box_triangles({1, 1, 1}).triangles) both.triangles.push_back({a + 8, c + 8, b + 8});
  const auto mesh = both.mesh();
  EXPECT_FALSE(mesh->is_sheet());
  EXPECT_NEAR(mesh->closest_point({3, 0, 0.2}).distance, -0.05, 1e-12);
  EXPECT_NEAR(mesh->closest_point({3, 0, 0.3}).distance, 0.05, 1e-12);
}

TEST(Sheet, IsWhatSurroundsNothing) {
  EXPECT_TRUE(square.mesh()->is_sheet());
  EXPECT_TRUE((Triangles{square.vertices, {{0, 1, 2}, {0, 2, 1}}}.mesh()->is_sheet()));
  EXPECT_FALSE(box_triangles({1, 1, 1}).mesh()->is_sheet());
  EXPECT_FALSE(without_bottom({0.2, 0.2, 3}).mesh()->is_sheet());  // a deep pot
}

TEST(Sheet, IsTouchedFromBothSidesAtHalfItsThickness) {
  for (const double thickness : {0.0, 0.02}) {
    const Shape shape = MeshShape{square.mesh(), {}, Vector3::Ones(), Sheet::automatic, thickness};
    for (const double side : {-1.0, 1.0}) {
      const SurfacePoint above = closest_point(shape, {0.2, 0.3, side * 0.1});
      EXPECT_NEAR(above.distance, 0.1 - thickness / 2, 1e-12);
      EXPECT_NEAR((above.normal - side * Vector3::UnitZ()).norm(), 0, 1e-12);
      EXPECT_NEAR((above.point - Vector3(0.2, 0.3, side * thickness / 2)).norm(), 0, 1e-12);
      const SegmentSurfacePoint along = deepest_point(shape, {-3, 0, side * 0.1}, {3, 0, side * 0.3});
      EXPECT_NEAR(along.surface.normal.z(), side, 0.1);
      // Where it crosses, the longer part tells the side.
      const SegmentSurfacePoint across = deepest_point(shape, {0, 0, -side * 0.1}, {0, 0, side * 0.3});
      EXPECT_NEAR(across.fraction, 0.25, 1e-12);
      EXPECT_NEAR(across.surface.distance, -thickness / 2, 1e-12);
      EXPECT_NEAR(across.surface.normal.z(), side, 1e-12);
    }
    EXPECT_NEAR(bounds(shape, Pose()).max().z(), thickness / 2, 1e-12);
  }
}

TEST(Sheet, MayBeChosen) {
  const auto box = box_triangles({1, 1, 1}).mesh();
  EXPECT_NEAR(closest_point(MeshShape{box, {}, Vector3::Ones(), Sheet::yes}, {0, 0, 0.4}).distance, 0.1, 1e-12);
  const auto pot = without_bottom({1, 1, 1}).mesh();
  EXPECT_NEAR(closest_point(MeshShape{pot, {}, Vector3::Ones(), Sheet::no}, {0, 0, 0.4}).distance, -0.1, 1e-12);
}

}  // namespace
}  // namespace verlet_cable
