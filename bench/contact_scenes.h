#pragma once

#include <string>

#include "verlet_cable/core/world.h"

/// Scenes of contact that the benchmarks measure.
namespace verlet_cable::bench {

constexpr double contact_radius = 0.005;  // [m] of all cables

/// A light elastic cable around a cylinder by an angle [rad]; frames "first" and "second" hold its ends, `capstan_arm` from it.
constexpr double capstan_arm = 0.25;  // [m]
SceneDesc capstan(double friction, double angle, int segments);
/// The directions in which the cable leaves the capstan at its ends, unit.
Vector3 capstan_first_pull();
Vector3 capstan_second_pull(double angle);

/// A cable of 1 m above an obstacle on a floor; which way and how high follows from `number`.
SceneDesc drop(ShapeType type, int number);

/// A cable that lies in coils above a floor, 1 cm a segment.
SceneDesc coils(int segments, bool contact);
/// Cables of 1 m above each other, crosswise, above a floor.
SceneDesc crosswise(int cables, int segments);

/// An overhand knot, loose, held at both ends by frames "first" and "second".
SceneDesc overhand_knot(double friction, int segments);

}  // namespace verlet_cable::bench
