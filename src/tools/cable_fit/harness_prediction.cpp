#include "harness_prediction.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "start.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/rotation.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_fit {
namespace {

/// [m] Flicker: a place that is so far off those midway between the places as many rows before and after, up to so many.
constexpr double flicker = 0.003;
constexpr int flicker_rows = 5;
/// [m/s] between neighbouring markers, along the cable.
constexpr double jump_speed = 0.1;
/// Sine of the angle below which two directions span no plane.
constexpr double same_direction = 1e-3;

/// Motion along a line has no midway place off it, however fast it is: the median counts, as some of them flicker themselves.
bool flickers(const Recording& recording, int row, int marker) {
  const int rows = std::min({flicker_rows, row, recording.rows() - 1 - row});
  if (rows == 0) return false;
  Vector3 middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> midway;
    for (int k = 1; k <= rows; ++k)
      midway.push_back(0.5 * (recording.markers[row - k][marker][axis] + recording.markers[row + k][marker][axis]));
    middle[axis] = median(std::move(midway));
  }
  return (recording.markers[row][marker] - middle).norm() > flicker;
}

/// With such places on the line between the nearest others.
Recording without_flicker(const Recording& recording) {
  Recording result = recording;
  for (int marker = 0; marker < recording.marker_count(); ++marker) {
    int good = 0;
    for (int row = 1; row < recording.rows(); ++row) {
      if (flickers(recording, row, marker)) continue;
      const Vector3 from = recording.markers[good][marker], to = recording.markers[row][marker];
      for (int between = good + 1; between < row; ++between) {
        const double part = (recording.times[between] - recording.times[good]) / (recording.times[row] - recording.times[good]);
        result.markers[between][marker] = from + part * (to - from);
      }
      good = row;
    }
  }
  return result;
}

std::string hold_name(std::size_t hold) {
  return "hold_" + std::to_string(hold);
}

/// In the direction that two markers give at an end, else the one in which the cable is at first.
FrameTrack track_of(const HarnessHold& hold, const Vector3& usual, const Recording& input) {
  std::vector<Vector3> directions;
  const bool follows = hold.second >= 0;
  const int from = follows ? std::min(hold.marker, hold.second) : hold.marker - 1;
  const int to = follows ? std::max(hold.marker, hold.second) : hold.marker + 1;
  for (int row = 0; row < input.rows(); ++row) {
    const std::vector<Vector3>& markers = input.markers[follows ? row : 0];
    directions.emplace_back((markers[to] - markers[from]).normalized());
  }
  const std::vector<Quaternion> orientations = held_orientations(directions, follows ? usual : directions.front());
  FrameTrack track;
  for (int row = 0; row < input.rows(); ++row) track.add(input.times[row], {input.markers[row][hold.marker], orientations[row]});
  return track;
}

Motion motion_of(const HarnessSettings& settings, const Recording& input) {
  const std::vector<HarnessHold> holds = holds_of(settings.harness);
  Motion motion;
  for (std::size_t i = 0; i < holds.size(); ++i)
    motion.emplace(hold_name(i), track_of(holds[i], settings.usual_directions[i], input));
  return motion;
}

/// Index of the node at a place on a cable, a fraction of its length.
int node_at(const CableDesc& cable, double place) {
  return static_cast<int>(std::lround(place * cable.segments));
}

/// The place on the cable that a branch leaves.
double place_of_branch(const HarnessSettings& settings, int branch) {
  const int marker = settings.harness.cables[branch].from, trunk = cable_of(settings.harness, marker);
  const std::vector<int> markers = markers_along(settings.harness.cables[trunk]);
  return settings.cables[trunk].places[std::find(markers.begin(), markers.end(), marker) - markers.begin()];
}

/// A value at a fraction of the length of a polyline.
Vector3 along(const std::vector<Vector3>& points, const std::vector<Vector3>& values, double fraction) {
  const std::vector<double> distances = distances_along(points);
  const double distance = fraction * distances.back();
  const auto after =
      std::clamp(std::upper_bound(distances.begin(), distances.end(), distance), distances.begin() + 1, distances.end() - 1);
  const std::size_t i = after - distances.begin();
  const double part = (distance - distances[i - 1]) / std::max(distances[i] - distances[i - 1], 1e-9);
  return values[i - 1] + std::clamp(part, 0.0, 1.0) * (values[i] - values[i - 1]);
}

