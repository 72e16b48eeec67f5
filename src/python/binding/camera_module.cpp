#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "binding/drawings.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/view/render.h"

namespace verlet_cable {
namespace {

namespace py = pybind11;
using view::CameraDesc;
using view::CameraModel;
using view::SensorModel;

std::vector<std::string> errors_of(const CameraDesc& desc, const SensorModel& sensor) {
  std::vector<std::string> errors = validate(desc);
  for (const std::string& error : validate(sensor, desc.near, desc.far)) errors.push_back(error);
  return errors;
}

/// A pose of the optical frame: x, y, z, qx, qy, qz, qw.
Pose pose_of(const std::array<double, 7>& numbers) {
  const auto& [x, y, z, qx, qy, qz, qw] = numbers;
  Pose pose{{x, y, z}, Quaternion(qw, qx, qy, qz)};
  if (!is_sound(pose))
    throw py::value_error("pose: not one; allowed: x, y, z, qx, qy, qz, qw: finite numbers, and a quaternion of length 1");
  pose.orientation.normalize();
  return pose;
}

std::array<double, 7> numbers_of(const Pose& pose) {
  const Vector3& p = pose.position;
  const Quaternion& q = pose.orientation;
  return {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
}

std::array<double, 7> look_at(const std::array<double, 3>& eye, const std::array<double, 3>& target,
                              const std::optional<std::array<double, 3>>& up) {
  const Vector3 from(eye.data()), to(target.data());
  return numbers_of(up ? view::look_at(from, to, Vector3(up->data())) : view::look_at(from, to));
}

template <class Number>
py::array_t<Number> image_array(std::size_t count, const CameraModel& model, int channels = 1) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(count), model.height, model.width};
  if (channels > 1) shape.push_back(channels);
  return py::array_t<Number>(shape);
}

template <class Number>
py::array_t<Number> array_of(const std::vector<Number>& numbers) {
  return py::array_t<Number>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

/// The truth of one world: (name, positions, u, v, visible) of each cable.
py::list truth_list(const std::vector<view::CableTruth>& truth) {
  py::list cables;
  for (const view::CableTruth& cable : truth) {
    py::array_t<double> positions(std::vector<py::ssize_t>{static_cast<py::ssize_t>(cable.positions.size()), 3});
    for (std::size_t i = 0; i < cable.positions.size(); ++i)
      std::copy_n(cable.positions[i].data(), 3, positions.mutable_data(i, 0));
    const std::vector<char>& visible = cable.visible;
    py::array_t<bool> seen(static_cast<py::ssize_t>(visible.size()));
    std::copy(visible.begin(), visible.end(), seen.mutable_data());
    cables.append(py::make_tuple(cable.name, positions, array_of(cable.u), array_of(cable.v), seen));
  }
  return cables;
}

/// What camera.Camera is made of, of arguments without `errors_of` them.
class CompiledCamera {
 public:
  CompiledCamera(const CameraDesc& desc, const SensorModel& sensor) : lens_(camera_model(desc)), sensor_(sensor) {}

  const CameraModel& model() const { return lens_.model(); }

  /// Images of each drawing, and the truth of each where that is wanted: a dict of arrays whose first axis is that of the
  /// drawings. `noise`: seed and image of the NoiseSeed of each.
  py::dict render(const py::capsule& capsule, const std::array<double, 7>& pose_numbers,
                  const std::vector<std::pair<std::uint64_t, std::uint64_t>>& noise, const std::vector<std::string>& wanted,
                  int threads) {
    const Drawings& drawings = drawings_in(capsule);
    const Pose pose = pose_of(pose_numbers);
    if (noise.size() != drawings.size()) throw py::value_error("noise: one for each world");
    py::dict result;
    std::vector<view::ImageBuffers> buffers(drawings.size());
    std::vector<std::vector<view::CableTruth>> truth;
    for (const std::string& name : wanted) {
      if (name == "depth")
        result["depth"] = allot(image_array<float>(drawings.size(), model()), &view::ImageBuffers::depth, buffers);
      else if (name == "rgb")
        result["rgb"] = allot(image_array<std::uint8_t>(drawings.size(), model(), 3), &view::ImageBuffers::rgb, buffers);
      else if (name == "mask")
        result["mask"] = allot(image_array<std::uint16_t>(drawings.size(), model()), &view::ImageBuffers::mask, buffers);
      else if (name == "points")
        result["points"] = allot(image_array<float>(drawings.size(), model(), 3), &view::ImageBuffers::points, buffers);
      else if (name == "truth")
        truth.resize(drawings.size());
    }
    // Other threads may use the camera meanwhile.
    const std::shared_ptr<const view::Stage> before = last_;
    std::shared_ptr<const view::Stage> first;
    const bool wants_images = wanted.size() > (truth.empty() ? 0u : 1u);
    {
      const py::gil_scoped_release release;
      tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
      arena.execute([&] {
        // The first one alone: what it prepares of meshes the others share.
        const auto look = [&](std::size_t i) {
          const auto stage = std::make_shared<const view::Stage>(drawings[i], i == 0 ? before.get() : first.get());
          if (i == 0) first = stage;
          if (wants_images) view::render(*stage, lens_, pose, sensor_, {noise[i].first, noise[i].second}, buffers[i]);
          if (!truth.empty()) truth[i] = view::find_truth(*stage, model(), pose);
        };
        look(0);
        tbb::parallel_for(std::size_t{1}, drawings.size(), look);
      });
    }
    last_ = first;
    if (!truth.empty()) {
      py::list all;
      for (const auto& one : truth) all.append(truth_list(one));
      result["truth"] = all;
    }
    return result;
  }

 private:
  /// Each drawing gets its part of an array.
  template <class Number>
  py::array_t<Number> allot(py::array_t<Number> array, Number* view::ImageBuffers::*member,
                            std::vector<view::ImageBuffers>& buffers) const {
    const std::size_t size = static_cast<std::size_t>(array.size()) / buffers.size();
    for (std::size_t i = 0; i < buffers.size(); ++i) buffers[i].*member = array.mutable_data() + i * size;
    return array;
  }

  view::Lens lens_;
  SensorModel sensor_;
  std::shared_ptr<const view::Stage> last_;  ///< what it has prepared of meshes is used again
};

/// Calls with what the arguments of Python's Camera are.
template <class Result, Result (*call)(const CameraDesc&, const SensorModel&)>
Result of_arguments(int width, int height, double horizontal_fov, double near, double far,
                    const std::array<double, 5>& distortion, const std::array<double, 3>& axial, double dropout_angle,
                    double baseline, double disparity_step, double edge_dropout, double edge_step) {
  return call({width, height, horizontal_fov, distortion, near, far},
              {axial, dropout_angle, baseline, disparity_step, edge_dropout, edge_step});
}

std::unique_ptr<CompiledCamera> make(const CameraDesc& desc, const SensorModel& sensor) {
  return std::make_unique<CompiledCamera>(desc, sensor);
}

/// Defines something with those arguments.
template <class Define>
void with_arguments(const Define& define) {
  define(py::kw_only(), py::arg("width"), py::arg("height"), py::arg("horizontal_fov"), py::arg("near"), py::arg("far"),
         py::arg("distortion"), py::arg("axial"), py::arg("dropout_angle"), py::arg("baseline"), py::arg("disparity_step"),
         py::arg("edge_dropout"), py::arg("edge_step"));
}

/// {name: (camera, noise, source)}, both as arguments of camera.Camera.
py::dict presets() {
  py::dict all;
  for (const view::CameraPreset& preset : view::camera_presets()) {
    py::dict camera, noise;
    camera["width"] = preset.camera.width;
    camera["height"] = preset.camera.height;
    camera["horizontal_fov"] = preset.camera.horizontal_fov;
    camera["near"] = preset.camera.near;
    camera["far"] = preset.camera.far;
    camera["distortion"] = preset.camera.distortion;
    noise["axial"] = preset.sensor.axial;
    noise["dropout_angle"] = preset.sensor.dropout_angle;
    noise["baseline"] = preset.sensor.baseline;
    noise["disparity_step"] = preset.sensor.disparity_step;
    noise["edge_dropout"] = preset.sensor.edge_dropout;
    noise["edge_step"] = preset.sensor.edge_step;
    all[py::str(preset.name)] = py::make_tuple(camera, noise, preset.source);
  }
  return all;
}

/// (n, 2) [pixels] Of points in the optical frame, (n, 3); as view::project, with fx, fy, cx, cy and a distortion.
py::array_t<double> project(const std::array<double, 4>& intrinsics, const std::array<double, 5>& distortion,
                            const std::vector<std::array<double, 3>>& points) {
  CameraModel model;
  model.fx = intrinsics[0];
  model.fy = intrinsics[1];
  model.cx = intrinsics[2];
  model.cy = intrinsics[3];
  model.distortion = distortion;
  py::array_t<double> pixels(std::vector<py::ssize_t>{static_cast<py::ssize_t>(points.size()), 2});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::array<double, 2> pixel = view::project(model, Vector3(points[i].data()));
    std::copy(pixel.begin(), pixel.end(), pixels.mutable_data(static_cast<py::ssize_t>(i), 0));
  }
  return pixels;
}

py::list labels(const py::capsule& capsule) {
  py::list all;
  for (const view::Drawing& drawing : drawings_in(capsule)) all.append(view::labels(drawing));
  return all;
}

}  // namespace
}  // namespace verlet_cable

