#include "binding/drawing.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <variant>
#include <vector>

#include "scene/surface.h"
#include "verlet_cable/view/drawing.h"

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

py::list solids_of(const view::Thing& thing) {
  py::list solids;
  for (const view::Part& part : thing.parts) solids.append(solid(part.shape, thing.pose * part.pose));
  return solids;
}

/// (name, positions, radius of each segment, color)
py::tuple drawn_cable(const view::Thing& thing) {
  const view::Tube& tube = thing.tubes.front();
  std::vector<double> radii = tube.radii;
  if (radii.size() == 1) radii.assign(tube.centers.size() - 1, tube.radii.front());
  return py::make_tuple(thing.name, points_array(tube.centers), radii, thing.look.color);
}

/// (name, positions, links, color)
py::tuple drawn_net(const view::Thing& thing) {
  std::vector<Vector3> points;
  std::vector<std::array<std::size_t, 2>> links;
  for (const view::Tube& cord : thing.tubes) {
    links.push_back({points.size(), points.size() + 1});
    points.insert(points.end(), cord.centers.begin(), cord.centers.end());
  }
  return py::make_tuple(thing.name, points_array(points), links, thing.look.color);
}

}  // namespace

py::dict drawn_shapes(const World& world) {
  view::DrawingOptions options;
  options.stripes = false;
  options.distinct_colors = true;
  py::list cables, nets, bodies, solids, planes;
  for (const view::Thing& thing : view::drawing_of(world, options).things) {
    if (thing.kind == view::Thing::Kind::cable) {
      if (!thing.tubes.empty()) cables.append(drawn_cable(thing));
    } else if (thing.kind == view::Thing::Kind::body) {
      bodies.append(py::make_tuple(thing.name, points_array({thing.pose.position}), solids_of(thing), thing.look.color));
    } else if (!thing.tubes.empty()) {
      nets.append(drawn_net(thing));
    } else if (!thing.parts.empty() && std::holds_alternative<PlaneShape>(thing.parts.front().shape)) {
      const Pose pose = thing.pose * thing.parts.front().pose;
      planes.append(
          py::make_tuple(thing.name, points_array({pose.position, pose.orientation * Vector3::UnitZ()}), thing.look.color));
    } else {
      for (const py::handle& one : solids_of(thing)) solids.append(py::make_tuple(one, thing.look.color));
    }
  }
  py::dict shapes;
  shapes["cables"] = cables;
  shapes["nets"] = nets;
  shapes["bodies"] = bodies;
  shapes["solids"] = solids;
  shapes["planes"] = planes;
  return shapes;
}

}  // namespace verlet_cable
