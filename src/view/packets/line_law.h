#pragma once

#include <cmath>
#include <limits>

namespace verlet_cable::view {

/// A ray, its origin being seen from the start of a line.
struct OffsetRay {
  double ox, oy, oz;
  double dx, dy, dz;
};

/// The points within `radius` of the line from (0, 0, 0) to (x, y, z).
struct LineNumbers {
  double x, y, z;
  double inverse_square;  ///< of the length; 0 without length
  double radius;
};

/// What `first_from_outside` says of rays that begin inside of the endless cylinder around the line, or run along it.
constexpr double from_inside = -std::numeric_limits<double>::infinity();
constexpr double never = std::numeric_limits<double>::infinity();

// Without linkage: what is compiled for one processor is not to be used for another.
namespace {

/// Whether a ray is further from the endless line than the radius; most that are tried are.
[[gnu::always_inline]] inline bool passes_by(const LineNumbers& line, const OffsetRay& ray) {
  const double x = ray.dy * line.z - ray.dz * line.y, y = ray.dz * line.x - ray.dx * line.z,
               z = ray.dx * line.y - ray.dy * line.x;
  const double apart = x * ray.ox + y * ray.oy + z * ray.oz;
  return apart * apart > line.radius * line.radius * (x * x + y * y + z * z);
}

/// t of the first meeting from `lowest` on, `never`, or `from_inside`. Without branches, so that it becomes vector code.
[[gnu::always_inline]] inline double first_from_outside(const LineNumbers& line, const OffsetRay& ray, double lowest) {
  const double slope = (ray.dx * line.x + ray.dy * line.y + ray.dz * line.z) * line.inverse_square;
  const double place = (ray.ox * line.x + ray.oy * line.y + ray.oz * line.z) * line.inverse_square;
  const double square = line.radius * line.radius;
  // Across the axis. From the place where the distance is smallest: so nothing cancels from far away.
  const double sx = ray.dx - slope * line.x, sy = ray.dy - slope * line.y, sz = ray.dz - slope * line.z;
  const double px = ray.ox - place * line.x, py = ray.oy - place * line.y, pz = ray.oz - place * line.z;
  const double inverse = 1 / (sx * sx + sy * sy + sz * sz);
  const double middle = -(px * sx + py * sy + pz * sz) * inverse;
  const double nx = px + middle * sx, ny = py + middle * sy, nz = pz + middle * sz;
  const double rest = square - (nx * nx + ny * ny + nz * nz);
  const double half = std::sqrt(rest * inverse);
  const double enter = middle - half;
  // Into the endless cylinder it comes beside the line, or before one of its ends, by whose ball alone it can come further then.
  const double part = place + enter * slope;
  const bool is_before = part < 0, is_beside = part >= 0 && part <= 1;
  const double bx = is_before ? ray.ox : ray.ox - line.x, by = is_before ? ray.oy : ray.oy - line.y,
               bz = is_before ? ray.oz : ray.oz - line.z;
  const double inverse_direction = 1 / (ray.dx * ray.dx + ray.dy * ray.dy + ray.dz * ray.dz);
  const double nearest = -(bx * ray.dx + by * ray.dy + bz * ray.dz) * inverse_direction;
  const double mx = bx + nearest * ray.dx, my = by + nearest * ray.dy, mz = bz + nearest * ray.dz;
  const double ball = nearest - std::sqrt((square - (mx * mx + my * my + mz * mz)) * inverse_direction);
  const double into_ball = ball >= lowest ? ball : never;
  const double from_outside = is_beside ? enter : into_ball;
  const double past_or_inside = middle + half >= lowest ? from_inside : never;
  const double met = enter >= lowest ? from_outside : past_or_inside;
  const double near = rest >= 0 ? met : never;
  return sx * sx + sy * sy + sz * sz > 0 ? near : from_inside;
}

}  // namespace
}  // namespace verlet_cable::view
