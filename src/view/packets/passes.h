#pragma once

#include <embree3/rtcore.h>

#include <cstdint>

#include "packets/line_law.h"
#include "packets/packet.h"

namespace verlet_cable::view {

/// What a plane, or a flat surface, is for all rays from the eye.
struct PlaneNumbers {
  double normal[3];  ///< unit
  double height;     ///< [m] of the plane above the eye, along the normal
};

struct PaintNumbers {
  double color[3], second_color[3];  ///< in proportion to light
  double shininess;
};

/// Squares on a surface, as `checks_at` has them.
struct CheckNumbers {
  double x_axis[3], y_axis[3];  ///< of the surface, unit
  double x, y;                  ///< [m] of the eye on it
  double size;                  ///< [m]
  double footprint;             ///< [1] of a pixel at t = 1
};

struct LightNumbers {
  double to_sun[3];  ///< unit
  double ambient;    ///< 0 to 1
};

/// What a sensor does to depth.
struct SensorNumbers {
  double axial[3];
  double near, far;            ///< [m]
  double least_cosine;         ///< of what returns anything; 0: all that both imagers see
  double disparity_at_1;       ///< [pixels]
  double disparity_step;       ///< [pixels] 0: none
  std::uint64_t key;           ///< of the random numbers
  std::uint64_t first_number;  ///< of the row
};

/// The arithmetic of many pixels at once, compiled for several widths of vectors, all of which give the same bytes. All rays
/// begin at the eye unless something else is said, and `direction` has any length.
struct PacketPasses {
  /// Directions of lines of sight: `axes` (columns of the optical frame's axes) times (x, y, 1).
  void (*turn)(const double* axes, const Lanes& x, const Lanes& y, VectorLanes& direction);
  /// Where rays meet a plane, which is below them, from its outside, nearer than `t`; these are given `index`.
  void (*meet_plane)(const PlaneNumbers& plane, int index, const VectorLanes& direction, Lanes& t, Lanes& nearest);
  /// Fills a query of Embree with all rays. `start`: [m] of the eye in Embree's scene; `highest`: t at which they end.
  void (*ask)(const double* start, const VectorLanes& direction, const Lanes& highest, RTCRayHit16& query);
  /// What Embree asks of a line: t of the first meetings of `count` (4, 8 or 16) rays, and whether any of them meets it; is
  /// `from_inside` where that has to be looked at otherwise. `shift` [m]: from the line's start to the origin of Embree's scene.
  bool (*meet_line)(const LineNumbers& line, const double* shift, RTCRayN* asked, unsigned count, double* t);
  /// t and normals of a flat surface that faces the eye, and of lines. Where single precision has met what double precision just
  /// misses, t is as Embree has it (`about`), and the surface faces the ray.
  void (*meet_flat)(const PlaneNumbers& surface, const Viewers& viewers, const VectorLanes& direction, const Lanes& about,
                    Lanes& t, VectorLanes& normal);
  void (*meet_round)(const LineLanes& lines, const VectorLanes& direction, const Lanes& about, Lanes& t, VectorLanes& normal);
  /// Cosines of the angles between lines of sight and normals.
  void (*find_cosines)(const VectorLanes& direction, const VectorLanes& normal, Lanes& cosine);
  /// Fills a query of Embree with rays from just in front of what is seen, which end at `aim` [m] from the eye where `is_place`,
  /// or go along it far away. `gap` [m] and of t: how much in front.
  void (*ask_hidden)(const double* start, const double* aim, bool is_place, double gap, double gap_of_t,
                     const VectorLanes& direction, const Lanes& t, const VectorLanes& normal, RTCRay16& query);
  /// How much of the second color of checks there is.
  void (*find_checks)(const CheckNumbers& checks, const Viewers& viewers, const VectorLanes& direction, const Lanes& t,
                      const Lanes& cosine, Lanes& second);
  /// The light that comes from a surface, in proportion, in steps of 1 / `last_step_of_light`: red, green and blue of all rays.
  /// `second`: how much of the paint's second color there is, 0 to 1; `is_lit`: 1 where the sun reaches it, otherwise 0.
  void (*find_light)(const LightNumbers& light, const PaintNumbers& paint, const Viewers& viewers, const Lanes& second,
                     const Lanes& is_lit, const VectorLanes& direction, const VectorLanes& normal, int* steps);
  /// Measures a row of depths. `cosine`: below 0 where the second imager sees nothing.
  void (*measure)(const SensorNumbers& sensor, const float* depth, const float* cosine, int count, float* measured);
  /// Points of a row of depths: `sights` has x and y at the depth 1 of each pixel.
  void (*find_points)(const double* sights, const float* depth, int count, float* points);
};

constexpr int last_step_of_light = 4095;

/// For vectors of 2, 4 and 8 numbers. They may only be called where the processor has such.
const PacketPasses& passes_of_2();
const PacketPasses& passes_of_4();
const PacketPasses& passes_of_8();

/// Those that are fastest on this machine.
const PacketPasses& packet_passes();

}  // namespace verlet_cable::view
