#pragma once

#include "law/bend.h"
#include "law/resistance.h"
#include "law/stretch.h"
#include "sensitivity/dual.h"

namespace verlet_cable {

/// What a plain cable (straight unloaded, and as stiff about one axis as about any other) consists of over a substep, for numbers
/// with and without derivatives: segments, joints between them, and joints between clamps and the segments beside them. As
/// CableStepper, Bending and ClampJoint have them. `start`: d of a segment at the start [m], `change`: of it over the substep;
/// `part`: where in the substep forces are taken, 1/2 or 1.

template <class Real>
VectorOf<Real> zero_vector() {
  return {Real{}, Real{}, Real{}};
}
template <class Real>
Real norm(const VectorOf<Real>& v) {
  return root(dot(v, v));
}
template <class Real>
VectorOf<Real> normalized(const VectorOf<Real>& v) {
  return (1.0 / norm(v)) * v;
}

template <class Real>
struct PlainSegment {
  bool is_elastic = false;
  Real rest_length{};                       ///< [m]
  Real axial_stiffness{}, axial_damping{};  ///< EA [N], and in the time of the substep [N]
  Real compliance{};                        ///< [m^3/N] of what cannot stretch, where two holders hold it
};

template <class Real>
struct Stretching {
  VectorOf<Real> force;  ///< [N] on its first node, of its tension
  LengthRow<Real> row;
  Real mean;  ///< [m] the length that the density is multiplied with to give the tension
};

template <class Real>
Stretching<Real> stretching(const PlainSegment<Real>& segment, const VectorOf<Real>& start, const VectorOf<Real>& change,
                            const Real& density, double part) {
  const VectorOf<Real> end = start + change;
  const VectorOf<Real> force = density * (start + (Real{} + part) * change);
  if (!segment.is_elastic)
    return {force, inextensible_row(dot(end, end), segment.rest_length, segment.compliance, density), segment.rest_length};
  const Real start_length = norm(start), end_length = norm(end), mean = start_length + part * (end_length - start_length);
  const Resistance<Real> resistance{segment.axial_stiffness / segment.rest_length, segment.axial_damping / segment.rest_length};
  const Real tension = resistance.stress(mean - segment.rest_length, end_length - start_length);
  return {force, elastic_row(tension, resistance.slope(part), density, mean, end_length, part), mean};
}

/// Between two segments.
template <class Real>
struct PlainJoint {
  Real stiffness{}, damping{};                  ///< EI / l, and likewise in the time of the substep [N m]
  Real inverse_before{}, inverse_after{};       ///< [1/m] of the rest lengths of the segments
  VectorOf<Real> turned = zero_vector<Real>();  ///< see BendDamping
};

template <class Real>
VectorOf<Real> bend_of(const PlainJoint<Real>& joint, const VectorOf<Real>& before, const VectorOf<Real>& after) {
  return joint.inverse_after * after - joint.inverse_before * before;
}

/// `start`, `change`: of the difference of directions, see `bend_of`.
template <class Real>
Bend<Real> joint_bend(const PlainJoint<Real>& joint, const VectorOf<Real>& start, const VectorOf<Real>& change, const Real& share,
                      double part) {
  Bend<Real> result = bend(joint.stiffness, start, dot(start, start), change, part);
  const BendDamping<Real> damper{joint.damping, zero_vector<Real>(), joint.turned};
  result.moment = result.moment + damper.moment(change, share);
  return result;
}

/// Between a clamp and a segment beside it. Nothing turns the material in the clamp.
template <class Real>
struct PlainClamp {
  int direction = 0;  ///< index of the held direction
  int segment = 0;
  bool is_elastic = false;
  Real inverse_length{};                                                            ///< [1/m]
  Real stiffness{}, damping{};                                                      ///< as of joints
  VectorOf<Real> start_axis = zero_vector<Real>(), end_axis = zero_vector<Real>();  ///< unit vectors
};

template <class Real>
struct ClampBend {
  VectorOf<Real> moment;  ///< [N m] on the segment's direction
  VectorOf<Real> torque;  ///< [N m] on the clamp
  Real stiffness;         ///< [N/m] of the segment's nodes against each other
};

template <class Real>
ClampBend<Real> clamp_bend(const PlainClamp<Real>& clamp, const VectorOf<Real>& segment_start,
                           const VectorOf<Real>& segment_change, double part) {
  const Real at_part = Real{} + part;
  const VectorOf<Real> start = clamp.inverse_length * segment_start, change = clamp.inverse_length * segment_change;
  const VectorOf<Real> axis_change = clamp.end_axis - clamp.start_axis;
  const Real start_stretch = norm(start);
  const VectorOf<Real> start_bend = start - start_stretch * clamp.start_axis;
  const Real square_of_length = clamp.inverse_length * clamp.inverse_length;
  if (!clamp.is_elastic) {
    const VectorOf<Real> bending = change - start_stretch * axis_change;
    const Bend<Real> joint = bend(clamp.stiffness, start_bend, dot(start_bend, start_bend), bending, part);
    const VectorOf<Real> moment = joint.moment + clamp.damping * bending;
    const VectorOf<Real> axis = start_stretch * (clamp.start_axis + at_part * axis_change);
    return {moment, cross(axis, moment), (part * joint.slope + clamp.damping) * square_of_length};
  }
  const VectorOf<Real> end = start + change;
  const VectorOf<Real> direction = start + at_part * change, axis = clamp.start_axis + at_part * axis_change;
  const auto mean = [part](const Real& from, const Real& to) { return from + part * (to - from); };
  const Real end_stretch = norm(end), stretch = mean(start_stretch, end_stretch);
  const Real along = mean(dot(start, clamp.start_axis), dot(end, clamp.end_axis));
  const VectorOf<Real> end_bend = end - end_stretch * clamp.end_axis;
  const Real slope = clamp.stiffness * mean_slope<Real>(0.5 * dot(start_bend, start_bend), 0.5 * dot(end_bend, end_bend));
  const Real slope_along = slope * (2.0 - along / stretch);
  const VectorOf<Real> bending = change - stretch * axis_change;
  const VectorOf<Real> damping = clamp.damping * (bending - (dot(axis, bending) / dot(axis, axis)) * axis);
  const VectorOf<Real> torque = cross(axis, slope * stretch * direction + damping);
  return {slope_along * direction - slope * stretch * axis + damping, torque,
          (part * slope_along + clamp.damping) * square_of_length};
}

}  // namespace verlet_cable
