#include "cloud_fit.h"

#include <algorithm>
#include <cmath>

#include "least_squares.h"
#include "prediction.h"
#include "scene/frame_source.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr double cloud_bending[] = {1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 3e-1};  // EI over the linear density [N m^3 / kg]
constexpr double cloud_times[] = {0.01, 0.1};                             // [s] damping over stiffness
constexpr Ending for_clouds{8, 4, 1e-3, 0};
/// Bending stiffness, bending damping and drag; then the length. Twist leaves hardly a trace in points of a surface.
constexpr std::size_t cloud_material_count = 3;
constexpr double cloud_length_step = 5e-4;  // of it
constexpr std::size_t first_lossy = 1;
/// [decades] Noise takes points to the other side of a thin cable's axis, and what swings looks a little less damped.
constexpr double unresolved_loss = 0.02;
constexpr double unresolved_cloud_length = 5e-4;  // of it, as a cable stretches a little
/// The part of the scene's length by which the cable's may differ.
constexpr double length_range = 0.2;
/// [m] by which a cloud is missed that no world can be made for.
constexpr double out_of_sight = 1;

double linear_density_of(const CloudProblem& problem) {
  return problem.scene.find_material(problem.scene.cables[problem.cable].material)->linear_density;
}

SceneDesc scene_with(const CloudProblem& problem, int segments, const std::vector<double>& values) {
  SceneDesc scene = problem.scene;
  CableDesc& cable = scene.cables[problem.cable];
  for (NamedMaterial& named : scene.materials) {
    if (named.name == cable.material) set_material(values, cloud_material_count, named.material);
  }
  cable.length = values[cloud_material_count];
  cable.segments = segments;
  if (cable.initial.type == InitialShapeDesc::Type::automatic) cable.initial.type = InitialShapeDesc::Type::settled;
  return scene;
}

std::vector<Parameter> cloud_parameters(const CloudProblem& problem) {
  const CableDesc& cable = problem.scene.cables[problem.cable];
  std::vector<Parameter> parameters = material_parameters("materials." + cable.material, linear_density_of(problem));
  parameters.resize(cloud_material_count);
  for (std::size_t i = first_lossy; i < cloud_material_count; ++i) parameters[i].unresolved = unresolved_loss;
  parameters.push_back({"cables[" + std::to_string(problem.cable) + "].length", "m", false, (1 - length_range) * cable.length,
                        (1 + length_range) * cable.length, cloud_length_step * cable.length});
  parameters.back().unresolved = unresolved_cloud_length * cable.length;
  return parameters;
}

using Curve = std::vector<Vector3>;

/// Where the nodes are at the clouds' times. Throws SceneError where the cable cannot be.
std::vector<Curve> nodes_over_time(const CloudProblem& problem, const SceneDesc& scene) {
  const FrameSource frames(scene, problem.motion);
  Course course(World(scene, frames.at(0)),
                [&problem](const World& world) { return world.cables()[problem.cable].state.positions; });
  std::vector<Curve> nodes;
  for (const double time : problem.clouds.times) nodes.push_back(course.at(time, frames));
  return nodes;
}

/// With a point between each two, on the cubic through the four around them (Dyn, Levin, Gregory, A 4-point interpolatory
/// subdivision scheme for curve design, 1987).
Curve subdivided(const Curve& nodes) {
  const std::size_t last = nodes.size() - 1;
  if (last < 2) return nodes;
  const Vector3 before = 3 * (nodes[0] - nodes[1]) + nodes[2], behind = 3 * (nodes[last] - nodes[last - 1]) + nodes[last - 2];
  Curve curve;
  for (std::size_t i = 0; i < last; ++i) {
    const Vector3 outer = (i == 0 ? before : nodes[i - 1]) + (i + 1 == last ? behind : nodes[i + 2]);
    curve.push_back(nodes[i]);
    curve.push_back((9 * (nodes[i] + nodes[i + 1]) - outer) / 16);
  }
  curve.push_back(nodes[last]);
  return curve;
}

