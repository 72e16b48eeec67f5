#include "closed_forms.h"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>
#include <variant>

namespace verlet_cable::view {
namespace {

/// The first of the meetings with a convex solid, of which there are two at most.
class First {
 public:
  explicit First(double lowest) : lowest_(lowest) {}

  bool wants(double t) const { return t >= lowest_ && (!found_ || t < found_->t); }
  void add(double t, const Vector3& normal) { found_ = Meeting{t, normal}; }
  const std::optional<Meeting>& found() const { return found_; }

 private:
  double lowest_;
  std::optional<Meeting> found_;
};

/// Where |offset + t direction| is `radius`, from the place where it is smallest: so nothing cancels from far away. None where it
/// is nowhere so small.
std::optional<std::pair<double, double>> reach_radius(const Vector3& offset, const Vector3& direction, double radius) {
  const double dd = direction.squaredNorm();
  if (!(dd > 0)) return {};
  const double middle = -offset.dot(direction) / dd;
  const double rest = radius * radius - (offset + middle * direction).squaredNorm();
  if (!(rest >= 0)) return {};
  const double half = std::sqrt(rest / dd);
  return std::pair{middle - half, middle + half};
}

/// `counts(point)`: whether a point of the sphere is part of the surface.
template <class Counts>
void meet_sphere(const Vector3& center, double radius, const Ray& ray, const Counts& counts, First& first) {
  const auto meetings = reach_radius(ray.origin - center, ray.direction, radius);
  if (!meetings) return;
  for (const double t : {meetings->first, meetings->second})
    if (first.wants(t) && counts(ray.at(t))) first.add(t, (ray.at(t) - center) / radius);
}

/// The side of a cylinder around z through the origin.
void meet_side(double radius, double half_length, const Ray& ray, First& first) {
  const auto flat = [](const Vector3& v) { return Vector3(v.x(), v.y(), 0); };
  const auto meetings = reach_radius(flat(ray.origin), flat(ray.direction), radius);
  if (!meetings) return;
  for (const double t : {meetings->first, meetings->second})
    if (first.wants(t) && std::abs(ray.at(t).z()) <= half_length) first.add(t, flat(ray.at(t)) / radius);
}

std::optional<Meeting> meet_capsule(double radius, double half_length, const Ray& ray, double lowest) {
  First first(lowest);
  meet_side(radius, half_length, ray, first);
  for (const double end : {-half_length, half_length}) {
    const auto is_beyond = [end](const Vector3& point) { return end < 0 ? point.z() <= end : point.z() >= end; };
    meet_sphere({0, 0, end}, radius, ray, is_beyond, first);
  }
  return first.found();
}

struct MeetShape {
  const Ray& ray;
  double lowest;

  std::optional<Meeting> operator()(const PlaneShape&) const {
    if (!(ray.direction.z() < 0)) return {};
    const double t = -ray.origin.z() / ray.direction.z();
    return t >= lowest ? std::optional<Meeting>({t, Vector3::UnitZ()}) : std::nullopt;
  }
  std::optional<Meeting> operator()(const SphereShape& sphere) const {
    First first(lowest);
    meet_sphere(
        Vector3::Zero(), sphere.radius, ray, [](const Vector3&) { return true; }, first);
    return first.found();
  }
  std::optional<Meeting> operator()(const CapsuleShape& capsule) const {
    return meet_capsule(capsule.radius, 0.5 * capsule.length, ray, lowest);
  }
  std::optional<Meeting> operator()(const CylinderShape& cylinder) const {
    First first(lowest);
    const double half = 0.5 * cylinder.length;
    meet_side(cylinder.radius, half, ray, first);
    for (const double end : {-half, half}) {
      const double t = (end - ray.origin.z()) / ray.direction.z();
      if (first.wants(t) && ray.at(t).head<2>().squaredNorm() <= cylinder.radius * cylinder.radius)
        first.add(t, Vector3(0, 0, end < 0 ? -1 : 1));
    }
    return first.found();
  }
  std::optional<Meeting> operator()(const BoxShape& box) const {
    First first(lowest);
    double enter = -infinity, leave = infinity;
    int enter_axis = 0, leave_axis = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double half = 0.5 * box.size[axis], start = ray.origin[axis], slope = ray.direction[axis];
      if (slope == 0) {
        if (std::abs(start) > half) return {};
        continue;
      }
      const double one = (-half - start) / slope, other = (half - start) / slope;
      if (std::min(one, other) > enter) enter = std::min(one, other), enter_axis = axis;
      if (std::max(one, other) < leave) leave = std::max(one, other), leave_axis = axis;
    }
    if (enter > leave) return {};
    if (first.wants(enter)) first.add(enter, std::copysign(1.0, -ray.direction[enter_axis]) * Vector3::Unit(enter_axis));
    if (first.wants(leave)) first.add(leave, std::copysign(1.0, ray.direction[leave_axis]) * Vector3::Unit(leave_axis));
    return first.found();
  }
  std::optional<Meeting> operator()(const MeshShape&) const { return {}; }
};

}  // namespace

std::optional<Meeting> meet(const Shape& shape, const Ray& ray, double lowest) {
  return std::visit(MeetShape{ray, lowest}, shape);
}

std::optional<Meeting> meet_tube(const Vector3& start, const Vector3& end, double radius, const Ray& ray, double lowest) {
  const Vector3 axis = end - start;
  const double length = axis.norm();
  First first(lowest);
  if (length > 0) {
    const Vector3 along = axis / length, offset = ray.origin - start;
    const auto across = [&](const Vector3& v) -> Vector3 { return v - v.dot(along) * along; };
    if (const auto meetings = reach_radius(across(offset), across(ray.direction), radius)) {
      for (const double t : {meetings->first, meetings->second}) {
        const Vector3 point = offset + t * ray.direction;
        const double place = point.dot(along);
        if (first.wants(t) && place >= 0 && place <= length) first.add(t, (point - place * along) / radius);
      }
    }
  }
  meet_sphere(
      start, radius, ray, [&](const Vector3& point) { return (point - start).dot(axis) <= 0; }, first);
  meet_sphere(
      end, radius, ray, [&](const Vector3& point) { return (point - end).dot(axis) >= 0; }, first);
  return first.found();
}

std::optional<Meeting> meet_plane_of(const Vector3& a, const Vector3& b, const Vector3& c, const Ray& ray) {
  const Vector3 normal = (b - a).cross(c - a).normalized();
  const double slope = normal.dot(ray.direction);
  if (!(std::abs(slope) > 0)) return {};
  return Meeting{normal.dot(a - ray.origin) / slope, slope < 0 ? normal : Vector3(-normal)};
}

}  // namespace verlet_cable::view
