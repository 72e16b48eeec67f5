#include "rod/rest_curvature.h"

#include <algorithm>

#include "rod/rod_frames.h"

namespace verlet_cable {

namespace {

/// The profile's places are spread evenly over the cable's rest length.
void spread(const std::vector<std::array<double, 2>>& profile, CableModel& model) {
  const std::vector<double> arc_length = model.arc_length();
  const int last = static_cast<int>(profile.size()) - 1;
  for (int i = 0; i < model.nodes(); ++i) {
    const double place = arc_length[i] / arc_length.back() * last;
    const int before = std::min(static_cast<int>(place), last - 1);
    for (int axis = 0; axis < 2; ++axis)
      model.rest_curvature[i][axis] =
          profile[before][axis] + (place - before) * (profile[before + 1][axis] - profile[before][axis]);
  }
}

}  // namespace

void set_rest_shape(const CableDesc& desc, CableModel& model) {
  using Type = RestCurvatureDesc::Type;
  const std::size_t nodes = model.nodes();
  if (desc.rest_twist != 0) model.rest_twist.assign(nodes, desc.rest_twist);
  // What does not resist bending has no shape.
  if (desc.rest_curvature.is_straight() || !(model.material.bending_stiffness.largest() > 0)) return;
  model.rest_curvature.assign(nodes, desc.rest_curvature.curvature);
  if (desc.rest_curvature.type == Type::profile) spread(desc.rest_curvature.profile, model);
}

void take_rest_curvature(const std::vector<DirectionTarget>& clamps, SimulatedCable& cable) {
  CableModel& model = cable.model;
  const int n = model.segments();
  const auto take = [&](int node, double length, const JointAngles& angles) {
    const double bending = model.bending_length(node, length);
    model.rest_curvature[node] = {angles.y / bending, angles.z / bending};
  };
  for (int i = 1; i < n; ++i) take(i, joint_length(model, i), joint_angles_at(cable.state, i));
  // A free end is curved as its neighbour.
  if (n > 1) {
    model.rest_curvature[0] = model.rest_curvature[1];
    model.rest_curvature[n] = model.rest_curvature[n - 1];
  }
  for (const DirectionTarget& clamp : clamps) {
    const Eigen::Matrix3d held = clamp.orientation.toRotationMatrix();
    if (clamp.node == 0)
      take(0, joint_length(model, 0), joint_angles(held, segment_frame(cable.state, 0), cable.state.joint_twist[0]));
    if (clamp.node == n)
      take(n, joint_length(model, n), joint_angles(segment_frame(cable.state, n - 1), held, cable.state.joint_twist[n]));
  }
}

}  // namespace verlet_cable