/// [m/s] a marker, from the first two rows. Cables hardly stretch: a free marker that all its neighbours seem to leave, or come
/// to, has jumped between them, and moves as those neighbours do that have not.
std::vector<Vector3> start_velocities(const Harness& harness, const Recording& input) {
  std::vector<Vector3> velocities = initial_velocities(input);
  const std::vector<Vector3>& places = input.markers.front();
  std::vector<std::vector<int>> neighbours(velocities.size());
  for (const HarnessCable& cable : harness.cables) {
    const std::vector<int> markers = markers_along(cable);
    for (std::size_t i = 1; i < markers.size(); ++i) {
      neighbours[markers[i]].push_back(markers[i - 1]);
      neighbours[markers[i - 1]].push_back(markers[i]);
    }
  }
  std::vector<bool> jumped(velocities.size(), false);
  const auto has_jumped = [&](int marker) {
    bool stays = std::binary_search(harness.held.begin(), harness.held.end(), marker);
    for (const int other : neighbours[marker]) {
      const Vector3 way = (places[other] - places[marker]).normalized();
      stays = stays || jumped[other] || std::abs((velocities[other] - velocities[marker]).dot(way)) < jump_speed;
    }
    return !stays;
  };
  // An outer marker has one neighbour, which may be the one that has jumped.
  for (const bool outer : {false, true})
    for (std::size_t i = 0; i < velocities.size(); ++i)
      if ((neighbours[i].size() == 1) == outer) jumped[i] = has_jumped(static_cast<int>(i));
  const std::vector<Vector3> measured = velocities;
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    if (!jumped[i]) continue;
    Vector3 sum = Vector3::Zero();
    for (const int other : neighbours[i]) sum += measured[other];
    velocities[i] = sum / static_cast<double>(neighbours[i].size());
  }
  return velocities;
}

/// Along the markers of the first row; branches begin at the nodes that they leave.
void start_along_markers(const HarnessSettings& settings, const Recording& input, SceneDesc& scene) {
  const std::vector<Vector3> all_velocities = start_velocities(settings.harness, input);
  for (std::size_t i = 0; i < scene.cables.size(); ++i) {
    CableDesc& cable = scene.cables[i];
    const HarnessCable& from = settings.harness.cables[i];
    std::vector<Vector3> points, velocities;
    for (const int marker : markers_along(from)) {
      points.push_back(input.markers.front()[marker]);
      velocities.push_back(all_velocities[marker]);
    }
    if (from.from >= 0) {
      const CableDesc& trunk = scene.cables[cable_of(settings.harness, from.from)];
      const double fraction =
          static_cast<double>(node_at(trunk, place_of_branch(settings, static_cast<int>(i)))) / trunk.segments;
      points.front() = along(trunk.initial.points, trunk.initial.points, fraction);
      velocities.front() = along(trunk.initial.points, trunk.initial.velocities, fraction);
    }
    cable.initial.type = InitialShapeDesc::Type::points;
    start_smoothly(points, velocities, cable.initial);
    allow_length(cable);
  }
}

const SimulatedCable& find_cable(const World& world, const std::string& name) {
  return *std::find_if(world.cables().begin(), world.cables().end(),
                       [&](const SimulatedCable& cable) { return cable.model->name == name; });
}

/// How a branch leaves its cable at the start of a world.
struct Leaving {
  Quaternion trunk;     ///< axes of the material of the cable that it leaves
  Quaternion plane;     ///< x along the branch, y in the plane of both, away from the direction of the cable that it leaves
  Quaternion material;  ///< axes of the branch's own material
};

Leaving leaving(const HarnessSettings& settings, const World& world, const SceneDesc& scene, int branch) {
  const int trunk = cable_of(settings.harness, settings.harness.cables[branch].from);
  const std::vector<Quaternion> on_trunk = segment_orientations(find_cable(world, scene.cables[trunk].name).state);
  const int node = node_at(scene.cables[trunk], place_of_branch(settings, branch)), last = static_cast<int>(on_trunk.size()) - 1;
  Leaving result;
  result.trunk = on_trunk[std::clamp(node - 1, 0, last)].slerp(0.5, on_trunk[std::min(node, last)]);
  result.material = segment_orientations(find_cable(world, scene.cables[branch].name).state).front();
  const Vector3 x = result.material * Vector3::UnitX();
  const auto across = [&](const Vector3& direction) -> Vector3 { return direction - direction.dot(x) * x; };
  Vector3 y = across(-(result.trunk * Vector3::UnitX()));
  if (y.norm() < same_direction) y = across(result.trunk * Vector3::UnitY());
  y.normalize();
  Eigen::Matrix3d axes;
  axes << x, y, x.cross(y);
  result.plane = Quaternion(axes);
  return result;
}

