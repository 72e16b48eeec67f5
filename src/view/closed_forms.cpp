#include "closed_forms.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
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

/// The t from which on, and up to which, something is near.
struct Span {
  double first, last;
};

/// Where |offset + t direction| is `radius`, from the place where it is smallest: so nothing cancels from far away. False where
/// it is nowhere so small. Most rays are tried here, many times each: it is worth its place in its callers.
[[gnu::always_inline]] inline bool reach_radius(const Vector3& offset, const Vector3& direction, double radius, Span& span) {
  const double dd = direction.squaredNorm();
  const double middle = -offset.dot(direction) / dd;
  const double rest = radius * radius - (offset + middle * direction).squaredNorm();
  if (!(rest >= 0)) return false;  // also without a direction
  const double half = std::sqrt(rest / dd);
  span = {middle - half, middle + half};
  return true;
}

/// `counts(point)`: whether a point of the sphere is part of the surface.
template <class Counts>
void meet_sphere(const Vector3& center, double radius, const Ray& ray, const Counts& counts, First& first) {
  Span span;
  if (!reach_radius(ray.origin - center, ray.direction, radius, span)) return;
  for (const double t : {span.first, span.last})
    if (first.wants(t) && counts(ray.at(t))) first.add(t, (ray.at(t) - center) / radius);
}

/// The side of a cylinder around z through the origin.
void meet_side(double radius, double half_length, const Ray& ray, First& first) {
  const auto flat = [](const Vector3& v) { return Vector3(v.x(), v.y(), 0); };
  Span span;
  if (!reach_radius(flat(ray.origin), flat(ray.direction), radius, span)) return;
  for (const double t : {span.first, span.last})
    if (first.wants(t) && std::abs(ray.at(t).z()) <= half_length) first.add(t, flat(ray.at(t)) / radius);
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
    const Vector3 half(0, 0, 0.5 * capsule.length);
    return RoundLine(-half, half, capsule.radius).meet(ray, lowest);
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

RoundLine::RoundLine(const Vector3& start, const Vector3& end, double radius)
    : start_(start), axis_(end - start), inverse_square_(0), radius_(radius) {
  const double square = axis_.squaredNorm();
  if (square > 0) inverse_square_ = 1 / square;
}

std::optional<double> RoundLine::first_of_near(const Ray& ray, double lowest) const {
  const Vector3 offset = ray.origin - start_;
  const double slope = ray.direction.dot(axis_) * inverse_square_, place = offset.dot(axis_) * inverse_square_;
  const Vector3 sideways = ray.direction - slope * axis_;
  Span span;
  if (sideways.squaredNorm() > 0) {
    if (!reach_radius(offset - place * axis_, sideways, radius_, span)) return {};  // past the endless cylinder, in which all is
    if (span.first >= lowest) {
      // Into that it comes beside the line, or before one of its ends, by whose ball alone it can come further then.
      const double part = place + span.first * slope;
      if (part >= 0 && part <= 1) return span.first;
      const bool meets = reach_radius(part < 0 ? offset : Vector3(offset - axis_), ray.direction, radius_, span);
      return meets && span.first >= lowest ? std::optional<double>(span.first) : std::nullopt;
    }
    if (!(span.last >= lowest)) return {};
  }
  return first_of_all(ray, lowest);
}

/// Also from the inside, and along the axis.
std::optional<double> RoundLine::first_of_all(const Ray& ray, double lowest) const {
  std::optional<double> found;
  const auto add = [&](const Span& span, const auto& counts) {
    for (const double t : {span.first, span.last})
      if (t >= lowest && (!found || t < *found) && counts(part(ray.at(t)))) found = t;
  };
  const Vector3 offset = ray.origin - start_;
  const auto across = [&](const Vector3& v) -> Vector3 { return v - v.dot(axis_) * inverse_square_ * axis_; };
  Span span;
  if (reach_radius(across(offset), across(ray.direction), radius_, span)) add(span, [](double at) { return at >= 0 && at <= 1; });
  if (reach_radius(offset, ray.direction, radius_, span)) add(span, [](double at) { return at <= 0; });
  if (reach_radius(offset - axis_, ray.direction, radius_, span)) add(span, [](double at) { return at >= 1; });
  return found;
}

std::optional<Meeting> RoundLine::meet(const Ray& ray, double lowest) const {
  const std::optional<double> t = first(ray, lowest);
  if (!t) return {};
  const Vector3 point = ray.at(*t);
  return Meeting{*t, (point - start_ - std::clamp(part(point), 0.0, 1.0) * axis_) / radius_};
}

std::optional<Meeting> meet_plane_of(const Vector3& a, const Vector3& b, const Vector3& c, const Ray& ray) {
  const Vector3 normal = (b - a).cross(c - a).normalized();
  const double slope = normal.dot(ray.direction);
  if (!(std::abs(slope) > 0)) return {};
  return Meeting{normal.dot(a - ray.origin) / slope, slope < 0 ? normal : Vector3(-normal)};
}

}  // namespace verlet_cable::view
