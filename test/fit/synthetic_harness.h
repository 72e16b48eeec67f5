#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "cable_fit/harness.h"
#include "cable_fit/prediction.h"

namespace verlet_cable::cable_fit {

/// A trunk of 0.7 m with markers 0 to 7, of which hands hold the outer two, and a branch of 0.16 m with markers 8 to 10, which
/// leaves it at marker 3. The branch is twice as stiff and half as heavy as the trunk: it hardly bends.
inline Harness known_markers() {
  return {{{"trunk", 0, 7, -1, 0.08, 0.004}, {"branch", 8, 10, 3, 0, 0}}, {0, 1, 6, 7}};
}

constexpr int trunk_nodes[] = {0, 2, 8, 15, 21, 28, 33, 35};
constexpr int branch_nodes[] = {2, 5, 8};

inline SceneDesc known_harness() {
  SceneDesc scene;
  scene.time_step = 0.001;
  MaterialDesc material;
  material.linear_density = 0.08;
  material.radius = 0.004;
  material.bending_stiffness = 2e-3;
  material.torsional_stiffness = 1.6e-3;
  material.bending_damping = 6e-5;
  material.torsional_damping = 4.8e-5;
  material.drag = 0.02;
  scene.materials.push_back({"trunk", material});
  material.linear_density = 0.04;
  material.bending_stiffness = 4e-3;
  material.torsional_stiffness = 3.2e-3;
  scene.materials.push_back({"branch", material});
  CableDesc& trunk = scene.cables.emplace_back();
  trunk.name = trunk.material = "trunk";
  trunk.length = 0.7;
  trunk.segments = 35;
  trunk.stiff_ends = {0.04, 0.04};
  // Hardly any, as real cables have it: a fit looks for curved ones, which are rods of material frames.
  trunk.rest_curvature.type = RestCurvatureDesc::Type::constant;
  trunk.rest_curvature.curvature = {0.02, 0};
  CableDesc branch = trunk;
  branch.name = branch.material = "branch";
  branch.length = 0.16;
  branch.segments = 8;
  branch.stiff_ends = {0, 0};
  scene.cables.push_back(branch);
  JunctionDesc& junction = scene.junctions.emplace_back();
  junction.name = "fork";
  junction.cable = "trunk";
  junction.place = {PlaceDesc::At::arc_length, 0.3};
  junction.branches.push_back({"branch", BranchDesc::End::start, {0, 0, 1.2}});
  return scene;
}

/// A recording of it at 100 Hz, of hands that swing in another way for every `take`.
inline Recording synthetic_harness_recording(int take, double duration) {
  SceneDesc scene = known_harness();
  FrameTrack start, end;
  const double pace = 5 + 0.9 * take;
  for (int row = 0; row <= static_cast<int>(duration * 100) + 1; ++row) {
    const double t = 0.01 * row, swing = 0.5 - 0.5 * std::cos(pace * t), other = 0.5 - 0.5 * std::cos(1.3 * pace * t);
    start.add(t, {{0.08 * swing, 0.12 * other, 0.05 * swing}, quaternion_from_rpy({0, 0.5 + 0.3 * swing, 0.2 * other})});
    end.add(t, {{0.5 - 0.08 * other, -0.1 * swing, 0.1 * other}, quaternion_from_rpy({0, -0.5 - 0.2 * other, -0.3 * swing})});
  }
  AttachmentDesc clamp;
  clamp.name = clamp.frame = "start_hand";
  clamp.type = AttachmentType::clamp;
  scene.cables[0].attachments.push_back(clamp);
  clamp.name = clamp.frame = "end_hand";
  clamp.place.at = PlaceDesc::At::end;
  scene.cables[0].attachments.push_back(clamp);
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  const FrameSource frames(scene, {{"start_hand", start}, {"end_hand", end}});
  World world(scene, frames.at(0));
  Recording recording;
  recording.path = "take" + std::to_string(take);
  for (int row = 0; row <= static_cast<int>(duration * 100); ++row) {
    while (world.steps() < 10 * row) world.step(frames.at(static_cast<double>(world.steps() + 1) * scene.time_step));
    recording.times.push_back(0.01 * row);
    std::vector<Vector3>& markers = recording.markers.emplace_back();
    for (const SimulatedCable& cable : world.cables()) {
      if (cable.model->name == "trunk")
        for (const int node : trunk_nodes) markers.push_back(cable.state.positions[node]);
      else
        for (const int node : branch_nodes) markers.push_back(cable.state.positions[node]);
    }
  }
  return recording;
}

}  // namespace verlet_cable::cable_fit
