#include "verlet_cable/scene/scene_reader.h"

#include <algorithm>

#include "body_keys.h"
#include "cable_keys.h"
#include "guide_keys.h"
#include "junction_keys.h"
#include "keys.h"
#include "material_keys.h"
#include "material_presets.h"
#include "net_keys.h"
#include "obstacle_keys.h"
#include "scene_files.h"
#include "verlet_cable/core/frame_keys.h"
#include "within_memory.h"

namespace verlet_cable {
namespace {

void read_gravity(const Value& value, SceneDesc& scene) {
  if (!value.node.IsMap()) {
    scene.gravity.acceleration = read_vector(value, "m/s^2");
    return;
  }
  static const Keys<GravityDesc> central = [] {
    Keys<GravityDesc> keys{choice_key("type", &GravityDesc::type, {{"central", GravityDesc::Type::central}}, true),
                           vector_key("center", &GravityDesc::center, "m")};
    append_fields(keys, gravity_fields);
    return keys;
  }();
  read_map(value, central, scene.gravity);
}

void read_limits(const Value& value, SceneDesc& scene) {
  static const Keys<LimitsDesc> keys = [] {
    Keys<LimitsDesc> limits;
    append_fields(limits, limits_fields);
    return limits;
  }();
  read_map(value, keys, scene.limits);
}

void read_wave(const Value& value, WaveDesc& wave) {
  static const Keys<WaveDesc> keys = [] {
    Keys<WaveDesc> all;
    append_fields(all, wave_fields);
    return all;
  }();
  read_map(value, keys, wave);
}

void read_fluid(const Value& value, SceneDesc& scene) {
  static const Keys<FluidDesc> keys = [] {
    Keys<FluidDesc> fluid{vector_key("velocity", &FluidDesc::velocity, "m/s"),
                          {"waves", "a list of waves", false,
                           [](const Value& value, FluidDesc& fluid) { fluid.waves = read_list<WaveDesc>(value, read_wave); }}};
    append_fields(fluid, fluid_fields);
    return fluid;
  }();
  read_map(value, keys, scene.fluid);
}

Keys<SceneDesc> scene_keys(const std::vector<std::string>& ignored) {
  Keys<SceneDesc> keys{
      text_key("frame_id", &SceneDesc::frame_id, frame_words),
      vector_key("origin", &SceneDesc::origin, "m"),
      switch_key("numerical_damping", &SceneDesc::numerical_damping),
      {"gravity", "three numbers [m/s^2]", false, read_gravity},
      {"fluid", "a map", false, read_fluid},
      choice_key("on_lost_frame", &SceneDesc::on_lost_frame,
                 {{"hold", LostFramePolicy::hold}, {"release", LostFramePolicy::release}, {"pause", LostFramePolicy::pause}}),
      choice_key("on_time_jump", &SceneDesc::on_time_jump, {{"reset", TimeJumpPolicy::reset}, {"keep", TimeJumpPolicy::keep}}),
      choice_key("marker_style", &SceneDesc::marker_style, {{"tube", MarkerStyle::tube}, {"line", MarkerStyle::line}}),
      choice_key("color_by", &SceneDesc::color_by,
                 {{"cable", ColorBy::cable},
                  {"tension", ColorBy::tension},
                  {"strain", ColorBy::strain},
                  {"contact", ColorBy::contact},
                  {"bend", ColorBy::bend}}),
      text_key("scene_directory", &SceneDesc::scene_directory, "a directory, or \"\""),
      {"limits", "a map", false, read_limits},
      {"materials", "a map of names to materials", false,
       [](const Value& value, SceneDesc& scene) { scene.materials = read_materials(value); }},
      {"cables", "a list of cables", false,
       [](const Value& value, SceneDesc& scene) { scene.cables = read_list<CableDesc>(value, read_cable); }},
  };
  append_net_keys(keys);
  append_obstacle_keys(keys);
  append_body_keys(keys);
  append_junction_keys(keys);
  append_guide_keys(keys);
  append_fields(keys, scene_fields);
  append_fields(keys, scene_integer_fields);
  for (const std::string& name : ignored) keys.push_back({name, "anything", false, [](const Value&, SceneDesc&) {}});
  return keys;
}

/// Adds the presets that cables name to the scene's own materials. A name that is neither is an error.
void add_presets(const Value& root, SceneDesc& scene) {
  const std::vector<NamedMaterial>& presets = material_presets();
  const std::string own = material_names(scene.materials);
  const auto add = [&](const std::string& name, const std::string& key) {
    if (scene.find_material(name) || root.errors->is_unread(key)) return;
    const auto preset = std::find_if(presets.begin(), presets.end(), [&](const auto& material) { return material.name == name; });
    if (preset != presets.end()) {
      scene.materials.push_back(*preset);
    } else {
      root.errors->add_unread(key, in_quotes(name),
                              "a material of the scene (" + own + "), or one that is shipped (" + material_names(presets) + ")");
    }
  };
  for (std::size_t i = 0; i < scene.cables.size(); ++i) {
    const Value cable = root.child("cables", {}).element(i, {});
    add(scene.cables[i].material, cable.key + ".material");
    for (std::size_t k = 0; k < scene.cables[i].sections.size(); ++k)
      add(scene.cables[i].sections[k].material, cable.child("sections", {}).element(k, {}).key + ".material");
  }
}

/// A scene is of something that moves.
void check_not_empty(const Value& root, const std::set<std::string>& given, const SceneDesc& scene) {
  if (!scene.cables.empty() || !scene.nets.empty() || !scene.particles.empty() || !scene.bodies.empty()) return;
  const char* allowed = "a list of at least one cable, or `nets`, `particles` or `bodies`";
  const Value cables = root.child("cables", given.count("cables") ? root.node["cables"] : YAML::Node{});
  if (!given.count("cables")) root.errors->add_unread(cables.key, "missing", allowed);
  if (cables.node.IsSequence()) cables.reject(allowed);
}

/// Whoever gives a cable a color wants to see it.
ColorBy natural_colors(const YAML::Node& cables) {
  const auto has_color = [](const YAML::Node& cable) { return cable.IsMap() && cable["color"]; };
  return cables.IsSequence() && std::any_of(cables.begin(), cables.end(), has_color) ? ColorBy::cable : SceneDesc{}.color_by;
}

/// Who draws relative to the scene's `origin` sends that place as a frame of its own.
void check_origin_frame(const std::string& frame, const SceneDesc& scene, ErrorList& errors) {
  if (frame.empty() || scene.origin.isZero(0)) return;
  for (const std::string& key : keys_of_frame(scene, frame))
    errors.add(key, in_quotes(frame), "other names: with `origin`, the frame of this name is that of the markers and clouds");
}

SceneDesc read_all(const YAML::Node& root, const std::vector<std::string>& ignored, const SceneSources& sources) {
  SceneDesc scene;
  ErrorList errors;
  const Value value{root, "", &errors};
  if (root.IsMap()) {
    const std::set<std::string> given = read_map(value, scene_keys(ignored), scene);
    if (given.count("color_by") == 0 && given.count("cables") > 0) scene.color_by = natural_colors(root["cables"]);
    check_not_empty(value, given, scene);
    add_presets(value, scene);
    read_scene_files(value, sources, scene);
    errors.add_validation(validate(scene));
    check_origin_frame(sources.origin_frame, scene, errors);
  } else {
    errors.add("scene", value_text(root), "a map of keys: materials, cables, ...");
  }
  if (!errors.empty()) throw SceneError(errors.take());
  return scene;
}

}  // namespace

ObstacleDesc read_obstacle(const YAML::Node& keys, const SceneSources& sources) {
  return within_memory([&] {
    YAML::Node root;
    root["obstacles"].push_back(keys);
    SceneDesc scene;
    ErrorList errors;
    const Value value{root, "", &errors};
    static const Keys<SceneDesc> obstacle_keys = [] {
      Keys<SceneDesc> all;
      append_obstacle_keys(all);
      return all;
    }();
    read_map(value, obstacle_keys, scene);
    read_scene_files(value, sources, scene);
    errors.add_validation(validate(scene));
    if (errors.empty()) return scene.obstacles.front();
    const std::string key = value.child("obstacles", {}).element(0, {}).key + ".";
    std::vector<std::string> lines = errors.take();
    for (std::string& line : lines)
      if (line.compare(0, key.size(), key) == 0) line.erase(0, key.size());
    throw SceneError(lines);
  });
}

SceneDesc read_scene(const YAML::Node& root, const std::vector<std::string>& ignored, const SceneSources& sources) {
  return within_memory([&] { return read_all(root, ignored, sources); });
}

}  // namespace verlet_cable
