#include "contact/solid_features.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace verlet_cable {

namespace {

/// Of the smallest extent.
constexpr double rounded_part = 2e-3;
/// Parts of an edge that are its ends.
constexpr double end_part = 1e-3;
/// A place within an edge counts beside its ends where it is deeper than these, in roundings.
constexpr double deeper_than_ends = 0.02;
/// Points of a cylinder's flat end, where that is flat on what it touches: to this sine of the angle between them.
constexpr int rim_points = 12;
constexpr std::uint32_t rim_features = rim_points + 1;
constexpr double flat = 0.05;
/// Cosine of the angle between axis and normal, where a cylinder's side touches.
constexpr double beside_axis = 0.05;
constexpr int rim_refinements = 2;

/// Looks for contacts of one solid's features with another solid.
class Finder {
 public:
  Finder(double rounding, const Pose& pose, const Shape& other, double other_rounding, const FeatureSearch& search,
         std::vector<FeatureContact>& found)
      : rounding_(rounding),
        position_(pose.position),
        turn_(pose.orientation.toRotationMatrix()),
        other_(inset(other, other_rounding)),
        other_rounding_(has_edges(other) ? other_rounding : 0),
        search_(search),
        is_plane_(std::holds_alternative<PlaneShape>(other)),
        found_(found) {}

  void find(const PlaneShape&) {}

  void find(const SphereShape& sphere) { add(0, position_, sphere.radius); }

  void find(const CapsuleShape& capsule) {
    const Vector3 half = 0.5 * capsule.length * turn_.col(2);
    add(0, position_ - half, capsule.radius);
    add(1, position_ + half, capsule.radius);
    if (!is_plane_) add_edge(2, position_ - half, position_ + half, capsule.radius);
  }

  void find(const BoxShape& box) {
    const Vector3 half = 0.5 * box.size - Vector3::Constant(rounding_);
    const auto corner = [&](int i) -> Vector3 {
      return position_ +
             turn_ * Vector3(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(), i & 4 ? half.z() : -half.z());
    };
    for (int i = 0; i < 8; ++i) add(i, corner(i), rounding_);
    if (is_plane_) return;
    std::uint32_t edge = 8;
    for (int axis = 1; axis <= 4; axis *= 2)
      for (int i = 0; i < 8; ++i)
        if ((i & axis) == 0) add_edge(edge++, corner(i), corner(i | axis), rounding_);
  }

  void find(const CylinderShape& cylinder) {
    const Vector3 axis = turn_.col(2), half = (0.5 * cylinder.length - rounding_) * axis;
    find_rim(0, position_ - half, axis, cylinder.radius - rounding_);
    find_rim(1, position_ + half, axis, cylinder.radius - rounding_);
    if (is_plane_) return;
    const SegmentSurfacePoint nearest = deepest_point(other_, position_ - half, position_ + half, spare(cylinder.radius));
    const bool inner = nearest.fraction > end_part && nearest.fraction < 1 - end_part;
    if (inner && std::abs(nearest.surface.normal.dot(axis)) < beside_axis)
      add_near(2 * rim_features, position_ + (2 * nearest.fraction - 1) * half, nearest.surface, cylinder.radius);
  }

  void find(const MeshShape& mesh) {
    const Aabb box = bounds(other_, Pose());
    const std::vector<Vector3>& vertices = mesh.mesh->vertices();
    const double radius = mesh.is_sheet() ? 0.5 * mesh.thickness : 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Vector3 place = position_ + turn_ * vertices[i];
      if (is_plane_ || box.squaredExteriorDistance(place) < spare(radius) * spare(radius))
        add(static_cast<std::uint32_t>(i), place, radius);
    }
  }

 private:
  static bool has_edges(const Shape& shape) {
    return std::holds_alternative<BoxShape>(shape) || std::holds_alternative<CylinderShape>(shape);
  }

