#include "start.h"

#include <algorithm>

namespace verlet_cable::cable_fit {
namespace {

constexpr int points_between = 6;        ///< of a smooth curve, from one marker to the next
constexpr double least_distance = 1e-6;  ///< [m] markers at one place do not stop a curve

Vector3 offset(const Markers& markers, const std::vector<Quaternion>& orientations, std::size_t marker) {
  const int segment = place_on(static_cast<int>(orientations.size()), markers.places[marker]).segment;
  return orientations[segment] * Vector3(0, markers.offsets[marker][0], markers.offsets[marker][1]);
}

/// Values at points along a curve, and between them by a Catmull-Rom spline.
std::vector<Vector3> smooth(const std::vector<double>& along, const std::vector<Vector3>& values) {
  FrameTrack curve;
  for (std::size_t i = 0; i < values.size(); ++i) curve.add(along[i], {values[i], Quaternion::Identity()});
  std::vector<Vector3> result{values.front()};
  for (std::size_t i = 1; i < values.size(); ++i)
    for (int k = 1; k <= points_between; ++k)
      result.push_back(curve.at(along[i - 1] + (along[i] - along[i - 1]) * k / points_between).position);
  return result;
}

/// The scene with the cable's length brought within what it allows of its start.
SceneDesc with_allowed_length(SceneDesc scene) {
  allow_length(scene.cables.front());
  return scene;
}

}  // namespace

SegmentPlace place_on(int segments, double place) {
  const int segment = std::min(static_cast<int>(place * segments), segments - 1);
  return {segment, place * segments - segment};
}

void start_smoothly(const std::vector<Vector3>& points, const std::vector<Vector3>& velocities, InitialShapeDesc& initial) {
  std::vector<double> along{0};
  for (std::size_t i = 1; i < points.size(); ++i)
    along.push_back(along.back() + std::max((points[i] - points[i - 1]).norm(), least_distance));
  initial.points = smooth(along, points);
  initial.velocities = smooth(along, velocities);
}

void allow_length(CableDesc& cable) {
  const double start = distances_along(cable.initial.points).back();
  cable.length = std::clamp(cable.length, start / (1 + start_tolerance), start / (1 - start_tolerance));
}

std::vector<Vector3> marker_positions(const SimulatedCable& cable, const Markers& markers) {
  const std::vector<Vector3>& nodes = cable.state.positions;
  std::vector<Vector3> positions;
  for (const double marker : markers.places) {
    const SegmentPlace place = place_on(cable.state.segments(), marker);
    positions.emplace_back((1 - place.fraction) * nodes[place.segment] + place.fraction * nodes[place.segment + 1]);
  }
  if (markers.offsets.empty()) return positions;
  const std::vector<Quaternion> orientations = segment_orientations(cable.state);
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += offset(markers, orientations, i);
  return positions;
}

void start_along(const Markers& markers, const Recording& recording, const BoundaryInputs& inputs, bool smooth,
                 SceneDesc& scene) {
  InitialShapeDesc& initial = scene.cables.front().initial;
  initial.type = InitialShapeDesc::Type::points;
  initial.points = recording.markers.front();
  initial.velocities = initial_velocities(recording);
  std::vector<Vector3> points = initial.points;
  const std::vector<Vector3> velocities = initial.velocities;
  if (smooth || !markers.offsets.empty()) start_smoothly(points, velocities, initial);
  if (!markers.offsets.empty()) {
    const World along_markers(with_allowed_length(scene), inputs);
    const std::vector<Quaternion> orientations = segment_orientations(along_markers.cables().front().state);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] -= offset(markers, orientations, i);
    start_smoothly(points, velocities, initial);
  }
  scene = with_allowed_length(std::move(scene));
}

}  // namespace verlet_cable::cable_fit
