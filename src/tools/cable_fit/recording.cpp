#include "recording.h"

#include <algorithm>
#include <utility>

#include "verlet_cable/core/rotation.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr double doubled_back = -0.5;  ///< cosine of the turn behind a held end: 120 degrees

constexpr double turned_round = -0.5;  ///< cosine of the angle to the usual direction: 120 degrees

/// [m] the directions from one marker to another, a row.
std::vector<Vector3> directions(const Recording& recording, int from, int to) {
  std::vector<Vector3> directions;
  for (const std::vector<Vector3>& markers : recording.markers)
    directions.emplace_back((markers[to] - markers[from]).normalized());
  return directions;
}

/// Each turned as little as possible from the one before, the first one from the usual one.
std::vector<Quaternion> carried_along(const std::vector<Vector3>& directions, const Vector3& usual) {
  std::vector<Quaternion> orientations;
  Vector3 last = usual;
  Quaternion orientation = smallest_rotation(Vector3::UnitX(), usual);
  for (const Vector3& direction : directions) {
    orientation = (smallest_rotation(last, direction) * orientation).normalized();
    last = direction;
    orientations.push_back(orientation);
  }
  return orientations;
}

FrameTrack track_of(const Recording& recording, int origin, const std::vector<Quaternion>& orientations) {
  FrameTrack track;
  for (int row = 0; row < recording.rows(); ++row)
    track.add(recording.times[row], {recording.markers[row][origin], orientations[row]});
  return track;
}

}  // namespace

std::vector<Quaternion> held_orientations(const std::vector<Vector3>& directions, const Vector3& usual) {
  // A hand that has swung round and comes back to a direction has the roll that it had there, which it would not have if each
  // row followed the one before. Opposite to the usual direction there is no smallest turn: a hand that comes near it is
  // carried along.
  const auto turns_round = [&](const Vector3& direction) { return direction.dot(usual) < turned_round; };
  if (std::any_of(directions.begin(), directions.end(), turns_round)) return carried_along(directions, usual);
  const Quaternion upright = smallest_rotation(Vector3::UnitX(), usual);
  std::vector<Quaternion> orientations;
  for (const Vector3& direction : directions)
    orientations.push_back((smallest_rotation(usual, direction) * upright).normalized());
  return orientations;
}

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

HeldEnds held_ends(const Recording& recording) {
  const int last = recording.marker_count() - 1;
  const auto carried = [&](int from, int to) { return carried_along(directions(recording, from, to), Vector3::UnitX()); };
  return {track_of(recording, 0, carried(0, 1)), track_of(recording, last, carried(last - 1, last))};
}

HeldEnds held_ends(const Recording& recording, const HeldDirections& usual) {
  const int last = recording.marker_count() - 1;
  return {track_of(recording, 0, held_orientations(directions(recording, 0, 1), usual[0])),
          track_of(recording, last, held_orientations(directions(recording, last - 1, last), usual[1]))};
}

}  // namespace verlet_cable::cable_fit