  /// The solid that a rounded one is, but for its rounding.
  static Shape inset(const Shape& shape, double rounding) {
    if (const auto* box = std::get_if<BoxShape>(&shape)) return BoxShape{box->size - Vector3::Constant(2 * rounding)};
    if (const auto* cylinder = std::get_if<CylinderShape>(&shape))
      return CylinderShape{cylinder->radius - rounding, cylinder->length - 2 * rounding};
    if (const auto* mesh = std::get_if<MeshShape>(&shape)) return mesh->solid();
    return shape;
  }

  double spare(double radius) const { return radius + other_rounding_ + search_.reach; }

  void add(std::uint32_t feature, const Vector3& place, double radius) {
    add_near(feature, place, closest_point(other_, place, spare(radius)), radius);
  }

  /// `place`: in the middle of what is round by `radius`.
  void add_near(std::uint32_t feature, const Vector3& place, const SurfacePoint& nearest, double radius) {
    const double rounded = radius + other_rounding_;
    double distance = nearest.distance - rounded;
    if (!(distance < search_.reach)) return;
    SurfacePoint passed = nearest;
    if (distance > search_.padding) {
      const Vector3 travel = search_.travel.at(place);
      const SegmentSurfacePoint closest = deepest_point(other_, place, place + travel, spare(radius));
      if (closest.surface.distance - rounded > search_.padding && closest.surface.distance < spare(radius)) {
        passed = closest.surface;
        distance = passed.distance - rounded - closest.fraction * travel.dot(passed.normal);
      }
    }
    found_.push_back(
        {feature, place - radius * passed.normal, passed.point + other_rounding_ * passed.normal, passed.normal, distance});
  }

  /// Where an edge is deeper than at its ends.
  void add_edge(std::uint32_t feature, const Vector3& start, const Vector3& end, double radius) {
    const double far = spare(radius);
    const SegmentSurfacePoint nearest = deepest_point(other_, start, end, far);
    if (nearest.surface.distance >= far || nearest.fraction < end_part || nearest.fraction > 1 - end_part) return;
    const double ends = std::min(closest_point(other_, start).distance, closest_point(other_, end).distance);
    if (nearest.surface.distance < ends - deeper_than_ends * rounding_)
      add_near(feature, start + nearest.fraction * (end - start), nearest.surface, radius);
  }

  /// `side`: 0 or 1, which end of the cylinder.
  void find_rim(std::uint32_t side, const Vector3& center, const Vector3& axis, double radius) {
    const SurfacePoint nearest = closest_point(other_, center, spare(radius + rounding_));
    if (nearest.distance >= spare(radius + rounding_)) return;
    Vector3 normal = nearest.normal;
    for (int i = 0;; ++i) {
      const Vector3 across = normal - normal.dot(axis) * axis;
      const double tilt = across.norm();
      if (tilt < flat) break;
      const Vector3 place = center - radius / tilt * across;
      const SurfacePoint there = closest_point(other_, place);
      if (i == rim_refinements || is_plane_) return add_near(side * rim_features, place, there, rounding_);
      normal = there.normal;
    }
    const Vector3 first = turn_.col(0), second = turn_.col(1);
    for (int i = 0; i < rim_points; ++i) {
      const double angle = 2 * M_PI * i / rim_points;
      const Vector3 place = center + radius * (std::cos(angle) * first + std::sin(angle) * second);
      add(side * rim_features + 1 + static_cast<std::uint32_t>(i), place, rounding_);
    }
  }

  double rounding_;
  Vector3 position_;
  Eigen::Matrix3d turn_;
  Shape other_;
  double other_rounding_;
  const FeatureSearch& search_;
  bool is_plane_;
  std::vector<FeatureContact>& found_;
};

double smallest_extent(const Shape& shape) {
  return std::holds_alternative<PlaneShape>(shape) ? 0 : bounds(shape, Pose()).sizes().minCoeff();
}

}  // namespace

double rounding_of(const Shape& shape) {
  return rounded_part * smallest_extent(shape);
}

void find_feature_contacts(const Shape& solid, double rounding, const Pose& pose, const Shape& other, double other_rounding,
                           const FeatureSearch& search, std::vector<FeatureContact>& found) {
  Finder finder(rounding, pose, other, other_rounding, search, found);
  std::visit([&](const auto& shape) { finder.find(shape); }, solid);
}

}  // namespace verlet_cable
