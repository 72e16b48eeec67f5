#pragma once

#include <cmath>
#include <functional>

#include "../support/scenes.h"
#include "validation.h"

/// Rods of length 1 m and EI = 1 N m^2 without gravity: forces and torques are numbers of the textbook's dimensionless form, and
/// times are in units of sqrt(mu L^4 / EI).
namespace verlet_cable::validation {

/// [s] Short, so that even slow motions of small amplitude are far faster than the solver's tolerance of 1e-6 segment lengths a
/// second; long enough that a rod's weight, to which the core scales the stiffness of what is inextensible, is not nothing.
constexpr double time_unit = 0.1;

inline MaterialDesc& material(SceneDesc& scene) {
  return scene.materials[0].material;
}

/// `time_step` in time units.
inline SceneDesc rod(int segments, double time_step) {
  SceneDesc scene = scenes::one_cable(segments);
  scene.time_step = time_step * time_unit;
  scene.gravity.acceleration.setZero();
  material(scene).linear_density = time_unit * time_unit;
  material(scene).bending_stiffness = 1;
  return scene;
}

/// [1/m] about the material's y and z axes, all along.
inline void bend_at_rest(SceneDesc& scene, double about_y, double about_z) {
  scene.cables[0].rest_curvature.type = RestCurvatureDesc::Type::constant;
  scene.cables[0].rest_curvature.curvature = {about_y, about_z};
}

/// Clamped at the origin, along +x.
inline void clamp_start(SceneDesc& scene) {
  scene.cables[0].attachments.push_back(
      scenes::attachment("start", PlaceDesc::At::start, Vector3::Zero(), "", AttachmentType::clamp));
}

/// Its start at the origin, its end in the frame "hand" at `x` on the axis.
inline void hold_ends(SceneDesc& scene, AttachmentType type, double x) {
  scene.cables[0].attachments = {scenes::attachment("start", PlaceDesc::At::start, Vector3::Zero(), "", type),
                                 scenes::attachment("end", PlaceDesc::At::end, Vector3::Zero(), "hand", type)};
  scene.cables[0].attachments[1].initial_pose = InitialPose{x, 0, 0, 0, 0, 0};
}

/// Starts through `point(s)`, s from 0 to 1, one point a node.
inline void start_at(SceneDesc& scene, const std::function<Vector3(double)>& point) {
  InitialShapeDesc& initial = scene.cables[0].initial;
  initial.type = InitialShapeDesc::Type::points;
  const int n = scene.cables[0].segments;
  for (int i = 0; i <= n; ++i) initial.points.push_back(point(static_cast<double>(i) / n));
}

/// The part of a run's `component` that goes as `shape(s)`: its projection, weighted with the nodes' masses.
inline std::function<double(const Simulation&)> projection(int component, const std::function<double(double)>& shape) {
  return [component, shape](const Simulation& run) {
    const int n = run.cable().state.segments();
    double sum = 0;
    for (int i = 0; i <= n; ++i)
      sum += run.cable().state.masses[i] * run.positions()[i][component] * shape(static_cast<double>(i) / n);
    return sum;
  };
}

/// Linear drag that takes `rate` off a velocity in a time unit.
inline void damp(SceneDesc& scene, double rate) {
  material(scene).drag = rate * time_unit;
}

/// Stiffness of the motion that `amplitude` measures, in a run that is overdamped: from its growth exp(sigma t) between two
/// times, sigma^2 + drag sigma + stiffness = 0. It vanishes where a rod buckles. Times and rates in time units.
inline double stiffness_from_growth(Simulation& run, const std::function<double(const Simulation&)>& amplitude, double from,
                                    double to) {
  run.run(from * time_unit - run.world.time());
  const double before = amplitude(run);
  run.run((to - from) * time_unit);
  const double sigma = std::log(std::abs(amplitude(run) / before)) / (to - from);
  return -sigma * (sigma + run.cable().model->material.drag / time_unit);
}

/// Where `stiffness(load)` vanishes: the secant method, from 2 % on both sides of `expected`.
inline double critical_load(const std::function<double(double)>& stiffness, double expected) {
  constexpr int secants = 2;
  double x0 = 0.98 * expected, x1 = 1.02 * expected, y0 = stiffness(x0), y1 = stiffness(x1);
  const auto zero = [&] { return x1 - y1 * (x1 - x0) / (y1 - y0); };
  for (int i = 0; i < secants; ++i) {
    const double x = zero(), y = stiffness(x);
    if (std::abs(y0) < std::abs(y1)) {
      x1 = x0;
      y1 = y0;
    }
    x0 = x;
    y0 = y;
  }
  return zero();
}

}  // namespace verlet_cable::validation
