#include "scene_yaml.h"

#include "report.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable::cable_fit {
namespace {

void append(const std::string& indent, const char* key, const std::string& value, std::string& yaml) {
  yaml += indent + key + ": " + value + "\n";
}

std::string frames_text(const HeldDirections& usual) {
  return "Frames: origins in the outer markers, x along the cable, from start to end.\n"
         "# Their roll: the world's axes, turned the smallest way to x = " +
         vector_text(usual[0]) + " at the start, " + vector_text(usual[1]) + " at the end, and from there to each row's x.\n";
}

}  // namespace

std::string vector_text(const Vector3& v) {
  return "[" + number_text(v.x()) + ", " + number_text(v.y()) + ", " + number_text(v.z()) + "]";
}

std::string materials_yaml(const SceneDesc& scene) {
  std::string yaml = "materials:\n";
  const MaterialDesc plain;
  for (const NamedMaterial& material : scene.materials) {
    yaml += "  " + material.name + ":\n";
    for (const Field<MaterialDesc>& field : material_fields)
      if (material.material.*field.member != plain.*field.member)
        append("    ", field.key, number_text(material.material.*field.member), yaml);
    // Cables are fitted that bend alike about all axes.
    append("    ", bending_stiffness_field.key, number_text(material.material.bending_stiffness.front()), yaml);
  }
  return yaml;
}

std::string plain_cable_yaml(const CableDesc& cable) {
  std::string yaml;
  append("  - ", "name", cable.name, yaml);
  append("    ", "length", number_text(cable.length), yaml);
  append("    ", "segments", std::to_string(cable.segments), yaml);
  append("    ", "material", cable.material, yaml);
  return yaml;
}

std::string cable_yaml(const CableDesc& cable) {
  std::string yaml = plain_cable_yaml(cable);
  append("    ", "stiff_ends", "[" + number_text(cable.stiff_ends[0]) + ", " + number_text(cable.stiff_ends[1]) + "]", yaml);
  yaml += "    rest_curvature:\n";
  for (const auto& curvature : cable.rest_curvature.profile)
    yaml += "      - [" + number_text(curvature[0]) + ", " + number_text(curvature[1]) + "]\n";
  return yaml;
}

std::string scene_yaml(const Fit& fit) {
  const auto& [problem, result] = fit;
  const SceneDesc scene = cable_scene(problem.settings, result.values);
  const std::size_t recordings = problem.recordings.size();
  std::string yaml = "# Fitted by cable_fit to " + std::to_string(recordings) + (recordings == 1 ? " recording" : " recordings") +
                     (problem.settings.centre_line ? ". " + frames_text(problem.settings.usual_directions)
                                                   : ". To be a scene, the cable needs `attachments`.\n");
  append("", "time_step", number_text(scene.time_step), yaml);
  yaml += materials_yaml(scene) + "cables:\n" + cable_yaml(scene.cables.front());
  if (!problem.settings.centre_line) return yaml;
  yaml += "    attachments:\n";
  for (const AttachmentDesc& clamp : clamps(markers_of(problem.settings, result.values)))
    yaml += "      - {name: " + clamp.name + ", at: " + clamp.name + ", frame: " + clamp.frame +
            ", type: clamp, offset: " + vector_text(clamp.offset) + "}\n";
  return yaml;
}

}  // namespace verlet_cable::cable_fit
