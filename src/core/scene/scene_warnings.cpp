#include <algorithm>
#include <cmath>

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

}  // namespace

std::vector<std::string> warnings_of(const SceneDesc& scene) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < scene.cables.size(); ++i) warn_of_sections(indexed("cables", i), scene.cables[i], warnings);
  if (scene.robot) warnings.insert(warnings.end(), scene.robot->left_out.begin(), scene.robot->left_out.end());
  return warnings;
}

}  // namespace verlet_cable
