#include "harness.h"

#include <algorithm>

#include "scene/keys.h"
#include "scene/yaml_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr int most_markers = 10000;
constexpr const char* marker_words = "the number of a marker, from 0";
constexpr const char* markers_words = "[first, last]: markers along the cable, numbered one after the other";
constexpr const char* held_words =
    "two neighbouring markers at the end of a cable, of which the outer one is where it is held, or one marker that has others "
    "of "
    "its cable on both sides";

int read_marker(const Value& value) {
  const int marker = read_integer(value, marker_words);
  if (marker >= 0 && marker < most_markers) return marker;
  value.reject(marker_words);
  return 0;
}

void read_markers(const Value& value, HarnessCable& cable) {
  if (!value.node.IsSequence() || value.node.size() != 2) return value.reject(markers_words);
  cable.first_marker = read_marker(value.element(0, value.node[0]));
  cable.last_marker = read_marker(value.element(1, value.node[1]));
  if (cable.last_marker < cable.first_marker) value.reject(markers_words);
}

Key<HarnessCable> positive_key(const char* name, double HarnessCable::*member, const char* unit) {
  const std::string allowed = positive.text(unit);
  return {name, allowed, false, [=](const Value& value, HarnessCable& cable) {
            cable.*member = read_number(value, allowed);
            if (positive.contains(cable.*member)) return;
            value.reject(allowed);
            cable.*member = 0;
          }};
}

const Keys<HarnessCable>& cable_keys() {
  static const Keys<HarnessCable> keys{
      text_key("name", &HarnessCable::name, name_words, true),
      {"markers", markers_words, true, read_markers},
      {"from", marker_words, false, [](const Value& value, HarnessCable& cable) { cable.from = read_marker(value); }},
      positive_key("linear_density", &HarnessCable::linear_density, "kg/m"),
      positive_key("radius", &HarnessCable::radius, "m"),
  };
  return keys;
}

const Keys<Harness>& harness_keys() {
  static const Keys<Harness> keys{
      {"cables", "a list of cables", true,
       [](const Value& value, Harness& harness) {
         harness.cables = read_list<HarnessCable>(
             value, [](const Value& element, HarnessCable& cable) { read_map(element, cable_keys(), cable); });
       }},
      {"held", "a list of markers", true,
       [](const Value& value, Harness& harness) {
         if (!value.node.IsSequence()) return value.reject("a list of markers");
         for (const auto& node : value.node) harness.held.push_back(read_marker(value.element(harness.held.size(), node)));
         std::sort(harness.held.begin(), harness.held.end());
       }},
  };
  return keys;
}

bool has_marker(const HarnessCable& cable, int marker) {
  return cable.first_marker <= marker && marker <= cable.last_marker;
}

void check_cables(const Harness& harness, ErrorList& errors) {
  int next = 0;
  for (std::size_t i = 0; i < harness.cables.size(); ++i) {
    const HarnessCable& cable = harness.cables[i];
    const std::string key = "cables[" + std::to_string(i) + "].";
    if (!is_name(cable.name)) errors.add(key + "name", in_quotes(cable.name), name_words);
    for (std::size_t k = 0; k < i; ++k)
      if (harness.cables[k].name == cable.name) errors.add(key + "name", in_quotes(cable.name), "a name that no other cable has");
    if (cable.first_marker != next)
      errors.add(key + "markers", "[" + std::to_string(cable.first_marker) + ", " + std::to_string(cable.last_marker) + "]",
                 "from " + std::to_string(next) + " on, behind those of the cable before");
    next = cable.last_marker + 1;
    const std::string from = cable.from < 0 ? "missing" : std::to_string(cable.from);
    if (i == 0 && cable.from >= 0) errors.add(key + "from", from, "none: the first cable is the trunk");
    if (i > 0 && (cable.from < 0 || cable.from >= cable.first_marker))
      errors.add(key + "from", from, "the marker of a cable before it in the list, at which it leaves that");
    if (i == 0 && cable.last_marker < cable.first_marker + 3) errors.add(key + "markers", "too few", "four or more on the trunk");
  }
}

