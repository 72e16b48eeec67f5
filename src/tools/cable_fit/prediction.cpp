#include "prediction.h"

#include <algorithm>
#include <cmath>

#include "cable_sim/frame_source.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr const char* start_frame = "start_gripper";
constexpr const char* end_frame = "end_gripper";

AttachmentDesc clamp(const char* name, PlaceDesc::At at, const char* frame) {
  AttachmentDesc desc;
  desc.name = name;
  desc.place.at = at;
  desc.frame = frame;
  desc.type = AttachmentType::clamp;
  return desc;
}

/// Where markers are on a cable's nodes: in which segment, and how far along it.
struct Place {
  int segment;
  double fraction;
};

std::vector<Place> places_on(int segments, const std::vector<double>& marker_places) {
  std::vector<Place> places;
  for (const double place : marker_places) {
    const int segment = std::min(static_cast<int>(place * segments), segments - 1);
    places.push_back({segment, place * segments - segment});
  }
  return places;
}

std::vector<Vector3> markers_on(const std::vector<Vector3>& nodes, const std::vector<Place>& places) {
  std::vector<Vector3> markers;
  for (const Place& place : places)
    markers.emplace_back((1 - place.fraction) * nodes[place.segment] + place.fraction * nodes[place.segment + 1]);
  return markers;
}

}  // namespace

SceneDesc scene_of(const SceneDesc& cable, const Recording& recording) {
  SceneDesc scene = cable;
  CableDesc& desc = scene.cables.front();
  desc.initial.type = InitialShapeDesc::Type::points;
  desc.initial.points = recording.markers.front();
  desc.initial.velocities = initial_velocities(recording);
  desc.attachments = {clamp("start", PlaceDesc::At::start, start_frame), clamp("end", PlaceDesc::At::end, end_frame)};
  return scene;
}

Prediction predict(const SceneDesc& cable, const std::vector<double>& marker_places, const Recording& recording) {
  const SceneDesc scene = scene_of(cable, recording);
  const HeldEnds ends = held_ends(recording);
  const cable_sim::FrameSource frames(scene, {{start_frame, ends.start}, {end_frame, ends.end}});
  const std::vector<Place> places = places_on(scene.cables.front().segments, marker_places);
  World world(scene, frames.at(0));
  const std::vector<Vector3>& nodes = world.cables().front().state.positions;

  Prediction prediction;
  std::vector<Vector3> markers = markers_on(nodes, places), before = markers;
  for (const double time : recording.times) {
    // The first step at or after the row; rounding does not add one.
    const auto step = static_cast<std::int64_t>(std::ceil(time / scene.time_step - 1e-6));
    while (world.steps() < step && prediction.sound) {
      const StepResult result = world.step(frames.at(static_cast<double>(world.steps() + 1) * scene.time_step));
      prediction.sound = result.status != StepResult::Status::fault;
      before = std::move(markers);
      markers = markers_on(nodes, places);
    }
    const double back = static_cast<double>(step) - time / scene.time_step;
    prediction.positions.push_back(markers);
    for (std::size_t i = 0; i < markers.size(); ++i) prediction.positions.back()[i] += back * (before[i] - markers[i]);
  }
  return prediction;
}

}  // namespace verlet_cable::cable_fit