PYBIND11_MODULE(_camera, module) {
  using namespace verlet_cable;
  module.doc() = "The compiled part of verlet_cable.camera.";
  py::class_<CompiledCamera> camera(module, "CompiledCamera");
  with_arguments([&](const auto&... arguments) {
    camera.def(py::init(&of_arguments<std::unique_ptr<CompiledCamera>, make>), arguments...);
  });
  with_arguments(
      [&](const auto&... arguments) { module.def("errors", &of_arguments<std::vector<std::string>, errors_of>, arguments...); });
  module.attr("most_pixels") = view::most_pixels;
  camera
      .def_property_readonly("intrinsics",
                             [](const CompiledCamera& camera) {
                               const CameraModel& model = camera.model();
                               return py::make_tuple(model.fx, model.fy, model.cx, model.cy);
                             })
      .def("render", &CompiledCamera::render, py::arg("drawings"), py::arg("pose"), py::arg("noise"), py::arg("wanted"),
           py::arg("threads"));
  module.def("look_at", &look_at, py::arg("eye"), py::arg("target"), py::arg("up") = py::none());
  module.def("project", &project, py::arg("intrinsics"), py::arg("distortion"), py::arg("points"));
  module.def("presets", &presets);
  module.def("labels", &labels, py::arg("drawings"));
}