/// Whether held markers of this place are as `held_words` says.
bool is_held_right(const Harness& harness, const HarnessHold& hold) {
  const HarnessCable& cable = harness.cables[hold.cable];
  if (hold.at_start || hold.at_end) return hold.second >= 0 && (hold.cable == 0 || !hold.at_start);
  return hold.second < 0 && hold.marker > cable.first_marker && hold.marker < cable.last_marker;
}

void check_held(const Harness& harness, ErrorList& errors) {
  const std::vector<HarnessHold> holds = holds_of(harness);
  bool holds_trunk = false;
  for (const HarnessHold& hold : holds) {
    if (!is_held_right(harness, hold)) errors.add("held", "marker " + std::to_string(hold.marker), held_words);
    holds_trunk = holds_trunk || hold.cable == 0;
  }
  if (!holds_trunk) errors.add("held", "none on the trunk", held_words);
  if (!harness.held.empty() && harness.held.back() >= marker_count(harness))
    errors.add("held", "marker " + std::to_string(harness.held.back()), "markers of the cables");
}

}  // namespace

Harness read_harness(const std::string& path, std::vector<std::string>& errors) {
  Harness harness;
  ErrorList found;
  try {
    read_yaml_text(scene_file_text(path), [&](const YAML::Node& root) {
      const Value value{root, "", &found};
      if (!root.IsMap()) return value.reject("a map with `cables` and `held`");
      read_map(value, harness_keys(), harness);
      if (!found.empty()) return;
      if (harness.cables.empty()) return found.add("cables", "none", "at least one, the trunk");
      check_cables(harness, found);
      if (found.empty()) check_held(harness, found);
    });
  } catch (const SceneError& error) {
    for (const std::string& line : error.errors()) errors.push_back(path + ": " + line);
  }
  for (const std::string& line : found.take()) errors.push_back(path + ": " + line);
  return harness;
}

void check_markers(const Harness& harness, const std::vector<Recording>& recordings, std::vector<std::string>& errors) {
  for (const Recording& recording : recordings)
    if (recording.marker_count() != marker_count(harness))
      errors.push_back(recording.path + ": " + std::to_string(recording.marker_count()) +
                       " markers; allowed: " + std::to_string(marker_count(harness)) + ", as the harness has");
}

int marker_count(const Harness& harness) {
  return harness.cables.back().last_marker + 1;
}

int cable_of(const Harness& harness, int marker) {
  const auto found = std::find_if(harness.cables.begin(), harness.cables.end(),
                                  [&](const HarnessCable& cable) { return has_marker(cable, marker); });
  return static_cast<int>(found - harness.cables.begin());
}

std::vector<int> markers_along(const HarnessCable& cable) {
  std::vector<int> markers;
  if (cable.from >= 0) markers.push_back(cable.from);
  for (int marker = cable.first_marker; marker <= cable.last_marker; ++marker) markers.push_back(marker);
  return markers;
}

std::vector<HarnessHold> holds_of(const Harness& harness) {
  std::vector<HarnessHold> holds;
  for (std::size_t i = 0; i < harness.held.size(); ++i) {
    const int marker = harness.held[i], cable = cable_of(harness, marker);
    if (cable == static_cast<int>(harness.cables.size())) continue;
    const HarnessCable& on = harness.cables[cable];
    const bool has_next = i + 1 < harness.held.size() && harness.held[i + 1] == marker + 1 && has_marker(on, marker + 1);
    HarnessHold hold{cable, marker, -1, marker == on.first_marker, marker == on.last_marker};
    if (has_next) {
      hold.at_end = marker + 1 == on.last_marker;
      hold.marker = hold.at_end ? marker + 1 : marker;
      hold.second = hold.at_end ? marker : marker + 1;
      ++i;
    }
    holds.push_back(hold);
  }
  return holds;
}

}  // namespace verlet_cable::cable_fit
