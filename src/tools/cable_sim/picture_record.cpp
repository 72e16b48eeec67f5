#include "picture_record.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace verlet_cable::cable_sim {
namespace {

using tools::Json;

constexpr std::int64_t most_frames = 150, most_forces = 600;
constexpr double shortest_frame = 0.04;   // [s] 25 pictures a second
constexpr std::size_t most_points = 400;  ///< of a cable, or of a mesh
constexpr std::size_t most_solids = 300;
constexpr double micros = 1e6;  // of a metre or newton: numbers are rounded to whole ones
constexpr int corners_of_circle = 24;

std::int64_t steps_between(std::int64_t steps, std::int64_t most, double shortest, double time_step) {
  const auto least = static_cast<std::int64_t>(std::ceil(shortest / time_step));
  return std::max({std::int64_t{1}, least, (steps + most - 1) / most});
}

Json number(double x) {
  return std::round(x * micros) / micros;
}

Json array(const Vector3& v) {
  return {number(v.x()), number(v.y()), number(v.z())};
}

/// Every so many of them that there are not too many, and the last.
Json thinned(const std::vector<Vector3>& points) {
  const std::size_t stride = points.size() / most_points + 1;
  Json json = Json::array();
  for (std::size_t i = 0; i + 1 < points.size(); i += stride) json.push_back(array(points[i]));
  if (!points.empty()) json.push_back(array(points.back()));
  return json;
}

void add_circle(double radius, double z, std::vector<Vector3>& points) {
  for (int k = 0; k < corners_of_circle; ++k) {
    const double angle = 2 * M_PI * k / corners_of_circle;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
}

/// A sphere's circles of latitude.
void add_sphere(double radius, double z, std::vector<Vector3>& points) {
  constexpr int circles = 6;
  for (int k = -circles; k <= circles; ++k) {
    const double latitude = 0.5 * M_PI * k / circles;
    add_circle(radius * std::cos(latitude), z + radius * std::sin(latitude), points);
  }
}

/// Points on a solid's surface, in its own frame, whose convex hull looks like it from any side.
struct PointsOfShape {
  std::vector<Vector3> operator()(const PlaneShape&) const { return {}; }
  std::vector<Vector3> operator()(const SphereShape& sphere) const {
    std::vector<Vector3> points;
    add_sphere(sphere.radius, 0, points);
    return points;
  }
  std::vector<Vector3> operator()(const CapsuleShape& capsule) const {
    std::vector<Vector3> points;
    for (const double side : {-0.5, 0.5}) add_sphere(capsule.radius, side * capsule.length, points);
    return points;
  }
  std::vector<Vector3> operator()(const CylinderShape& cylinder) const {
    std::vector<Vector3> points;
    for (const double side : {-0.5, 0.5}) add_circle(cylinder.radius, side * cylinder.length, points);
    return points;
  }
  std::vector<Vector3> operator()(const BoxShape& box) const {
    std::vector<Vector3> points;
    for (const double x : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5})
        for (const double z : {-0.5, 0.5}) points.push_back(box.size.cwiseProduct(Vector3(x, y, z)));
    return points;
  }
  std::vector<Vector3> operator()(const MeshShape& mesh) const { return mesh.mesh->vertices(); }
};

Json solid(const Shape& shape, const Pose& pose) {
  std::vector<Vector3> points = std::visit(PointsOfShape{}, shape);
  for (Vector3& point : points) point = (pose * Pose{point, Quaternion::Identity()}).position;
  return thinned(points);
}

bool is_plane(const Shape& shape) {
  return std::holds_alternative<PlaneShape>(shape);
}

Json obstacles_json(const World& world) {
  Json json = Json::array();
  for (const Obstacle& obstacle : world.obstacles()) {
    if (json.size() == most_solids) break;
    if (obstacle.present && !is_plane(obstacle.shape))
      json.push_back(solid(obstacle.shape, world.frame_pose(obstacle.frame) * obstacle.pose));
  }
  return json;
}

Json bodies_json(const World& world) {
  Json json = Json::array();
  for (const SimulatedBody& body : world.bodies())
    for (const BodyShape& shape : body.shapes)
      if (json.size() < most_solids) json.push_back(solid(shape.shape, body.pose * shape.pose));
  return json;
}

/// A point and the normal of each that stands still.
Json planes_json(const World& world) {
  Json json = Json::array();
  for (const Obstacle& obstacle : world.obstacles()) {
    if (!obstacle.present || !is_plane(obstacle.shape)) continue;
    const Pose pose = world.frame_pose(obstacle.frame) * obstacle.pose;
    json.push_back({array(pose.position), array(pose.orientation * Vector3::UnitZ())});
  }
  return json;
}

}  // namespace

PictureRecord::PictureRecord(const World& world, const std::string& title, std::int64_t steps)
    : steps_(steps),
      steps_a_frame_(steps_between(steps, most_frames, shortest_frame, world.time_step())),
      steps_a_force_(steps_between(steps, most_forces, 0, world.time_step())) {
  json_ = {{"title", title},          {"planes", planes_json(world)}, {"links", Json::object()},
           {"frames", Json::array()}, {"times", Json::array()},       {"forces", Json::object()}};
  for (const SimulatedNet& net : world.nets()) json_["links"][net.model.name] = net.model.links;
  add_frame(world);
}

void PictureRecord::add(const World& world) {
  for (const Attachment& attachment : world.attachments())
    if (is_named(attachment)) sums_.try_emplace(attachment.name, Vector3::Zero()).first->second += attachment.force;
  ++summed_;
  if (world.steps() % steps_a_force_ == 0) add_forces(world);
  if (world.steps() % steps_a_frame_ == 0 || world.steps() == steps_) add_frame(world);
}

void PictureRecord::add_forces(const World& world) {
  const std::size_t earlier = json_["times"].size();
  json_["times"].push_back(world.time() - 0.5 * static_cast<double>(summed_) * world.time_step());
  for (const auto& [name, sum] : sums_) {
    Json& forces = json_["forces"][name];
    while (forces.size() < earlier) forces.push_back(nullptr);  // it did not hold anything yet
    forces.push_back(number(sum.norm() / static_cast<double>(summed_)));
  }
  sums_.clear();
  summed_ = 0;
}

void PictureRecord::add_frame(const World& world) {
  Json cables = Json::object(), nets = Json::object(), particles = Json::array();
  for (const SimulatedCable& cable : world.cables()) cables[cable.model->name] = thinned(cable.state.positions);
  for (const SimulatedNet& net : world.nets()) {
    Json& nodes = nets[net.model.name] = Json::array();
    for (const Vector3& position : net.state.positions) nodes.push_back(array(position));
  }
  for (const SimulatedParticle& particle : world.particles()) particles.push_back(array(particle.position));
  json_["frames"].push_back({{"time", world.time()},
                             {"cables", std::move(cables)},
                             {"nets", std::move(nets)},
                             {"particles", std::move(particles)},
                             {"bodies", bodies_json(world)},
                             {"obstacles", obstacles_json(world)}});
}

}  // namespace verlet_cable::cable_sim
