#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable::test {

inline std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  return at == std::string::npos ? "the text has no " + what : text.replace(at, what.size(), with);
}

/// A sound scene in the order of its keys; tests change a line of it.
inline const std::string sound_scene = R"(
frame_id: world
time_step: 0.002
gravity: [0, 0, -9.81]
materials:
  m: {linear_density: 0.1, radius: 0.005}
cables:
  - name: hose
    length: 1.0
    segments: 20
    material: m
    color: [0.1, 0.1, 0.1, 1.0]
    attachments:
      - {name: left, at: start, type: hinge}
      - {name: right, at: end, frame: hand, initial_pose: [0.7, 0, 0, 0, 0, 0], type: clamp}
    point_masses: [{at: 0.5, mass: 0.2}]
)";

/// The errors of a scene, none if it is sound.
inline std::vector<std::string> errors_of(const std::string& text) {
  try {
    read_scene_text(text);
  } catch (const SceneError& error) {
    return error.errors();
  }
  return {};
}

inline bool has_line(const std::vector<std::string>& lines, const std::string& start) {
  return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) { return line.rfind(start, 0) == 0; });
}

inline std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace verlet_cable::test
