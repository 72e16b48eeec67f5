#include "rod/clamp_joint.h"

#include "geometry/eigen_vectors.h"
#include "law/bend.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// With q = d / l, its length r and the unit axis a, the energy is EI / l psi(u), u = |q - r a|^2 / 2 = r^2 - r c, c = q . a. Its
/// change over the substep is that of u times a mean slope, and
///   u' - u = ((2 - mean c / mean r) mean q - mean r mean a) . (q' - q) - mean r mean q . (a' - a),
/// which gives the mean moments that keep the energy. Only what is across the axis is damped.
void bend_elastic_clamp(double part, const Vector3& change, ClampJoint& clamp) {
  const Vector3 start = clamp.start_direction, end = start + change, axis_change = clamp.end_axis - clamp.start_axis;
  const Vector3 direction = start + part * change, axis = clamp.start_axis + part * axis_change;
  const auto at_part = [part](double from, double to) { return from + part * (to - from); };
  const double stretch = at_part(start.norm(), end.norm());
  const double along = at_part(start.dot(clamp.start_axis), end.dot(clamp.end_axis));
  const double slope =
      clamp.stiffness * mean_slope(0.5 * clamp.start_square, 0.5 * (end - end.norm() * clamp.end_axis).squaredNorm());
  clamp.slope = slope * (2 - along / stretch);
  const Vector3 bending = change - stretch * axis_change - clamp.angle * clamp.turn;
  const Vector3 damping = clamp.damping * (bending - axis * (axis.dot(bending) / axis.squaredNorm()));
  clamp.moment = clamp.slope * direction - slope * stretch * axis + damping;
  clamp.torque = axis.cross(slope * stretch * direction + damping) + damping.dot(clamp.turn) * clamp.end_axis;
  clamp.damping_work = damping.dot(bending);
}

}  // namespace

void find_clamp_joints(const CableModel& model, const CableState& state, const std::vector<HeldDirection>& directions,
                       const std::function<Vector3(int)>& segment_at, double h, double part, std::vector<ClampJoint>& joints) {
  const CableMaterials materials(model, state);
  joints.clear();
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const HeldDirection& target = directions[k];
    const Vector3 start_axis = target.start * Vector3::UnitX(), end_axis = target.end * Vector3::UnitX();
    for (const int i : {target.node - 1, target.node}) {
      if (i < 0 || i >= state.segments()) continue;
      ClampJoint clamp;
      clamp.target = static_cast<int>(k);
      clamp.segment = i;
      clamp.inverse_length = 1 / state.rest_lengths[i];
      const double joint = 1 / state.bending_length(target.node, 0.5 * state.rest_lengths[i]);
      clamp.is_elastic = is_elastic(materials[i]);
      clamp.stiffness = materials[i].bending_stiffness.largest() * joint;
      clamp.damping = materials[i].bending_damping / h * joint;
      clamp.start_axis = start_axis;
      clamp.end_axis = end_axis;
      clamp.start_direction = clamp.inverse_length * segment_at(i);
      const double stretch = clamp.start_direction.norm();
      clamp.start = clamp.start_direction - stretch * start_axis;
      clamp.start_square = clamp.start.squaredNorm();
      clamp.axis_change = stretch * (end_axis - start_axis);
      clamp.middle_axis = stretch * start_axis + part * clamp.axis_change;
      joints.push_back(clamp);
    }
  }
}

void bend_clamp(double part, const Vector3& displacement, ClampJoint& clamp) {
  const Vector3 direction_change = clamp.inverse_length * displacement;
  if (clamp.is_elastic) return bend_elastic_clamp(part, direction_change, clamp);
  const Vector3 change = direction_change - clamp.axis_change;
  const VectorOf<double> numbers = numbers_of(change);
  const Bend<double> joint = bend(clamp.stiffness, numbers_of(clamp.start), clamp.start_square, numbers, part);
  const BendDamping<double> damper{clamp.damping, numbers_of(clamp.angle * clamp.turn), {0, 0, 0}};
  const Vector3 damping = vector_of(damper.moment(numbers, 0));
  clamp.slope = joint.slope;
  clamp.moment = vector_of(joint.moment) + damping;
  clamp.damping_work = damper.loss(numbers, 0);
  // The energy depends on the axis a through d / l - a: the torque on the axis is a x moment.
  clamp.torque = clamp.middle_axis.cross(clamp.moment) + damping.dot(clamp.turn) * clamp.end_axis;
}

}  // namespace verlet_cable
