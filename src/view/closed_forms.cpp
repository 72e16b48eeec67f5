#include "closed_forms.h"

#include <Eigen/Geometry>
#include <cmath>

namespace verlet_cable::view {
namespace {

/// The t from which on, and up to which, something is near.
struct Span {
  double first, last;
};

/// Where |offset + t direction| is `radius`, from the place where it is smallest: so nothing cancels from far away. False where
/// it is nowhere so small.
bool reach_radius(const Vector3& offset, const Vector3& direction, double radius, Span& span) {
  const double dd = direction.squaredNorm();
  const double middle = -offset.dot(direction) / dd;
  const double rest = radius * radius - (offset + middle * direction).squaredNorm();
  if (!(rest >= 0)) return false;  // also without a direction
  const double half = std::sqrt(rest / dd);
  span = {middle - half, middle + half};
  return true;
}

}  // namespace

std::optional<double> meet_cylinder(double radius, double half_length, const Ray& ray, double lowest, Vector3& normal) {
  std::optional<double> found;
  const auto wants = [&](double t) { return t >= lowest && (!found || t < *found); };
  const auto flat = [](const Vector3& v) { return Vector3(v.x(), v.y(), 0); };
  Span span;
  if (reach_radius(flat(ray.origin), flat(ray.direction), radius, span))
    for (const double t : {span.first, span.last})
      if (wants(t) && std::abs(ray.at(t).z()) <= half_length) found = t, normal = flat(ray.at(t)) / radius;
  for (const double end : {-half_length, half_length}) {
    const double t = (end - ray.origin.z()) / ray.direction.z();
    if (wants(t) && ray.at(t).head<2>().squaredNorm() <= radius * radius) found = t, normal = Vector3(0, 0, end < 0 ? -1 : 1);
  }
  return found;
}

RoundLine::RoundLine(const Vector3& start, const Vector3& end, double radius)
    : start_(start), axis_(end - start), inverse_square_(0), radius_(radius) {
  const double square = axis_.squaredNorm();
  if (square > 0) inverse_square_ = 1 / square;
}

std::optional<double> RoundLine::first(const Ray& ray, double lowest) const {
  const Vector3 offset = ray.origin - start_;
  const OffsetRay seen{offset.x(), offset.y(), offset.z(), ray.direction.x(), ray.direction.y(), ray.direction.z()};
  const LineNumbers line = numbers();
  if (passes_by(line, seen)) return {};
  const double t = first_from_outside(line, seen, lowest);
  if (t == from_inside) return first_of_all(ray, lowest);
  return t < never ? std::optional<double>(t) : std::nullopt;
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

}  // namespace verlet_cable::view
