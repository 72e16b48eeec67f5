#include "edit_requests/error_text.h"

#include <algorithm>

#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {

std::string join(const std::vector<std::string>& errors) {
  constexpr std::size_t most = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(errors.size(), most); ++i) text += (i == 0 ? "" : "; ") + errors[i];
  return errors.size() <= most ? text : text + "; and " + std::to_string(errors.size() - most) + " more";
}

EditResult refused(const std::vector<std::string>& errors) {
  return {false, join(errors), {}};
}

std::string point_text(const Vector3& v) {
  return "(" + number_text(v.x()) + ", " + number_text(v.y()) + ", " + number_text(v.z()) + ")";
}

std::string waits_for_frames(const std::string& field, const std::string& name, const RequestWords& words,
                             const std::string& kind) {
  return field + ": " + in_quotes(name) + " waits for its " + words.frames + "; allowed: " + kind + " that are simulated already";
}

std::optional<std::string> why_cable_waits(const World& world, const std::string& field, const std::string& cable,
                                           const RequestWords& words) {
  const std::vector<std::string>& waiting = world.findings().waiting;
  if (std::find(waiting.begin(), waiting.end(), cable) == waiting.end()) return std::nullopt;
  return waits_for_frames(field, cable, words, "cables");
}

std::optional<std::string> why_no_cable(const World& world, const std::string& field, const std::string& cable,
                                        const RequestWords& words) {
  if (find(world.cables(), cable) >= 0) return std::nullopt;
  if (const auto waits = why_cable_waits(world, field, cable, words)) return waits;
  NameList names;
  for (const SimulatedCable& other : world.cables()) names.add(other.model->name);
  return field + ": " + in_quotes(cable) + "; allowed: " + names.text("none, there are no cables");
}

}  // namespace verlet_cable