/// [rad] about x, from y.
double azimuth(const Vector3& direction) {
  return std::atan2(direction.z(), direction.y());
}

bool leaves_trunk(const Harness& harness, int branch) {
  return harness.cables[branch].from >= 0 && cable_of(harness, harness.cables[branch].from) == 0;
}

Quaternion about_x(double angle) {
  return Quaternion(Eigen::AngleAxisd(angle, Vector3::UnitX()));
}

/// [rad] by which the trunk's material is turned about it, against how the scene has it: where its branches are says.
double roll_of_trunk(const HarnessSettings& settings, const World& world, const SceneDesc& scene) {
  double sine = 0, cosine = 0;
  for (int branch = 1; branch < static_cast<int>(scene.cables.size()); ++branch) {
    if (!leaves_trunk(settings.harness, branch)) continue;
    const Leaving leaves = leaving(settings, world, scene, branch);
    const Vector3 is = leaves.trunk.conjugate() * leaves.plane * Vector3::UnitX();
    const Vector3 should = settings.cables[branch].orientation * Vector3::UnitX();
    // The less it leaves to a side, the less it says.
    const double weight = std::hypot(is.y(), is.z()), roll = azimuth(is) - azimuth(should);
    sine += weight * std::sin(roll);
    cosine += weight * std::cos(roll);
  }
  return sine == 0 && cosine == 0 ? 0 : std::atan2(sine, cosine);
}

/// Natural curvatures about the axes of branches as a scene takes them, about those that their material has where they start.
void turn_curvature(const Leaving& leaves, CableDesc& branch) {
  const double angle = azimuth(leaves.material.conjugate() * leaves.plane * Vector3::UnitY());
  for (auto& [about_y, about_z] : branch.rest_curvature.profile) {
    const double y = about_y, z = about_z;
    about_y = y * std::cos(angle) - z * std::sin(angle);
    about_z = y * std::sin(angle) + z * std::cos(angle);
  }
}

std::vector<Vector3> marker_positions(const HarnessSettings& settings, const World& world) {
  std::vector<Vector3> positions(marker_count(settings.harness));
  for (std::size_t i = 0; i < settings.cables.size(); ++i) {
    const HarnessCable& cable = settings.harness.cables[i];
    const std::vector<Vector3>& nodes = find_cable(world, cable.name).state.positions;
    const std::vector<int> markers = markers_along(cable);
    for (std::size_t k = cable.from >= 0 ? 1 : 0; k < markers.size(); ++k) {
      const SegmentPlace place = place_on(static_cast<int>(nodes.size()) - 1, settings.cables[i].places[k]);
      positions[markers[k]] = (1 - place.fraction) * nodes[place.segment] + place.fraction * nodes[place.segment + 1];
    }
  }
  return positions;
}

/// The scene of a harness that starts as an input does.
SceneDesc started_scene(const HarnessSettings& settings, int segments, const std::vector<double>& values,
                        const Recording& input) {
  SceneDesc scene = harness_scene(settings, segments, values);
  start_along_markers(settings, input, scene);
  add_clamps(settings, scene);
  // Junctions sit where they do, whatever the length is brought to.
  for (JunctionDesc& junction : scene.junctions) {
    const int branch =
        static_cast<int>(std::find_if(scene.cables.begin(), scene.cables.end(),
                                      [&](const CableDesc& cable) { return cable.name == junction.branches.front().cable; }) -
                         scene.cables.begin());
    const CableDesc& trunk = scene.cables[cable_of(settings.harness, settings.harness.cables[branch].from)];
    junction.place.arc_length = place_of_branch(settings, branch) * trunk.length;
  }
  return scene;
}

}  // namespace

void add_clamps(const HarnessSettings& settings, SceneDesc& scene) {
  const std::vector<HarnessHold> holds = holds_of(settings.harness);
  for (std::size_t i = 0; i < holds.size(); ++i) {
    CableDesc& cable = scene.cables[holds[i].cable];
    AttachmentDesc& clamp = cable.attachments.emplace_back();
    clamp.name = clamp.frame = hold_name(i);
    clamp.type = AttachmentType::clamp;
    const std::vector<int> markers = markers_along(settings.harness.cables[holds[i].cable]);
    const std::size_t on = std::find(markers.begin(), markers.end(), holds[i].marker) - markers.begin();
    if (holds[i].at_end) clamp.place.at = PlaceDesc::At::end;
    if (!holds[i].at_start && !holds[i].at_end)
      clamp.place = {PlaceDesc::At::arc_length, settings.cables[holds[i].cable].places[on] * cable.length};
  }
}

