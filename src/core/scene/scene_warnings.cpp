#include <algorithm>
#include <cmath>
#include <set>

#include "scene/scene_errors.h"
#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {
namespace {

/// Of a section's length, by which its ends may be elsewhere without a word.
constexpr double largest_shift = 0.05;

/// Sections consist of whole segments: their ends are nodes.
void warn_of_sections(const std::string& cable_key, const CableDesc& cable, std::vector<std::string>& warnings) {
  const double segment = cable.length / cable.segments;
  // A segment belongs to the section that its middle is in.
  const auto node_of = [&](double end) {
    return segment * std::min(std::max(0.0, std::ceil(end / segment - 0.5)), static_cast<double>(cable.segments));  // never -0
  };
  for (std::size_t k = 0; k < cable.sections.size(); ++k) {
    const SectionDesc& section = cable.sections[k];
    const double from = node_of(section.from), to = node_of(section.to);
    const double shift = std::max(std::abs(from - section.from), std::abs(to - section.to));
    if (shift <= largest_shift * (section.to - section.from)) continue;
    warnings.push_back(indexed(cable_key + ".sections", k) + ": " + number_text(section.from) + " to " + number_text(section.to) +
                       " m; simulated from " + rounded_text(from) + " to " + rounded_text(to) +
                       " m, as sections consist of whole segments, which are " + rounded_text(segment) +
                       " m long: more segments are shorter");
  }
}

/// Numbers beyond these are possible, but mostly in the wrong unit: by a factor of 1000.
constexpr double wrong_unit = 1e-3;
constexpr double thickest = 0.1;                   // radius over length
constexpr double lightest = 10, heaviest = 25000;  // [kg/m^3] foam, and more than tungsten
constexpr double longest = 1000;                   // [m]
constexpr double slowest_step = 0.05;              // [s]

/// "; did you mean 0.005 m (5 mm)?" of 5
std::string suggestion(double number, const std::string& unit, const std::string& small_unit) {
  return "; did you mean " + rounded_text(wrong_unit * number) + " " + unit + " (" + rounded_text(number) + " " + small_unit +
         ")?";
}

double density_of(double linear_density, double radius) {
  return linear_density / (M_PI * radius * radius);
}

bool is_matter(double density) {
  return density >= lightest && density <= heaviest;
}

void warn_of_density(const MaterialDesc& material, const std::string& name, std::vector<std::string>& warnings) {
  const double density = density_of(material.linear_density, material.radius);
  if (is_matter(density)) return;
  std::string text = "materials." + name + ": linear_density " + number_text(material.linear_density) + " kg/m and radius " +
                     number_text(material.radius) + " m are matter of " + rounded_text(density, 3) +
                     " kg/m^3; usual: " + number_text(lightest) + " to " + number_text(heaviest) + " kg/m^3";
  if (is_matter(density_of(wrong_unit * material.linear_density, material.radius)))
    text += suggestion(material.linear_density, "kg/m", "g/m");
  else if (is_matter(density_of(material.linear_density, wrong_unit * material.radius)))
    text += suggestion(material.radius, "m", "mm");
  warnings.push_back(text);
}

/// The thickest of a cable's materials.
const MaterialDesc* thickest_material(const SceneDesc& scene, const CableDesc& cable, std::string& name) {
  const MaterialDesc* found = nullptr;
  const auto consider = [&](const std::string& candidate) {
    const MaterialDesc* material = scene.find_material(candidate);
    if (!material || (found && found->radius >= material->radius)) return;
    found = material;
    name = candidate;
  };
  consider(cable.material);
  for (const SectionDesc& section : cable.sections) consider(section.material);
  return found;
}

/// Adds to `thick` the material whose radius is not that of a cable.
void warn_of_sizes(const SceneDesc& scene, const std::string& key, const CableDesc& cable, std::set<std::string>& thick,
                   std::vector<std::string>& warnings) {
  if (cable.length > longest)
    warnings.push_back(key + ".length: " + number_text(cable.length) + " m; usual: up to " + number_text(longest) + " m" +
                       suggestion(cable.length, "m", "mm"));
  std::string name;
  const MaterialDesc* material = thickest_material(scene, cable, name);
  if (!material) return;
  const double segment = cable.length / cable.segments;
  if (material->radius > thickest * cable.length) {
    thick.insert(name);
    warnings.push_back(key + ": the radius of its material " + name + ", " + number_text(material->radius) + " m, is above a " +
                       "tenth of its length, " + number_text(cable.length) + " m; usual: below a hundredth" +
                       suggestion(material->radius, "m", "mm"));
  } else if (segment < material->radius) {
    const int most = std::max(1, static_cast<int>(cable.length / (2 * material->radius)));
    warnings.push_back(key + ".segments: " + std::to_string(cable.segments) + " are " + rounded_text(segment) +
                       " m long, shorter than the radius of " + name + ", " + number_text(material->radius) +
                       " m; usual: longer than the cable is thick; did you mean " + std::to_string(most) + "?");
  }
}

/// What the fluid does to a body, where there is none. Its added mass is there.
void warn_of_fluid(const SceneDesc& scene, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < scene.bodies.size() && scene.fluid.density == 0; ++i) {
    const BodyFluidDesc& fluid = scene.bodies[i].fluid;
    if (fluid.volume > 0 || !fluid.drag_area.isZero(0) || !fluid.angular_drag.isZero(0))
      warnings.push_back(indexed("bodies", i) + ".fluid: volume and drag have no effect, as fluid.density is 0");
  }
}

}  // namespace

std::vector<std::string> warnings_of(const SceneDesc& scene) {
  std::vector<std::string> warnings;
  if (scene.time_step > slowest_step)
    warnings.push_back("time_step: " + number_text(scene.time_step) + " s; usual: up to " + number_text(slowest_step) +
                       " s; did you mean 0.001 s (1 ms)?");
  std::set<std::string> thick;
  for (std::size_t i = 0; i < scene.cables.size(); ++i) {
    warn_of_sizes(scene, indexed("cables", i), scene.cables[i], thick, warnings);
    warn_of_sections(indexed("cables", i), scene.cables[i], warnings);
  }
  for (const NamedMaterial& named : scene.materials)
    if (thick.count(named.name) == 0) warn_of_density(named.material, named.name, warnings);
  warn_of_fluid(scene, warnings);
  if (scene.robot) warnings.insert(warnings.end(), scene.robot->left_out.begin(), scene.robot->left_out.end());
  return warnings;
}

}  // namespace verlet_cable
