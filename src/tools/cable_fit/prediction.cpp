#include "prediction.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "start.h"

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

SceneDesc held_cable(SceneDesc cable, const Markers& markers) {
  cable.cables.front().attachments = clamps(markers);
  return cable;
}

FrameSource frames_of(const SceneDesc& scene, const HeldEnds& ends) {
  return {scene, {{start_frame, ends.start}, {end_frame, ends.end}}};
}

/// Where markers sit beside the cable, those on the hands are where the hands are.
void place_held(const Markers& markers, const Recording& recording, const HeldEnds& ends, Prediction& prediction) {
  if (markers.offsets.empty()) return;
  for (int row = 0; row < recording.rows(); ++row) {
    const double time = recording.times[row];
    const Pose start = ends.start.at(time), end = ends.end.at(time);
    std::vector<Vector3>& positions = prediction.positions[row];
    const std::size_t last = positions.size() - 1;
    positions[0] = start.position;
    positions[1] = start.position + start.orientation * Vector3(markers.held[0], 0, 0);
    positions[last - 1] = end.position - end.orientation * Vector3(markers.held[1], 0, 0);
    positions[last] = end.position;
  }
}

}  // namespace

std::vector<AttachmentDesc> clamps(const Markers& markers) {
  std::vector<AttachmentDesc> clamps = {clamp("start", PlaceDesc::At::start, start_frame),
                                        clamp("end", PlaceDesc::At::end, end_frame)};
  if (markers.offsets.empty()) return clamps;
  clamps[0].offset = {0, -markers.offsets.front()[0], -markers.offsets.front()[1]};
  clamps[1].offset = {0, -markers.offsets.back()[0], -markers.offsets.back()[1]};
  return clamps;
}

HeldEnds held_ends(const Markers& markers, const Recording& recording) {
  return markers.offsets.empty() ? held_ends(recording) : held_ends(recording, markers.usual_directions);
}

Course::Course(World world, MarkersIn markers)
    : world_(std::move(world)), markers_(std::move(markers)), positions_(markers_(world_)), before_(positions_) {}

std::vector<Vector3> Course::at(double time, const FrameSource& frames) {
  const double time_step = world_.time_step();
  // The first step at or after the time; rounding does not add one.
  const auto step = static_cast<std::int64_t>(std::ceil(time / time_step - 1e-6));
  while (world_.steps() < step && is_sound_) {
    const StepResult result = world_.step(frames.at(static_cast<double>(world_.steps() + 1) * time_step));
    is_sound_ = result.status != StepResult::Status::fault;
    before_ = std::move(positions_);
    positions_ = markers_(world_);
  }
  const double back = static_cast<double>(step) - time / time_step;
  std::vector<Vector3> result = positions_;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] += back * (before_[i] - positions_[i]);
  return result;
}

Prediction simulate(Course course, const FrameSource& frames, const std::vector<double>& times) {
  Prediction prediction;
  for (const double time : times) prediction.positions.push_back(course.at(time, frames));
  prediction.sound = course.is_sound();
  return prediction;
}

Prediction predict(const SceneDesc& cable, const Markers& markers, const Recording& recording) {
  return predict(cable, markers, recording, held_ends(markers, recording), false);
}

Prediction predict(const SceneDesc& cable, const Markers& markers, const Recording& recording, const HeldEnds& ends,
                   bool smooth_start) {
  return predict_by({}, cable, markers, recording, ends, smooth_start).prediction;
}

Waypoints predict_by(std::vector<int> rows, const SceneDesc& cable, const Markers& markers, const Recording& recording,
                     const HeldEnds& ends, bool smooth_start) {
  SceneDesc scene = held_cable(cable, markers);
  const FrameSource frames = frames_of(scene, ends);
  start_along(markers, recording, frames.at(0), smooth_start, scene);
  Course course(World(scene, frames.at(0)),
                [markers](const World& world) { return marker_positions(world.cables().front(), markers); });
  Waypoints result{std::move(rows), {}, {}};
  for (int row = 0; row < recording.rows(); ++row) {
    result.prediction.positions.push_back(course.at(recording.times[row], frames));
    if (std::binary_search(result.rows.begin(), result.rows.end(), row)) result.courses.push_back(course);
  }
  result.prediction.sound = course.is_sound();
  place_held(markers, recording, ends, result.prediction);
  return result;
}

Prediction predict_on(const Waypoints& waypoints, std::size_t which, const SceneDesc& cable, const Markers& markers,
                      const Recording& recording, const HeldEnds& ends) {
  const FrameSource frames = frames_of(held_cable(cable, markers), ends);
  Course course = waypoints.courses[which];
  Prediction prediction = waypoints.prediction;
  for (int row = waypoints.rows[which] + 1; row < recording.rows(); ++row)
    prediction.positions[row] = course.at(recording.times[row], frames);
  prediction.sound = course.is_sound();
  place_held(markers, recording, ends, prediction);
  return prediction;
}

}  // namespace verlet_cable::cable_fit
