#include "rod/rest_curvature.h"

#include <algorithm>

#include "rod/rod_frames.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// The profile's places are spread evenly over the cable's rest length.
void spread(const std::vector<std::array<double, 2>>& profile, CableState& state) {
  const std::vector<double> arc_length = state.arc_length();
  const int last = static_cast<int>(profile.size()) - 1;
  for (int i = 0; i < state.nodes(); ++i) {
    const double place = arc_length[i] / arc_length.back() * last;
    const int before = std::min(static_cast<int>(place), last - 1);
    for (int axis = 0; axis < 2; ++axis)
      state.rest_curvature[i][axis] =
          profile[before][axis] + (place - before) * (profile[before + 1][axis] - profile[before][axis]);
  }
}

}  // namespace

void set_rest_shape(const CableDesc& desc, const CableModel& model, CableState& state) {
  using Type = RestCurvatureDesc::Type;
  const std::size_t nodes = state.nodes();
  if (desc.rest_twist != 0) state.rest_twist.assign(nodes, desc.rest_twist);
  // What does not resist bending has no shape.
  if (desc.rest_curvature.is_straight() || !CableMaterials(model, state).any_bends()) return;
  state.rest_curvature.assign(nodes, desc.rest_curvature.curvature);
  if (desc.rest_curvature.type == Type::profile) spread(desc.rest_curvature.profile, state);
}

void take_rest_curvature(const std::vector<DirectionTarget>& clamps, CableState& state) {
  const int n = state.segments();
  const auto take = [&](int node, const JointAngles& angles) {
    const double bending = state.bending_length(node, joint_length(state, node));
    state.rest_curvature[node] = {angles.y / bending, angles.z / bending};
  };
  for (int i = 1; i < n; ++i) take(i, joint_angles_at(state, i));
  // A free end is curved as its neighbour.
  if (n > 1) {
    state.rest_curvature[0] = state.rest_curvature[1];
    state.rest_curvature[n] = state.rest_curvature[n - 1];
  }
  for (const DirectionTarget& clamp : clamps) {
    const Eigen::Matrix3d held = clamp.orientation.toRotationMatrix();
    if (clamp.node == 0) take(0, joint_angles(held, segment_frame(state, 0), state.joint_twist[0]));
    if (clamp.node == n) take(n, joint_angles(segment_frame(state, n - 1), held, state.joint_twist[n]));
  }
}

}  // namespace verlet_cable
