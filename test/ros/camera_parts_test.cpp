// Parts of the camera that need no master: its parameters, what a driver says of it, pixels.
#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <limits>

#include "camera/camera_info.h"
#include "camera/camera_settings.h"
#include "camera/moment_drawing.h"
#include "camera/pixels.h"
#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {
namespace {

std::optional<std::string> no_parameter(const std::string&) {
  return std::nullopt;
}

std::vector<std::string> errors_of(const std::string& yaml) {
  try {
    read_camera_settings(YAML::Load(yaml), no_parameter);
  } catch (const SceneError& error) {
    return error.errors();
  }
  return {};
}

void expect_default(const CameraSettings& settings) {
  const CameraSettings defaults;
  EXPECT_EQ(settings.state, defaults.state);
  EXPECT_EQ(settings.optical_frame, defaults.optical_frame);
  EXPECT_EQ(settings.preset, defaults.preset);
  EXPECT_EQ(settings.camera.width, defaults.camera.width);
  EXPECT_EQ(settings.camera.height, defaults.camera.height);
  EXPECT_EQ(settings.camera.horizontal_fov, defaults.camera.horizontal_fov);
  EXPECT_EQ(settings.camera.distortion, defaults.camera.distortion);
  EXPECT_EQ(settings.camera.near, defaults.camera.near);
  EXPECT_EQ(settings.camera.far, defaults.camera.far);
  EXPECT_EQ(settings.sensor.axial, defaults.sensor.axial);
  EXPECT_EQ(settings.sensor.dropout_angle, defaults.sensor.dropout_angle);
  EXPECT_EQ(settings.sensor.baseline, defaults.sensor.baseline);
  EXPECT_EQ(settings.sensor.disparity_step, defaults.sensor.disparity_step);
  EXPECT_EQ(settings.sensor.edge_dropout, defaults.sensor.edge_dropout);
  EXPECT_EQ(settings.sensor.edge_step, defaults.sensor.edge_step);
  EXPECT_EQ(settings.rate, defaults.rate);
  EXPECT_EQ(settings.seed, defaults.seed);
  EXPECT_EQ(settings.depth_encoding, defaults.depth_encoding);
  EXPECT_EQ(settings.shadows, defaults.shadows);
  EXPECT_EQ(settings.labels, defaults.labels);
  EXPECT_EQ(settings.robot_description, defaults.robot_description);
  EXPECT_EQ(settings.camera_info_topic, defaults.camera_info_topic);
  EXPECT_EQ(settings.tf_timeout, defaults.tf_timeout);
}

TEST(CameraSettings, TemplateHoldsTheDefaults) {
  const YAML::Node file = YAML::LoadFile(CONFIG_DIRECTORY "/cameras/template.yaml");
  EXPECT_EQ(file.size(), 18u);  // all that is checked above
  expect_default(read_camera_settings(file, no_parameter));
}

TEST(CameraSettings, PresetsAreDefaultsOfTheOtherParameters) {
  const view::CameraPreset& preset = view::camera_presets().front();
  const CameraSettings settings =
      read_camera_settings(YAML::Load("{preset: " + preset.name + ", width: 100, noise: {dropout_angle: 45}}"), no_parameter);
  EXPECT_EQ(settings.camera.width, 100);
  EXPECT_EQ(settings.camera.height, preset.camera.height);
  EXPECT_EQ(settings.sensor.dropout_angle, 45);
  EXPECT_EQ(settings.sensor.axial, preset.sensor.axial);
}

TEST(CameraSettings, AllErrorsAtOnce) {
  EXPECT_EQ(errors_of("{width: 0, rate: -1, fare: 3}").size(), 3u);
  EXPECT_EQ(errors_of("{horizontal_fov: 180}").size(), 1u);
  EXPECT_EQ(errors_of("{horizontal_fov: wide}"), std::vector<std::string>{"horizontal_fov: \"wide\"; allowed: a number"});
  EXPECT_EQ(errors_of("{distortion: [3, 0, 0, 0, 0]}").size(), 0u);
  EXPECT_EQ(errors_of("{distortion: [-30, 0, 0, 0, 0]}").size(), 1u);
  EXPECT_EQ(errors_of("{robot_description: no_such}").size(), 1u);
  EXPECT_EQ(errors_of("{near: 1, noise: {axial: [-1, 0.9, 0]}}").size(), 1u);
  EXPECT_EQ(errors_of("{near: 1.2, noise: {axial: [-1, 0.9, 0]}}").size(), 0u);
  EXPECT_EQ(errors_of("{}").size(), 0u);
}

TEST(CameraInfo, AModelComesBackAsItWas) {
  view::CameraModel model;
  model.distortion = {0.1, -0.05, 0.001, 0.002, 0};
  model.cx = 300;
  const ReceivedModel received = model_of(info_of(model), 0.2, 5);
  EXPECT_EQ(received.problem, "");
  EXPECT_EQ(received.model.distortion, model.distortion);
  EXPECT_EQ(received.model.fx, model.fx);
  EXPECT_EQ(received.model.cx, 300);
  EXPECT_EQ(received.model.far, 5);
}

TEST(CameraInfo, WhatCannotBeUsedIsNamed) {
  const auto problem_with = [](const std::function<void(sensor_msgs::CameraInfo&)>& change) {
    sensor_msgs::CameraInfo info = info_of({});
    change(info);
    return model_of(info, 0.1, 10).problem;
  };
  EXPECT_EQ(problem_with([](auto&) {}), "");
  EXPECT_EQ(problem_with([](auto& info) { info.D.clear(); }), "");
  EXPECT_EQ(problem_with([](auto& info) { info.K[0] = 0; }).substr(0, 4), "fx: ");
  EXPECT_EQ(problem_with([](auto& info) { info.width = 4000000000u; }).substr(0, 7), "width: ");
  EXPECT_EQ(problem_with([](auto& info) { info.binning_x = 2; }).substr(0, 9), "binning_x");
  EXPECT_EQ(problem_with([](auto& info) { info.roi.width = 10; }).substr(0, 4), "roi:");
  EXPECT_EQ(problem_with([](auto& info) { info.D = {0.1, 0, 0, 0}; }).substr(0, 2), "D:");
  EXPECT_EQ(problem_with([](auto& info) {
              info.distortion_model = "equidistant";
              info.D = {0.1, 0, 0, 0};
            }).substr(0, 17),
            "distortion_model:");
  // All at once.
  const std::string all = problem_with([](auto& info) {
    info.distortion_model = "equidistant";
    info.D = {0.1, 0, 0, 0};
    info.binning_y = 4;
    info.K[0] = std::numeric_limits<double>::quiet_NaN();
    info.height = 0;
  });
  for (const char* part :
       {"distortion_model: \"equidistant\"; allowed: ", "; binning_x, binning_y: 4; ", "; fx: nan; ", "; height: 0; "})
    EXPECT_NE(all.find(part), std::string::npos) << part << " in " << all;
}

TEST(Pixels, DepthInMillimetres) {
  sensor_msgs::ImagePtr depth = make_image({}, 5, 1, sensor_msgs::image_encodings::TYPE_32FC1);
  ASSERT_EQ(depth->step, 20u);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float metres[] = {0.5004f, nan, 65.535f, 65.6f, 0.0001f};
  std::copy(std::begin(metres), std::end(metres), pixels_of<float>(*depth));
  round_to_millimetres(*depth);
  EXPECT_FLOAT_EQ(pixel_of<float>(*depth, 0), 0.5f);
  EXPECT_TRUE(std::isnan(pixel_of<float>(*depth, 3)));
  const sensor_msgs::ImagePtr image = in_millimetres(*depth);
  EXPECT_EQ(image->encoding, "16UC1");
  const std::uint16_t expected[] = {500, 0, 65535, 0, 0};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(pixel_of<std::uint16_t>(*image, i), expected[i]) << i;
}

/// A cable that waits has no place in `state`, and keeps its number.
TEST(MomentDrawing, NumbersOfThings) {
  const auto state = boost::make_shared<CableArray>();
  Cable& cable = state->cables.emplace_back();
  cable.name = "second";
  cable.positions.resize(2);
  cable.positions[1].x = 1;
  const auto appearance = boost::make_shared<Appearance>();
  for (const char* name : {"first", "second"}) {
    Look& look = appearance->looks.emplace_back();
    look.name = name;
    look.radii = {0.01};
  }
  appearance->bodies = {"plug"};
  Solid& floor = appearance->solids.emplace_back();
  floor.name = "floor";
  floor.pose.orientation.w = 1;
  Solid& link = appearance->solids.emplace_back();
  link.name = "hand";
  link.owner = Solid::LINK;
  link.type = Solid::SPHERE;
  link.radius = 0.1;
  link.pose.orientation.w = 1;
  MeshShelf meshes;
  const view::Drawing drawing = drawing_of({state, appearance}, {}, {}, {"table", "hand"}, meshes);
  EXPECT_EQ(view::labels(drawing), (std::vector<std::string>{"first", "second", "plug", "table", "hand", "floor"}));
  EXPECT_TRUE(view::validate(drawing).empty());
  EXPECT_TRUE(drawing.things[0].tubes.empty());
  EXPECT_EQ(drawing.things[1].tubes.size(), 1u);
  EXPECT_EQ(drawing.things[4].parts.size(), 1u);
  for (const int i : {0, 1}) EXPECT_EQ(drawing.things[i].kind, view::Thing::Kind::cable);
  // Of a bag without appearances.
  EXPECT_EQ(view::labels(drawing_of({state, nullptr}, {}, {}, {}, meshes)), std::vector<std::string>{"second"});
}

/// 1 + `cable_id` of the topic `points`: cables, then nets, then particles, and after them bodies. They are told apart as in a
/// world.
TEST(MomentDrawing, NetsAndParticlesAreNumberedWithCables) {
  const auto state = boost::make_shared<CableArray>();
  state->cables.emplace_back().name = "rope";
  state->cables.back().radius = 0.01;
  state->cables.back().positions.resize(2);
  state->cables.back().positions[1].x = 1;
  state->nets.emplace_back().name = "net";
  state->particles.emplace_back().name = "ball";
  state->bodies.emplace_back().name = "plug";
  MeshShelf meshes;
  const view::Drawing drawing = drawing_of({state, nullptr}, {}, {}, {}, meshes);
  EXPECT_EQ(view::labels(drawing), (std::vector<std::string>{"rope", "net", "ball", "plug"}));
  using Kind = view::Thing::Kind;
  const Kind kinds[] = {Kind::cable, Kind::net, Kind::particle, Kind::body};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(drawing.things[i].kind, kinds[i]) << i;
  EXPECT_TRUE(view::validate(drawing).empty());
}

}  // namespace
}  // namespace verlet_cable