/// Where the cable is at the clouds' times. Errors of segments and of time steps go with the square of their lengths: they cancel
/// from two simulations, one of which has them half as long (Richardson's extrapolation).
std::vector<Curve> curves_over_time(const CloudProblem& problem, SceneDesc scene) {
  const std::vector<Curve> usual = nodes_over_time(problem, scene);
  scene.cables[problem.cable].segments *= 2;
  scene.time_step /= 2;
  std::vector<Curve> curves = nodes_over_time(problem, scene);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Curve coarse = subdivided(usual[i]);
    for (std::size_t node = 0; node < coarse.size(); ++node) curves[i][node] += (curves[i][node] - coarse[node]) / 3;
    curves[i] = subdivided(curves[i]);
  }
  return curves;
}

/// A cloud, a point.
std::vector<std::vector<double>> distances_over_time(const CloudProblem& problem, const SceneDesc& scene) {
  const double radius = scene.find_material(scene.cables[problem.cable].material)->radius;
  std::vector<std::vector<double>> distances;
  try {
    const std::vector<Curve> curves = curves_over_time(problem, scene);
    for (std::size_t i = 0; i < curves.size(); ++i)
      distances.push_back(distances_from_tube(problem.clouds.points[i], curves[i], radius));
  } catch (const SceneError&) {  // too short for what holds it
    for (const std::vector<Vector3>& points : problem.clouds.points) distances.emplace_back(points.size(), out_of_sight);
  }
  return distances;
}

/// The same as a problem of least squares, of one recording.
Problem cloud_least_squares(const CloudProblem& problem) {
  static const std::vector<Recording> no_recordings;
  static const std::vector<Smoothed> no_inputs;
  Problem result{no_recordings, no_inputs, {}, cloud_parameters(problem), problem.simulated};
  result.settings.segments = problem.scene.cables[problem.cable].segments;
  result.missed_counts = {problem.clouds.point_count()};
  result.missed_by = [&problem](int segments, const std::vector<double>& values, int) {
    std::vector<double> all;
    for (const std::vector<double>& cloud : distances_over_time(problem, scene_with(problem, segments, values)))
      all.insert(all.end(), cloud.begin(), cloud.end());
    return all;
  };
  return result;
}

std::vector<double> coarse_cloud_search(Problem problem, const CloudProblem& clouds) {
  problem.settings.segments = std::min(problem.settings.segments, coarse_segments);
  std::vector<double> best;
  double least = infinity;
  for (const double bending : cloud_bending)
    for (const double time : cloud_times) {
      std::vector<double> values = first_material(linear_density_of(clouds), bending, time * bending);
      values.resize(cloud_material_count);
      values.push_back(clouds.scene.cables[clouds.cable].length);
      const double cost = linearize(problem, {0}, values, false).front().values.squaredNorm();
      if (cost >= least && !best.empty()) continue;
      least = cost;
      best = std::move(values);
    }
  return best;
}

double mean_size(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double number : numbers) sum += std::abs(number) / static_cast<double>(numbers.size());
  return sum;
}

}  // namespace

int most_simulations(const CloudProblem& problem) {
  return most_simulations(cloud_least_squares(problem), 1, for_clouds);
}

CloudFit fit_clouds(const CloudProblem& problem) {
  const Problem least_squares = cloud_least_squares(problem);
  CloudFit result;
  result.parameters = least_squares.parameters;
  result.values = fit(least_squares, {0}, coarse_cloud_search(least_squares, problem), for_clouds);
  result.confidence = confidence_by_scatter(least_squares, {0}, result.values);
  result.scene = scene_with(problem, problem.scene.cables[problem.cable].segments, result.values);
  for (const std::vector<double>& cloud : distances_over_time(problem, result.scene)) {
    result.mean_distances.push_back(mean_size(cloud));
    result.mean_distance +=
        result.mean_distances.back() * static_cast<double>(cloud.size()) / static_cast<double>(problem.clouds.point_count());
  }
  return result;
}

}  // namespace verlet_cable::cable_fit
