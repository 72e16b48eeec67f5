#include "recording.h"

#include <algorithm>
#include <utility>

#include "verlet_cable/core/rotation.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr double doubled_back = -0.5;  ///< cosine of the turn behind a held end: 120 degrees

/// Orientations whose x axes are the directions, each turned as little as possible from the one before, the first from the usual
/// one.
void carry_along(const Recording& recording, int from, int to, int origin, const Vector3& usual, FrameTrack& track) {
  Vector3 last = usual;
  Quaternion orientation = smallest_rotation(Vector3::UnitX(), usual);
  for (int row = 0; row < recording.rows(); ++row) {
    const std::vector<Vector3>& markers = recording.markers[row];
    const Vector3 direction = (markers[to] - markers[from]).normalized();
    orientation = (smallest_rotation(last, direction) * orientation).normalized();
    last = direction;
    track.add(recording.times[row], {markers[origin], orientation});
  }
}

}  // namespace

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

const char* swapped_text(const SwappedEnds& swapped) {
  if (swapped.start && swapped.end) return "the first two and the last two";
  return swapped.start ? "the first two" : swapped.end ? "the last two" : "none";
}

SwappedEnds swapped_ends(const Recording& recording) {
  const int last = recording.marker_count() - 1;
  const auto doubles_back = [&](int outer, int inner, int next) {
    int rows = 0;
    for (const std::vector<Vector3>& markers : recording.markers) {
      const Vector3 held = (markers[inner] - markers[outer]).normalized();
      if (held.dot((markers[next] - markers[inner]).normalized()) < doubled_back) ++rows;
    }
    return 2 * rows > recording.rows();
  };
  return {doubles_back(0, 1, 2), doubles_back(last, last - 1, last - 2)};
}

Recording in_order(Recording recording, const SwappedEnds& swapped) {
  for (std::vector<Vector3>& markers : recording.markers) {
    if (swapped.start) std::swap(markers[0], markers[1]);
    if (swapped.end) std::swap(markers[markers.size() - 1], markers[markers.size() - 2]);
  }
  return recording;
}

std::vector<double> distances_along(const std::vector<Vector3>& points) {
  std::vector<double> distances{0};
  for (std::size_t i = 1; i < points.size(); ++i) distances.push_back(distances.back() + (points[i] - points[i - 1]).norm());
  return distances;
}

double measured_length(const Recording& recording) {
  std::vector<double> lengths;
  for (const std::vector<Vector3>& markers : recording.markers) lengths.push_back(distances_along(markers).back());
  return median(std::move(lengths));
}

std::vector<double> marker_places(const std::vector<const Recording*>& recordings) {
  std::vector<double> places{0};
  for (int i = 1; i < recordings.front()->marker_count(); ++i) {
    std::vector<double> distances;
    for (const Recording* recording : recordings)
      for (const std::vector<Vector3>& markers : recording->markers) distances.push_back((markers[i] - markers[i - 1]).norm());
    places.push_back(places.back() + median(std::move(distances)));
  }
  const double length = places.back();
  for (double& place : places) place /= length;
  return places;
}

std::vector<Vector3> initial_velocities(const Recording& recording) {
  std::vector<Vector3> velocities;
  const double interval = recording.times[1] - recording.times[0];
  for (int i = 0; i < recording.marker_count(); ++i)
    velocities.emplace_back((recording.markers[1][i] - recording.markers[0][i]) / interval);
  return velocities;
}

HeldDirections usual_directions(const std::vector<const Recording*>& recordings) {
  HeldDirections sums{Vector3::Zero(), Vector3::Zero()};
  for (const Recording* recording : recordings) {
    const int last = recording->marker_count() - 1;
    for (const std::vector<Vector3>& markers : recording->markers) {
      sums[0] += (markers[1] - markers[0]).normalized();
      sums[1] += (markers[last] - markers[last - 1]).normalized();
    }
  }
  for (Vector3& sum : sums) sum = sum.norm() > 0 ? Vector3(sum.normalized()) : Vector3(Vector3::UnitX());
  return sums;
}

HeldEnds held_ends(const Recording& recording, const HeldDirections& usual) {
  const int last = recording.marker_count() - 1;
  HeldEnds ends;
  carry_along(recording, 0, 1, 0, usual[0], ends.start);
  carry_along(recording, last - 1, last, last, usual[1], ends.end);
  return ends;
}

}  // namespace verlet_cable::cable_fit
