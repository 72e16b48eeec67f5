#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "packets/passes.h"
#include "random.h"

namespace verlet_cable::view {
// Without linkage: what is compiled for one processor is not to be used for another.
namespace {

void turn(const double* axes, const Lanes& x, const Lanes& y, VectorLanes& direction) {
  for (int i = 0; i < rays; ++i) {
    direction.x[i] = axes[0] * x[i] + axes[3] * y[i] + axes[6];
    direction.y[i] = axes[1] * x[i] + axes[4] * y[i] + axes[7];
    direction.z[i] = axes[2] * x[i] + axes[5] * y[i] + axes[8];
  }
}

void meet_plane(const PlaneNumbers& plane, int index, const VectorLanes& direction, Lanes& t, Lanes& nearest) {
  const double depth = -plane.height, x = plane.normal[0], y = plane.normal[1], z = plane.normal[2], number = index;
  for (int i = 0; i < rays; ++i) {
    const double slope = -(x * direction.x[i] + y * direction.y[i] + z * direction.z[i]);
    const bool is_nearer = slope > 0 && depth < slope * t[i];
    t[i] = is_nearer ? depth / slope : t[i];
    nearest[i] = is_nearer ? number : nearest[i];
  }
}

void ask(const double* start, const VectorLanes& direction, const Lanes& highest, RTCRayHit16& query) {
  const float x = static_cast<float>(start[0]), y = static_cast<float>(start[1]), z = static_cast<float>(start[2]);
  RTCRay16& ray = query.ray;
  for (int i = 0; i < rays; ++i) {
    ray.org_x[i] = x;
    ray.org_y[i] = y;
    ray.org_z[i] = z;
    ray.tnear[i] = 0;
    ray.time[i] = 0;
    ray.mask[i] = 0xffffffff;
    ray.id[i] = 0;
    ray.flags[i] = 0;
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  for (int i = 0; i < rays; ++i) {
    ray.dir_x[i] = static_cast<float>(direction.x[i]);
    ray.dir_y[i] = static_cast<float>(direction.y[i]);
    ray.dir_z[i] = static_cast<float>(direction.z[i]);
    ray.tfar[i] = static_cast<float>(highest[i]);
  }
}

template <unsigned count>
bool meet_line_of(const LineNumbers& line, const double* shift, RTCRayN* asked, double* t) {
  const float *x = &RTCRayN_org_x(asked, count, 0), *y = &RTCRayN_org_y(asked, count, 0), *z = &RTCRayN_org_z(asked, count, 0);
  const float *dx = &RTCRayN_dir_x(asked, count, 0), *dy = &RTCRayN_dir_y(asked, count, 0), *dz = &RTCRayN_dir_z(asked, count, 0);
  const float* lowest = &RTCRayN_tnear(asked, count, 0);
  const double shift_x = shift[0], shift_y = shift[1], shift_z = shift[2];
  const LineNumbers known = line;
  alignas(64) std::int64_t is_near[count];
  const auto ray = [&](unsigned i) { return OffsetRay{x[i] + shift_x, y[i] + shift_y, z[i] + shift_z, dx[i], dy[i], dz[i]}; };
  std::int64_t any = 0;
  for (unsigned i = 0; i < count; ++i) {
    is_near[i] = passes_by(known, ray(i)) ? 0 : 1;
    any |= is_near[i];
  }
  if (!any) return false;
  for (unsigned i = 0; i < count; ++i) {
    const double first = first_from_outside(known, ray(i), lowest[i]);
    t[i] = is_near[i] ? first : never;
  }
  return true;
}

bool meet_line(const LineNumbers& line, const double* shift, RTCRayN* asked, unsigned count, double* t) {
  if (count == 16) return meet_line_of<16>(line, shift, asked, t);
  return count == 8 ? meet_line_of<8>(line, shift, asked, t) : meet_line_of<4>(line, shift, asked, t);
}

/// Of t: the most by which that in double precision is taken to differ from Embree's.
constexpr double most_difference = 1e-3;

void meet_flat(const PlaneNumbers& surface, const Viewers& viewers, const VectorLanes& direction, const Lanes& about, Lanes& t,
               VectorLanes& normal) {
  const double x = surface.normal[0], y = surface.normal[1], z = surface.normal[2], height = surface.height;
  const Viewers of = viewers;
  for (int i = 0; i < rays; ++i) {
    const double dx = direction.x[i], dy = direction.y[i], dz = direction.z[i];
    const double slope = x * dx + y * dy + z * dz, found = height / slope;
    const bool is_seen = of.has(i), is_met = std::abs(found - about[i]) <= most_difference * about[i];
    const double inverse_length = -1 / std::sqrt(dx * dx + dy * dy + dz * dz);
    t[i] = is_seen ? (is_met ? found : about[i]) : t[i];
    normal.x[i] = is_seen ? (is_met ? x : dx * inverse_length) : normal.x[i];
    normal.y[i] = is_seen ? (is_met ? y : dy * inverse_length) : normal.y[i];
    normal.z[i] = is_seen ? (is_met ? z : dz * inverse_length) : normal.z[i];
  }
}

void meet_round(const LineLanes& lines, const VectorLanes& direction, const Lanes& about, Lanes& t, VectorLanes& normal) {
  for (int i = 0; i < rays; ++i) {
    const double x = lines.axis.x[i], y = lines.axis.y[i], z = lines.axis.z[i], square = x * x + y * y + z * z;
    const double dx = direction.x[i], dy = direction.y[i], dz = direction.z[i], radius = lines.radius[i];
    const LineNumbers line{x, y, z, square > 0 ? 1 / square : 0, radius};
    const OffsetRay ray{-lines.start.x[i], -lines.start.y[i], -lines.start.z[i], dx, dy, dz};
    const double first = first_from_outside(line, ray, 0);
    const double found = passes_by(line, ray) ? never : first;
    const bool is_seen = radius > 0, is_met = found < never && found > from_inside;
    const double px = ray.ox + found * dx, py = ray.oy + found * dy, pz = ray.oz + found * dz;
    const double part = (px * x + py * y + pz * z) * line.inverse_square;
    const double within = part < 0 ? 0 : part > 1 ? 1 : part, inverse_radius = 1 / radius;
    const double inverse_length = -1 / std::sqrt(dx * dx + dy * dy + dz * dz);
    t[i] = is_seen ? (is_met ? found : about[i]) : t[i];
    normal.x[i] = is_seen ? (is_met ? (px - within * x) * inverse_radius : dx * inverse_length) : normal.x[i];
    normal.y[i] = is_seen ? (is_met ? (py - within * y) * inverse_radius : dy * inverse_length) : normal.y[i];
    normal.z[i] = is_seen ? (is_met ? (pz - within * z) * inverse_radius : dz * inverse_length) : normal.z[i];
  }
}

void find_cosines(const VectorLanes& direction, const VectorLanes& normal, Lanes& cosine) {
  for (int i = 0; i < rays; ++i) {
    const double dx = direction.x[i], dy = direction.y[i], dz = direction.z[i];
    const double along = normal.x[i] * dx + normal.y[i] * dy + normal.z[i] * dz;
    cosine[i] = std::abs(along) / std::sqrt(dx * dx + dy * dy + dz * dz);
  }
}

void ask_hidden(const double* start, const double* aim, bool is_place, double gap, double gap_of_t, const VectorLanes& direction,
                const Lanes& t, const VectorLanes& normal, RTCRay16& query) {
  const double sx = start[0], sy = start[1], sz = start[2], ax = aim[0], ay = aim[1], az = aim[2], from_place = is_place ? 1 : 0;
  const float end = is_place ? 1 : std::numeric_limits<float>::infinity();
  for (int i = 0; i < rays; ++i) {
    query.tnear[i] = 0;
    query.tfar[i] = end;
    query.time[i] = 0;
    query.mask[i] = 0xffffffff;
    query.id[i] = 0;
    query.flags[i] = 0;
  }
  for (int i = 0; i < rays; ++i) {
    const double dx = direction.x[i], dy = direction.y[i], dz = direction.z[i];
    const double nx = normal.x[i], ny = normal.y[i], nz = normal.z[i];
    const double away = gap + gap_of_t * t[i], outwards = nx * dx + ny * dy + nz * dz < 0 ? away : -away;
    const double x = t[i] * dx + outwards * nx, y = t[i] * dy + outwards * ny, z = t[i] * dz + outwards * nz;
    query.org_x[i] = static_cast<float>(sx + x);
    query.org_y[i] = static_cast<float>(sy + y);
    query.org_z[i] = static_cast<float>(sz + z);
    query.dir_x[i] = static_cast<float>(ax - from_place * x);
    query.dir_y[i] = static_cast<float>(ay - from_place * y);
    query.dir_z[i] = static_cast<float>(az - from_place * z);
  }
}

/// The integral of a square wave of period 2, +1 and -1, which is a triangular one.
[[gnu::always_inline]] inline double integral_of_square_wave(double at) {
  return std::abs(2 * (0.5 * at - std::floor(0.5 * at)) - 1);
}

void find_checks(const CheckNumbers& checks, const Viewers& viewers, const VectorLanes& direction, const Lanes& t,
                 const Lanes& cosine, Lanes& second) {
  constexpr double least_cosine = 0.02, least_width = 1e-6, far_too_fine = 50;  // widths in squares
  const double ux = checks.x_axis[0], uy = checks.x_axis[1], uz = checks.x_axis[2];
  const double vx = checks.y_axis[0], vy = checks.y_axis[1], vz = checks.y_axis[2];
  const Viewers of = viewers;
  const double squares = 1 / checks.size, eye_u = checks.x, eye_v = checks.y, footprint = checks.footprint;
  for (int i = 0; i < rays; ++i) {
    const double dx = direction.x[i], dy = direction.y[i], dz = direction.z[i];
    const double u = squares * (eye_u + t[i] * (ux * dx + uy * dy + uz * dz));
    const double v = squares * (eye_v + t[i] * (vx * dx + vy * dy + vz * dz));
    const double aslant = cosine[i] > least_cosine ? cosine[i] : least_cosine;
    const double under_pixel = squares * footprint * t[i] / aslant, width = under_pixel > least_width ? under_pixel : least_width;
    // The means of square waves over what a pixel shows.
    const double mean_u = integral_of_square_wave(u - 0.5 * width) - integral_of_square_wave(u + 0.5 * width);
    const double mean_v = integral_of_square_wave(v - 0.5 * width) - integral_of_square_wave(v + 0.5 * width);
    const double share = width < far_too_fine ? 0.5 - 0.5 * mean_u * mean_v / (width * width) : 0.5;
    second[i] = of.has(i) ? share : second[i];
  }
}

/// Between 0 and 1, in steps.
[[gnu::always_inline]] inline int step_of_light(double light) {
  const double above = light > 0 ? light : 0, within = above < 1 ? above : 1;
  return static_cast<int>(within * last_step_of_light + 0.5);
}

void find_light(const LightNumbers& light, const PaintNumbers& paint, const Viewers& viewers, const Lanes& second,
                const Lanes& is_lit, const VectorLanes& direction, const VectorLanes& normal, int* steps) {
  constexpr double darker_below = 0.35;  // of the sky's light, on what faces down
  const double sun_x = light.to_sun[0], sun_y = light.to_sun[1], sun_z = light.to_sun[2], ambient = light.ambient;
  const Viewers of = viewers;
  const double shininess = paint.shininess;
  alignas(64) double brightness[rays], reflection[rays];
  for (int i = 0; i < rays; ++i) {
    const double dx = direction.x[i], dy = direction.y[i], dz = direction.z[i];
    const double nx = normal.x[i], ny = normal.y[i], nz = normal.z[i];
    const double to_sun = nx * sun_x + ny * sun_y + nz * sun_z, along = nx * dx + ny * dy + nz * dz;
    const double sun = to_sun > 0 ? (1 - ambient) * is_lit[i] : 0;
    brightness[i] = ambient * (1 - darker_below * 0.5 * (1 - nz)) + sun * to_sun;
    // As Phong has it, with the exponent 32, of the mirrored line of sight.
    const double mirrored = dx * sun_x + dy * sun_y + dz * sun_z - 2 * along * to_sun;
    double power = (mirrored > 0 ? mirrored : 0) / std::sqrt(dx * dx + dy * dy + dz * dz);
    for (int k = 0; k < 5; ++k) power *= power;
    reflection[i] = sun * shininess * power;
  }
  for (int channel = 0; channel < 3; ++channel) {
    const double color = paint.color[channel], difference = paint.second_color[channel] - color;
    int* const out = steps + channel * rays;
    for (int i = 0; i < rays; ++i) {
      const int step = step_of_light(brightness[i] * (color + second[i] * difference) + reflection[i]);
      out[i] = of.has(i) ? step : out[i];
    }
  }
}

void measure(const SensorNumbers& sensor, const float* depth, const float* cosine, int count, float* measured) {
  constexpr int together = 64;
  constexpr float no_return = std::numeric_limits<float>::quiet_NaN();
  const double a = sensor.axial[0], b = sensor.axial[1], c = sensor.axial[2];
  const bool is_noisy = a != 0 || b != 0 || c != 0;
  // What is rounded to steps of q has a variance of q^2 / 12 more (Sheppard's correction).
  constexpr double root_of_12 = 3.4641016151377546;
  const double rounding = sensor.disparity_step > 0 ? sensor.disparity_step / (root_of_12 * sensor.disparity_at_1) : 0;
  const double near = sensor.near, far = sensor.far, least_cosine = sensor.least_cosine;
  alignas(64) std::int64_t bits[together];
  alignas(64) double normal[together] = {}, seen[together];
  for (int first = 0; first < count; first += together) {
    const int some = count - first < together ? count - first : together;
    if (is_noisy) {
      const std::uint64_t key = sensor.key, pixel = sensor.first_number + static_cast<std::uint64_t>(first);
      for (int i = 0; i < together; ++i)
        bits[i] = static_cast<std::int64_t>(random_bits(key, pixel + static_cast<std::uint64_t>(i), for_noise));
      for (int i = 0; i < together; ++i) normal[i] = uniform_of_bits(bits[i]);
      alignas(64) double uniform[together];
      for (int i = 0; i < together; ++i) uniform[i] = normal[i];
      for (int i = 0; i < together; ++i) normal[i] = middle_quantile(uniform[i]);
      for (int i = 0; i < together; ++i)
        if (std::abs(uniform[i] - 0.5) > half_of_middle) normal[i] = outer_quantile(uniform[i]);
    }
    for (int i = 0; i < some; ++i) {
      const double z = depth[first + i], whole = a + z * (b + z * c), rounded = rounding * z * z;
      const double before = (whole - rounded) * (whole + rounded);
      seen[i] = z + (before > 0 ? std::sqrt(before) * normal[i] : 0);
    }
    if (sensor.disparity_step > 0) {
      const double step = sensor.disparity_step, at_1 = sensor.disparity_at_1;
      for (int i = 0; i < some; ++i) {
        const double disparity = step * std::floor(at_1 / seen[i] / step + 0.5);
        seen[i] = disparity > 0 ? at_1 / disparity : never;
      }
    }
    for (int i = 0; i < some; ++i) {
      const bool returns = depth[first + i] >= near && cosine[first + i] >= least_cosine && seen[i] >= near && seen[i] <= far;
      measured[first + i] = returns ? static_cast<float>(seen[i]) : no_return;
    }
  }
}

void find_points(const double* sights, const float* depth, int count, float* points) {
  for (int i = 0; i < count; ++i) {
    const double z = depth[i];
    points[3 * i] = static_cast<float>(sights[2 * i] * z);
    points[3 * i + 1] = static_cast<float>(sights[2 * i + 1] * z);
    points[3 * i + 2] = depth[i];
  }
}

constexpr PacketPasses all_passes() {
  return {turn,         meet_plane, ask,         meet_line,  meet_flat, meet_round,
          find_cosines, ask_hidden, find_checks, find_light, measure,   find_points};
}

}  // namespace
}  // namespace verlet_cable::view
