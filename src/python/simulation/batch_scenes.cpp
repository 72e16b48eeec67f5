#include "simulation/batch_scenes.h"

#include <utility>
#include <vector>

#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

template <class Items, class Name>
std::vector<std::string> names_of(const Items& items, const Name& name) {
  std::vector<std::string> names;
  for (const auto& item : items) names.push_back(name(item));
  return names;
}

/// What scenes of a batch have in common, as text: the names of all things, and how many numbers they have.
std::vector<std::pair<std::string, std::vector<std::string>>> structure_of(const SceneDesc& scene) {
  const auto name = [](const auto& item) { return item.name; };
  std::vector<std::string> attachments;
  for (const CableDesc& cable : scene.cables)
    for (const AttachmentDesc& attachment : cable.attachments) attachments.push_back(attachment.name);
  for (const NetDesc& net : scene.nets)
    for (const auto& attachment : net.attachments) attachments.push_back(attachment.name);
  for (const BodyDesc& body : scene.bodies)
    for (const auto& attachment : body.attachments) attachments.push_back(attachment.name);
  return {
      {"frames", frame_names(scene)},
      {"materials", names_of(scene.materials, name)},
      {"cables",
       names_of(scene.cables,
                [](const CableDesc& cable) { return cable.name + " of " + std::to_string(cable.segments) + " segments"; })},
      {"nets", names_of(scene.nets, name)},
      {"particles", names_of(scene.particles, name)},
      {"bodies", names_of(scene.bodies, name)},
      {"junctions", names_of(scene.junctions, name)},
      {"guides", names_of(scene.guides, name)},
      {"attachments", attachments},
      {"obstacles", names_of(scene.obstacles, name)},
      {"time_step", {number_text(scene.time_step) + " s"}},
  };
}

}  // namespace

void check_alike(const SceneDesc& first, const SceneDesc& other, const std::string& name) {
  if (&first == &other) return;
  const auto wanted = structure_of(first), given = structure_of(other);
  std::vector<std::string> errors;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (given[i].second != wanted[i].second)
      errors.push_back(name + "." + wanted[i].first + ": " + NameList(given[i].second).text() +
                       "; allowed: scenes that differ in numbers only, the first has " + NameList(wanted[i].second).text());
  if (!errors.empty()) throw SceneError(std::move(errors));
}

}  // namespace verlet_cable
