#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "cable_fit/prediction.h"
#include "scene/frame_source.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_fit {

/// [m] between the two markers on a hand.
constexpr double held_distance = 0.025;

/// A cable of known material, without natural curvature. What lies between the markers on a hand is held and does not bend.
inline SceneDesc known_cable() {
  SceneDesc scene;
  scene.time_step = 0.001;
  NamedMaterial& material = scene.materials.emplace_back();
  material.name = "known";
  material.material.linear_density = 0.08;
  material.material.radius = 0.004;
  material.material.bending_stiffness = 1.5e-3;
  material.material.torsional_stiffness = 1.2e-3;
  material.material.bending_damping = 3e-5;
  material.material.drag = 0.03;
  CableDesc& cable = scene.cables.emplace_back();
  cable.name = "known";
  cable.material = "known";
  cable.length = 1.0;
  cable.segments = 40;
  cable.stiff_ends = {held_distance, held_distance};
  // Hardly any, as real cables have it: a fit looks for a curved one, which is a rod of material frames.
  cable.rest_curvature.type = RestCurvatureDesc::Type::constant;
  cable.rest_curvature.curvature = {0.02, 0};
  return scene;
}

/// A recording as a camera would make it, at 100 Hz: 8 markers on the cable and two on each of the hands that hold it, noise on
/// every coordinate [m], another for every `seed`. Hands at its ends swing it, in another way for every `take`. Their markers are
/// `hand_offset` [m] off the cable's centre line, along the hands' axes.
inline Recording synthetic_recording(const SceneDesc& known, int take, double duration, double noise, int seed = 0,
                                     const Vector3& hand_offset = Vector3::Zero()) {
  SceneDesc scene = known;
  CableDesc& cable = scene.cables.front();
  FrameTrack start, end;
  const double pace = 5 + 0.7 * take;
  for (int row = 0; row <= static_cast<int>(duration * 100) + 1; ++row) {
    const double t = 0.01 * row, swing = 0.5 - 0.5 * std::cos(pace * t),
                 other = 0.5 - 0.5 * std::cos((0.6 + 0.3 * take) * pace * t);
    start.add(t, {{0.1 * swing, 0.15 * other, 0.05 * swing}, quaternion_from_rpy({0, 0.5 + 0.3 * swing, 0.2 * other})});
    end.add(t, {{0.6 - 0.1 * other, -0.1 * swing, 0.1 * other}, quaternion_from_rpy({0, -0.5 - 0.2 * other, -0.3 * swing})});
  }
  AttachmentDesc clamp;
  clamp.name = clamp.frame = "start_hand";
  clamp.type = AttachmentType::clamp;
  cable.attachments.push_back(clamp);
  clamp.name = clamp.frame = "end_hand";
  clamp.place.at = PlaceDesc::At::end;
  cable.attachments.push_back(clamp);
  cable.initial.type = InitialShapeDesc::Type::settled;
  const FrameSource frames(scene, {{"start_hand", start}, {"end_hand", end}});
  World world(scene, frames.at(0));

  Recording recording;
  recording.path = "take" + std::to_string(take);
  std::mt19937 random(static_cast<unsigned>(seed + take));
  std::normal_distribution<double> scatter(0, 1);
  for (int row = 0; row <= static_cast<int>(duration * 100); ++row) {
    while (world.steps() < 10 * row) world.step(frames.at(static_cast<double>(world.steps() + 1) * scene.time_step));
    recording.times.push_back(0.01 * row);
    std::vector<Vector3>& markers = recording.markers.emplace_back();
    const std::vector<Vector3>& nodes = world.cables().front().state.positions;
    const Vector3 to_second(held_distance, 0, 0);
    const Pose first = start.at(0.01 * row), last = end.at(0.01 * row);
    const auto on = [](const Pose& pose, const Vector3& point) -> Vector3 { return pose.position + pose.orientation * point; };
    markers = {on(first, hand_offset), on(first, hand_offset + to_second)};
    for (const int node : {5, 9, 13, 17, 22, 26, 30, 35}) markers.push_back(nodes[node]);
    markers.insert(markers.end(), {on(last, hand_offset - to_second), on(last, hand_offset)});
    for (Vector3& marker : markers)
      for (int axis = 0; axis < 3; ++axis) marker[axis] += noise * scatter(random);
  }
  return recording;
}

}  // namespace verlet_cable::cable_fit
