#include "prediction.h"

#include <algorithm>
#include <cmath>

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

/// The markers on the hands are where the hands are.
void place_held(const HeldEnds& ends, double time, const std::array<double, 2>& held, std::vector<Vector3>& markers) {
  const Pose start = ends.start.at(time), end = ends.end.at(time);
  const std::size_t last = markers.size() - 1;
  markers[0] = start.position;
  markers[1] = start.position + start.orientation * Vector3(held[0], 0, 0);
  markers[last - 1] = end.position - end.orientation * Vector3(held[1], 0, 0);
  markers[last] = end.position;
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

Prediction simulate(World& world, const FrameSource& frames, double time_step, const std::vector<double>& times,
                    const std::function<std::vector<Vector3>()>& markers) {
  Prediction prediction;
  std::vector<Vector3> positions = markers(), before = positions;
  for (const double time : times) {
    // The first step at or after the row; rounding does not add one.
    const auto step = static_cast<std::int64_t>(std::ceil(time / time_step - 1e-6));
    while (world.steps() < step && prediction.sound) {
      const StepResult result = world.step(frames.at(static_cast<double>(world.steps() + 1) * time_step));
      prediction.sound = result.status != StepResult::Status::fault;
      before = std::move(positions);
      positions = markers();
    }
    const double back = static_cast<double>(step) - time / time_step;
    std::vector<Vector3>& row = prediction.positions.emplace_back(positions);
    for (std::size_t i = 0; i < row.size(); ++i) row[i] += back * (before[i] - positions[i]);
  }
  return prediction;
}

Prediction predict(const SceneDesc& cable, const Markers& markers, const Recording& recording) {
  return predict(cable, markers, recording, held_ends(markers, recording), false);
}

Prediction predict(const SceneDesc& cable, const Markers& markers, const Recording& recording, const HeldEnds& ends,
                   bool smooth_start) {
  SceneDesc scene = cable;
  scene.cables.front().attachments = clamps(markers);
  const FrameSource frames(scene, {{start_frame, ends.start}, {end_frame, ends.end}});
  start_along(markers, recording, frames.at(0), smooth_start, scene);
  World world(scene, frames.at(0));

  Prediction prediction = simulate(world, frames, scene.time_step, recording.times,
                                   [&] { return marker_positions(world.cables().front(), markers); });
  if (markers.offsets.empty()) return prediction;
  for (int row = 0; row < recording.rows(); ++row)
    place_held(ends, recording.times[row], markers.held, prediction.positions[row]);
  return prediction;
}

}  // namespace verlet_cable::cable_fit
