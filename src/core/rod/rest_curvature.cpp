#include "rod/rest_curvature.h"

#include <algorithm>

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

void set_rest_curvature(const RestCurvatureDesc& desc, const std::vector<DirectionTarget>& clamps, CableState& state) {
  const int n = state.segments();
  if (desc.type == RestCurvatureDesc::Type::straight) return;
  state.rest_curvature.assign(n + 1, desc.curvature);
  if (desc.type == RestCurvatureDesc::Type::constant) return;
  if (desc.type == RestCurvatureDesc::Type::profile) return spread(desc.profile, state);
  const std::vector<Quaternion> orientations = segment_orientations(state);
  for (int i = 1; i < n; ++i) {
    const Vector3 before = orientations[i - 1] * Vector3::UnitX(), after = orientations[i] * Vector3::UnitX();
    const Quaternion middle = orientations[i - 1].slerp(0.5, orientations[i]);
    const Vector3 curvature = (after - before) / (0.5 * (state.rest_lengths[i - 1] + state.rest_lengths[i]));
    state.rest_curvature[i] = {-curvature.dot(middle * Vector3::UnitZ()), curvature.dot(middle * Vector3::UnitY())};
  }
  for (const DirectionTarget& clamp : clamps) {
    if (clamp.node != 0 && clamp.node != n) continue;
    const int i = clamp.node == 0 ? 0 : n - 1;
    const Vector3 along = orientations[i] * Vector3::UnitX(), axis = clamp.orientation * Vector3::UnitX();
    const Vector3 curvature = (clamp.node == 0 ? along - axis : axis - along) / (0.5 * state.rest_lengths[i]);
    state.rest_curvature[clamp.node] = {-curvature.dot(orientations[i] * Vector3::UnitZ()),
                                        curvature.dot(orientations[i] * Vector3::UnitY())};
  }
}

}  // namespace verlet_cable
