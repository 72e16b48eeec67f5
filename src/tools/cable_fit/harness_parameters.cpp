#include "harness_parameters.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace verlet_cable::cable_fit {
namespace {

constexpr double time_step = 0.01;  // [s]
constexpr double default_linear_density = 0.1, default_radius = 0.005;

/// In the order of a cable's parameters.
enum : std::size_t { bending, damping, drag, torsion, material_count };

struct Property {
  const char* key;
  const char* unit;
  double lowest, highest;  ///< decimal logarithms of the value over the linear density
  double likely;           ///< [decades] of a branch from the trunk, but for torsion: from its bending stiffness
};
constexpr Property properties[material_count] = {
    {"bending_stiffness", "N m^2", -5, 2, 1},
    {"bending_damping", "N m^2 s", -7, 0, 1},
    {"drag", "kg/(m s)", -4, 2, 0.5},
    {"torsional_stiffness", "N m^2", -5, 2, 0.5},
};

/// [decades]
constexpr double likely_drag = 2, likely_density = 0.3, widest_density = 1.5;
constexpr double guessed_drag = 0.1;  // [1/s] over the linear density
constexpr double length_tolerance = 0.02;
constexpr double highest_curvature = 100;  // [1/m]
constexpr double likely_curvature = 1.5;   // [1/m]

constexpr double logarithmic_step = 0.02;  // decades
constexpr double relative_length_step = 5e-4;
constexpr double curvature_step = 0.05;  // [1/m]

/// Natural curvature is looked for about as densely as there are markers.
constexpr int most_places = 12;
constexpr int fewest_branch_segments = 3;
/// Numbers of segments that are tried: a half to three halves of what is wanted.
constexpr double fewer_segments = 0.75, more_segments = 1.25;

int curvature_places(const HarnessCable& cable) {
  return std::clamp(static_cast<int>(markers_along(cable).size()) - (cable.from < 0 ? 3 : 1), 2, most_places);
}

bool density_is_found(const HarnessCable& cable) {
  return cable.from >= 0 && cable.linear_density == 0;
}

/// Where a cable's parameters are.
struct Places {
  std::size_t material, density, length, curvature, end;
};

std::vector<Places> places_of(const Harness& harness) {
  std::vector<Places> all;
  std::size_t next = 0;
  for (const HarnessCable& cable : harness.cables) {
    Places& places = all.emplace_back();
    places.material = next;
    places.density = next += material_count;
    if (density_is_found(cable)) ++next;
    places.length = next;
    if (cable.from < 0) ++next;
    places.curvature = next;
    next += 2 * static_cast<std::size_t>(curvature_places(cable));
    places.end = next;
  }
  return all;
}

double given_density(const Harness& harness, const HarnessCable& cable) {
  if (cable.linear_density > 0) return cable.linear_density;
  const double of_trunk = harness.cables.front().linear_density;
  return of_trunk > 0 ? of_trunk : default_linear_density;
}

std::vector<double> median_distances(const std::vector<const Recording*>& recordings, const std::vector<int>& markers) {
  std::vector<double> medians;
  for (std::size_t i = 1; i < markers.size(); ++i) {
    std::vector<double> distances;
    for (const Recording* recording : recordings)
      for (const std::vector<Vector3>& row : recording->markers)
        distances.push_back((row[markers[i]] - row[markers[i - 1]]).norm());
    medians.push_back(median(std::move(distances)));
  }
  return medians;
}

Vector3 mean_direction(const std::vector<const Recording*>& recordings, int from, int to) {
  Vector3 sum = Vector3::Zero();
  for (const Recording* recording : recordings)
    for (const std::vector<Vector3>& row : recording->markers) sum += (row[to] - row[from]).normalized();
  return sum.norm() > 0 ? Vector3(sum.normalized()) : Vector3(Vector3::UnitX());
}

/// What has to be at a node of a cable, as fractions of its length.
std::vector<double> places_at_nodes(const HarnessSettings& settings, int cable) {
  const std::vector<int> markers = markers_along(settings.harness.cables[cable]);
  std::vector<double> places;
  const auto add = [&](int marker) {
    const auto found = std::find(markers.begin(), markers.end(), marker);
    places.push_back(settings.cables[cable].places[found - markers.begin()]);
  };
  for (const HarnessCable& branch : settings.harness.cables)
    if (branch.from >= 0 && cable_of(settings.harness, branch.from) == cable) add(branch.from);
  for (const HarnessHold& hold : holds_of(settings.harness))
    if (hold.cable == cable && !hold.at_start && !hold.at_end) add(hold.marker);
  return places;
}

Vector3 rpy_of(const Quaternion& q) {
  const Eigen::Matrix3d m = q.toRotationMatrix();
  return {std::atan2(m(2, 1), m(2, 2)), std::asin(std::clamp(-m(2, 0), -1.0, 1.0)), std::atan2(m(1, 0), m(0, 0))};
}

}  // namespace