Smoothed harness_input(const Harness& harness, const Recording& recording) {
  Recording held;
  held.path = recording.path;
  held.times = recording.times;
  for (const std::vector<Vector3>& markers : recording.markers) {
    std::vector<Vector3>& row = held.markers.emplace_back();
    for (const int marker : harness.held) row.push_back(markers[marker]);
  }
  Smoothed input{recording, 0};
  const Smoothed smooth = smoothed(without_flicker(held));
  input.noise = smooth.noise;
  for (int row = 0; row < recording.rows(); ++row)
    for (std::size_t i = 0; i < harness.held.size(); ++i)
      input.recording.markers[row][harness.held[i]] = smooth.recording.markers[row][i];
  return input;
}

void check_harness_starts(const std::vector<Recording>& recordings, const std::vector<Smoothed>& inputs, HarnessSettings settings,
                          std::vector<std::string>& errors) {
  std::vector<int> all(recordings.size());
  std::iota(all.begin(), all.end(), 0);
  measure_harness(recordings, inputs, all, settings);
  for (std::size_t i = 0; i < recordings.size(); ++i)
    for (std::size_t k = 0; k < settings.cables.size(); ++k) {
      std::vector<Vector3> points;
      for (const int marker : markers_along(settings.harness.cables[k]))
        points.push_back(inputs[i].recording.markers.front()[marker]);
      const double start = distances_along(points).back(), length = settings.cables[k].length;
      if (std::abs(start - length) > start_tolerance * length)
        errors.push_back(recordings[i].path + ": the distances of the markers of " + settings.harness.cables[k].name +
                         " in the first row are " + rounded_text(start) +
                         " m in all; allowed: at most 5 % more or less than the cable's length, measured as " +
                         rounded_text(length) + " m");
    }
}

void measure_branches(const std::vector<Smoothed>& inputs, const std::vector<int>& which, HarnessSettings& settings) {
  const std::vector<double> values = first_harness_guess(settings, 1e-2, 1e-4);
  std::vector<Eigen::Vector4d> sums(settings.cables.size(), Eigen::Vector4d::Zero());
  for (const int i : which) {
    const Recording& input = inputs[i].recording;
    const SceneDesc scene = started_scene(settings, settings.segments, values, input);
    const FrameSource frames(scene, motion_of(settings, input));
    const World world(scene, frames.at(0));
    double roll = 0;
    bool is_first = true;
    for (int branch = 1; branch < static_cast<int>(scene.cables.size()); ++branch) {
      const Leaving leaves = leaving(settings, world, scene, branch);
      Quaternion orientation = leaves.trunk.conjugate() * leaves.plane;
      if (leaves_trunk(settings.harness, branch)) {
        if (is_first) roll = azimuth(orientation * Vector3::UnitX());
        is_first = false;
        orientation = about_x(-roll) * orientation;
      } else {
        // The material of a branch has its y axis where `plane` has it.
        const Leaving parent = leaving(settings, world, scene, cable_of(settings.harness, settings.harness.cables[branch].from));
        const double turned = azimuth(parent.material.conjugate() * parent.plane * Vector3::UnitY());
        orientation = about_x(-turned) * orientation;
      }
      const Eigen::Vector4d& q = orientation.coeffs();
      sums[branch] += sums[branch].dot(q) < 0 ? Eigen::Vector4d(-q) : q;
    }
  }
  for (std::size_t branch = 1; branch < sums.size(); ++branch)
    if (sums[branch].norm() > 0) settings.cables[branch].orientation = Quaternion(sums[branch].normalized());
}

Prediction predict_harness(const HarnessSettings& settings, int segments, const std::vector<double>& values,
                           const Recording& input) {
  SceneDesc scene = started_scene(settings, segments, values, input);
  const FrameSource frames(scene, motion_of(settings, input));
  {
    const World start(scene, frames.at(0));
    scene.cables.front().attachments.front().rotation.x() = roll_of_trunk(settings, start, scene);
    for (int branch = 1; branch < static_cast<int>(scene.cables.size()); ++branch)
      turn_curvature(leaving(settings, start, scene, branch), scene.cables[branch]);
  }
  return simulate(Course(World(scene, frames.at(0)), [&](const World& world) { return marker_positions(settings, world); }),
                  frames, input.times);
}

}  // namespace verlet_cable::cable_fit
