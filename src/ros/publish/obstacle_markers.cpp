#include "publish/obstacle_markers.h"

#include <array>
#include <cmath>

#include "publish/color.h"
#include "publish/conversions.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/view/drawing.h"

namespace verlet_cable {
namespace {

using visualization_msgs::Marker;

constexpr double plane_size = 20;          // [m]
constexpr double plane_depth = 0.002;      // [m] below the plane, where grids are drawn
constexpr double scale_tolerance = 1e-6;   // between edges that have to be equal
constexpr double length_tolerance = 0.01;  // of an orientation: it may have been rounded
constexpr std::size_t longest_uri = 4096;  // [characters] as paths

Marker make_marker(int type, const Pose& pose, const Vector3& scale) {
  Marker marker;
  marker.type = type;
  marker.pose = to_pose(pose);
  marker.scale = to_vector(scale);
  marker.color = to_color(opaque(view::obstacle_look().color));
  return marker;
}

/// With colors of corners, which rviz draws without light: its light shines from the camera, and leaves floors dark.
std::vector<Marker> markers_of(const PlaneShape&, const Pose& pose) {
  Marker plane = make_marker(Marker::TRIANGLE_LIST, pose, Vector3::Ones());
  constexpr double half = plane_size / 2;
  const std::array<Vector3, 4> corners{
      Vector3{-half, -half, -plane_depth}, {half, -half, -plane_depth}, {half, half, -plane_depth}, {-half, half, -plane_depth}};
  for (const int corner : {0, 1, 2, 0, 2, 3}) plane.points.push_back(to_point(corners[corner]));
  plane.color = to_color(opaque(view::plane_look().color));
  plane.colors.assign(plane.points.size(), plane.color);
  return {plane};
}

std::vector<Marker> markers_of(const SphereShape& sphere, const Pose& pose) {
  return {make_marker(Marker::SPHERE, pose, Vector3::Constant(2 * sphere.radius))};
}

std::vector<Marker> markers_of(const CylinderShape& cylinder, const Pose& pose) {
  return {make_marker(Marker::CYLINDER, pose, {2 * cylinder.radius, 2 * cylinder.radius, cylinder.length})};
}

std::vector<Marker> markers_of(const CapsuleShape& capsule, const Pose& pose) {
  std::vector<Marker> markers = markers_of(CylinderShape{capsule.radius, capsule.length}, pose);
  for (const double z : {-capsule.length / 2, capsule.length / 2})
    markers.push_back(markers_of(SphereShape{capsule.radius}, pose * Pose{{0, 0, z}, Quaternion::Identity()}).front());
  return markers;
}

std::vector<Marker> markers_of(const BoxShape& box, const Pose& pose) {
  return {make_marker(Marker::CUBE, pose, box.size)};
}

std::vector<Marker> markers_of(const MeshShape& mesh, const Pose& pose) {
  std::vector<Marker> markers{make_marker(Marker::MESH_RESOURCE, pose, mesh.scale)};
  markers.front().mesh_resource = mesh.uri;
  return markers;
}

std::string vector_text(const Vector3& v) {
  return "[" + number_text(v.x()) + ", " + number_text(v.y()) + ", " + number_text(v.z()) + "]";
}

std::string too_long(const std::string& text, std::size_t longest) {
  return std::to_string(text.size()) + " characters; allowed: at most " + std::to_string(longest);
}

bool are_equal(double a, double b) {
  return std::abs(a - b) <= scale_tolerance * std::abs(a);
}

std::string set_shape(const Marker& marker, Obstacle& obstacle) {
  const Vector3 scale(marker.scale.x, marker.scale.y, marker.scale.z);
  const std::string scale_text = "scale: " + vector_text(scale) + "; allowed: ";
  const bool is_mesh = marker.type == Marker::MESH_RESOURCE;
  for (const double factor : scale)
    if (!positive.contains(is_mesh ? std::abs(factor) : factor)) return scale_text + (is_mesh ? scale_words : positive.text("m"));
  switch (marker.type) {
    case Marker::CUBE:
      obstacle.shape = BoxShape{scale};
      return "";
    case Marker::SPHERE:
      obstacle.shape = SphereShape{scale.x() / 2};
      return are_equal(scale.x(), scale.y()) && are_equal(scale.x(), scale.z())
                 ? ""
                 : scale_text + "three equal numbers for a SPHERE, no ellipsoids";
    case Marker::CYLINDER:
      obstacle.shape = CylinderShape{scale.x() / 2, scale.z()};
      return are_equal(scale.x(), scale.y()) ? "" : scale_text + "equal x and y for a CYLINDER, no elliptic ones";
    case Marker::MESH_RESOURCE:
      if (marker.mesh_resource.size() > longest_uri)
        return "mesh_resource: " + in_quotes(marker.mesh_resource) + ", of " + too_long(marker.mesh_resource, longest_uri);
      obstacle.shape = MeshShape{nullptr, marker.mesh_resource, scale};
      return "";
    default:
      return "type: " + std::to_string(marker.type) + "; allowed: CUBE (1), SPHERE (2), CYLINDER (3), MESH_RESOURCE (10)";
  }
}

std::string set_pose(const geometry_msgs::Pose& pose, Obstacle& obstacle) {
  const Vector3 position(pose.position.x, pose.position.y, pose.position.z);
  if (!(position.cwiseAbs().maxCoeff() <= coordinate.highest) || position.hasNaN())
    return "pose.position: " + vector_text(position) + "; allowed: " + coordinate.text("m");
  Quaternion orientation(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z);
  // As elsewhere, what was left out is no rotation.
  if (orientation.coeffs().isZero(0)) orientation.setIdentity();
  const double length = orientation.norm();
  if (!(std::abs(length - 1) <= length_tolerance))
    return "pose.orientation: of length " + rounded_text(length) + "; allowed: a quaternion of length 1, or all zero";
  obstacle.pose = {position, orientation.normalized()};
  return "";
}

}  // namespace

std::vector<Marker> shape_markers(const Shape& shape, const Pose& pose) {
  return std::visit([&](const auto& solid) { return markers_of(solid, pose); }, shape);
}

MarkerObstacle obstacle_of(const Marker& marker) {
  MarkerObstacle result;
  if (marker.ns.size() > most_name_characters) {
    result.problem = "ns: " + in_quotes(marker.ns) + ", of " + too_long(marker.ns, most_name_characters);
    return result;
  }
  result.obstacle.name = marker.ns + "/" + std::to_string(marker.id);
  if (!is_frame_name(marker.header.frame_id)) {
    result.problem = "header.frame_id: " + in_quotes(marker.header.frame_id) + "; allowed: " + frame_words;
    return result;
  }
  result.problem = set_shape(marker, result.obstacle);
  if (result.problem.empty()) result.problem = set_pose(marker.pose, result.obstacle);
  return result;
}

}  // namespace verlet_cable