void measure_harness(const std::vector<Recording>& recordings, const std::vector<Smoothed>& inputs, const std::vector<int>& which,
                     HarnessSettings& settings) {
  std::vector<const Recording*> measured, held;
  for (const int i : which) {
    measured.push_back(&recordings[i]);
    held.push_back(&inputs[i].recording);
  }
  settings.cables.assign(settings.harness.cables.size(), {});
  for (std::size_t i = 0; i < settings.cables.size(); ++i) {
    BranchMeasures& cable = settings.cables[i];
    cable.places = {0};
    for (const double distance : median_distances(measured, markers_along(settings.harness.cables[i])))
      cable.places.push_back(cable.places.back() + distance);
    cable.length = cable.places.back();
    for (double& place : cable.places) place /= cable.length;
  }
  settings.usual_directions.clear();
  for (const HarnessHold& hold : holds_of(settings.harness)) {
    settings.usual_directions.emplace_back(Vector3::UnitX());
    if (hold.second < 0) continue;
    const auto [from, to] = std::minmax(hold.marker, hold.second);
    settings.usual_directions.back() = mean_direction(held, from, to);
    settings.cables[hold.cable].stiff_ends[hold.at_end ? 1 : 0] = median_distances(held, {from, to}).front();
  }
}

std::vector<Parameter> harness_parameters(const HarnessSettings& settings) {
  const Harness& harness = settings.harness;
  const std::vector<Places> places = places_of(harness);
  std::vector<Parameter> parameters;
  for (std::size_t i = 0; i < harness.cables.size(); ++i) {
    const HarnessCable& cable = harness.cables[i];
    const bool is_trunk = cable.from < 0;
    const std::string material = "materials." + cable.name + ".", key = "cables[" + std::to_string(i) + "].";
    const double density = std::log10(given_density(harness, cable));
    for (const Property& p : properties)
      parameters.push_back(
          {material + p.key, p.unit, true, density + p.lowest, density + p.highest, logarithmic_step, p.likely, 0});
    const std::size_t first = places[i].material;
    for (std::size_t k = bending; k < torsion; ++k) {
      parameters[first + k].relative_to = is_trunk ? -1 : static_cast<int>(k);
      if (is_trunk) parameters[first + k].likely = 0;
    }
    parameters[first + torsion].relative_to = static_cast<int>(first + bending);
    if (is_trunk) {
      parameters[first + drag].likely = likely_drag;
      parameters[first + drag].expected = density + std::log10(guessed_drag);
    }
    if (density_is_found(cable))
      parameters.push_back({material + "linear_density", "kg/m", true, density - widest_density, density + widest_density,
                            logarithmic_step, likely_density, -1, density});
    const double length = settings.cables[i].length;
    if (is_trunk)
      parameters.push_back({key + "length", "m", false, (1 - length_tolerance) * length, (1 + length_tolerance) * length,
                            relative_length_step * length, 0, -1});
    for (int place = 0; place < curvature_places(cable); ++place)
      for (int axis = 0; axis < 2; ++axis)
        parameters.push_back({key + "rest_curvature[" + std::to_string(place) + "][" + std::to_string(axis) + "]", "1/m", false,
                              -highest_curvature, highest_curvature, curvature_step, likely_curvature, -1});
  }
  return parameters;
}

