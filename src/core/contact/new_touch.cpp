#include "contact/new_touch.h"

#include "chain/direction.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

double stopping_stiffness_of(const SimulatedCable& cable, int segment, double time_step) {
  return stopping_stiffness(cable.state.rest_lengths[segment] * CableMaterials(cable)[segment].linear_density, time_step);
}

void put_beside(const CableState& state, const Vector3& normal, double distance, CablePoint& point) {
  const int i = point.segment;
  const std::vector<Vector3>& x = state.positions;
  const bool on_joint = point.fraction == 0 && i > 0;
  const Vector3 direction = on_joint ? way_past(state, i).normalized() : segment_direction(state, i);
  const double steep = normal.dot(direction), steep_square = steep * steep;
  const Vector3 along = direction - steep * normal;
  if (!(distance > 0) || along.isZero(0)) return;
  const double beside = distance * (1 - steep_square * steep_square) * (on_joint ? 0.5 : 1);
  point.along = along.normalized();
  point.across = (normal - steep * direction).normalized();
  point.own = beside / (x[i + 1] - x[i]).norm();
  if (on_joint) point.before = beside / (x[i] - x[i - 1]).norm();
}

double rolling_part(const MaterialDesc& material) {
  return material.torsional_stiffness > 0 ? 1 : material.rolling_friction;
}

void let_roll(double part, const Vector3& across, Touch& touch) {
  const double size = across.norm();
  if (part < 1 && size > 0) touch.rolling[touch.rolling_count++] = {across / size, part};
}

}  // namespace verlet_cable
