#include "binding/drawing.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <variant>
#include <vector>

#include "scene/surface.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {
namespace {

py::array_t<double> points_array(const std::vector<Vector3>& points) {
  py::array_t<double> array(std::vector<std::size_t>{points.size(), 3});
  for (std::size_t i = 0; i < points.size(); ++i) std::copy_n(points[i].data(), 3, array.mutable_data() + 3 * i);
  return array;
}

/// (points, faces) in the fixed frame.
py::tuple solid(const Shape& shape, const Pose& pose) {
  Surface surface = surface_of(shape, 1);
  for (Vector3& point : surface.points) point = (pose * Pose{point, Quaternion::Identity()}).position;
  return py::make_tuple(points_array(surface.points), surface.faces);
}

/// (name, positions, radius of each segment, color)
py::tuple drawn_cable(const SimulatedCable& cable) {
  const CableMaterials materials(cable);
  std::vector<double> radii(cable.state.rest_lengths.size());
  for (std::size_t i = 0; i < radii.size(); ++i) radii[i] = materials[static_cast<int>(i)].radius;
  return py::make_tuple(cable.model->name, points_array(cable.state.positions), radii, cable.model->color);
}

}  // namespace

py::dict drawn_shapes(const World& world) {
  py::list cables, nets, particles, bodies, obstacles, planes;
  for (const SimulatedCable& cable : world.cables()) cables.append(drawn_cable(cable));
  for (const SimulatedNet& net : world.nets())
    nets.append(py::make_tuple(net.model.name, points_array(net.state.positions), net.model.links, net.model.color));
  for (const SimulatedParticle& particle : world.particles()) {
    const Pose pose{particle.position, Quaternion::Identity()};
    particles.append(py::make_tuple(particle.desc.name, solid(SphereShape{particle.desc.radius}, pose), particle.desc.color));
  }
  for (const SimulatedBody& body : world.bodies()) {
    if (body.is_junction) continue;
    py::list solids;
    for (const BodyShape& shape : body.shapes) solids.append(solid(shape.shape, body.pose * shape.pose));
    bodies.append(py::make_tuple(body.name, points_array({body.pose.position}), solids));
  }
  for (const Obstacle& obstacle : world.obstacles()) {
    if (!obstacle.present) continue;
    const Pose pose = world.frame_pose(obstacle.frame) * obstacle.pose;
    if (std::holds_alternative<PlaneShape>(obstacle.shape))
      planes.append(points_array({pose.position, pose.orientation * Vector3::UnitZ()}));
    else
      obstacles.append(solid(obstacle.shape, pose));
  }
  py::dict shapes;
  shapes["cables"] = cables;
  shapes["nets"] = nets;
  shapes["particles"] = particles;
  shapes["bodies"] = bodies;
  shapes["obstacles"] = obstacles;
  shapes["planes"] = planes;
  return shapes;
}

}  // namespace verlet_cable