std::vector<double> first_harness_guess(const HarnessSettings& settings, double bending_over_density,
                                        double damping_over_density) {
  const Harness& harness = settings.harness;
  const std::vector<Places> places = places_of(harness);
  std::vector<double> values(places.back().end, 0.0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double density = given_density(harness, harness.cables[i]);
    values[places[i].material + bending] = values[places[i].material + torsion] = std::log10(bending_over_density * density);
    values[places[i].material + damping] = std::log10(damping_over_density * density);
    values[places[i].material + drag] = std::log10(guessed_drag * density);
    if (density_is_found(harness.cables[i])) values[places[i].density] = std::log10(density);
    if (harness.cables[i].from < 0) values[places[i].length] = settings.cables[i].length;
  }
  return values;
}

int segments_of(const HarnessSettings& settings, int cable, int segments) {
  const double length = settings.cables[cable].length;
  const double wanted = segments * length / settings.cables.front().length;
  const int plain = std::max(static_cast<int>(std::lround(wanted)), fewest_branch_segments);
  const std::vector<double> places = places_at_nodes(settings, cable);
  if (places.empty()) return plain;
  int best = plain;
  double least = infinity;
  const int most = std::max(static_cast<int>(more_segments * plain), plain + 2);
  for (int count = std::max(static_cast<int>(fewer_segments * plain), fewest_branch_segments); count <= most; ++count) {
    double farthest = 0;
    for (const double place : places) farthest = std::max(farthest, std::abs(place - std::round(place * count) / count));
    if (farthest >= least) continue;
    least = farthest;
    best = count;
  }
  return best;
}

SceneDesc harness_scene(const HarnessSettings& settings, int segments, const std::vector<double>& values) {
  const Harness& harness = settings.harness;
  const std::vector<Places> places = places_of(harness);
  SceneDesc scene;
  scene.time_step = time_step;
  std::map<int, JunctionDesc> junctions;  // by marker
  for (std::size_t i = 0; i < harness.cables.size(); ++i) {
    const HarnessCable& from = harness.cables[i];
    const auto value = [&](std::size_t property) { return std::pow(10, values[places[i].material + property]); };
    NamedMaterial& named = scene.materials.emplace_back();
    named.name = from.name;
    MaterialDesc& material = named.material;
    material.linear_density = density_is_found(from) ? std::pow(10, values[places[i].density]) : given_density(harness, from);
    material.radius = from.radius > 0                     ? from.radius
                      : harness.cables.front().radius > 0 ? harness.cables.front().radius
                                                          : default_radius;
    material.bending_stiffness = value(bending);
    material.bending_damping = value(damping);
    material.drag = value(drag);
    material.torsional_stiffness = value(torsion);
    // Twist is damped as bending is: after the same time.
    material.torsional_damping = value(damping) * value(torsion) / value(bending);
    CableDesc& cable = scene.cables.emplace_back();
    cable.name = cable.material = from.name;
    cable.segments = segments_of(settings, static_cast<int>(i), segments);
    cable.length = from.from < 0 ? values[places[i].length] : settings.cables[i].length;
    cable.stiff_ends = settings.cables[i].stiff_ends;
    cable.rest_curvature.type = RestCurvatureDesc::Type::profile;
    cable.rest_curvature.zero_counts = true;
    for (std::size_t k = places[i].curvature; k < places[i].end; k += 2)
      cable.rest_curvature.profile.push_back({values[k], values[k + 1]});
    if (from.from < 0) continue;
    const int trunk = cable_of(harness, from.from);
    const std::vector<int> markers = markers_along(harness.cables[trunk]);
    const std::size_t on = std::find(markers.begin(), markers.end(), from.from) - markers.begin();
    JunctionDesc& junction = junctions[from.from];
    junction.name = "junction_" + std::to_string(from.from);
    junction.cable = harness.cables[trunk].name;
    junction.place = {PlaceDesc::At::arc_length, settings.cables[trunk].places[on] * scene.cables[trunk].length};
    junction.branches.push_back({from.name, BranchDesc::End::start, rpy_of(settings.cables[i].orientation)});
  }
  for (const auto& [marker, junction] : junctions) scene.junctions.push_back(junction);
  return scene;
}

}  // namespace verlet_cable::cable_fit
