#include "scene/validate_holders.h"

namespace verlet_cable {

SceneNames::SceneNames(const SceneDesc& scene)
    : cables(index_of_names(scene.cables)), bodies(index_of_names(scene.bodies)), joints(scene.cables.size()) {
  const auto count = [&](const std::string& cable) {
    const auto found = cables.find(cable);
    if (found != cables.end()) ++joints[found->second];
  };
  for (const JunctionDesc& junction : scene.junctions) {
    count(junction.cable);
    for (const BranchDesc& branch : junction.branches) count(branch.cable);
  }
  for (const GuideDesc& guide : scene.guides)
    if (guide.place) count(guide.cable);
}

std::string one_of(const char* kind, const NameIndex& names) {
  constexpr std::size_t most = 20;
  std::string list;
  std::size_t count = 0;
  for (const auto& [name, index] : names) {
    if (++count > most) break;
    list += (list.empty() ? "" : ", ") + escaped(name);
  }
  return std::string("a ") + kind + " of the scene (" + (names.empty() ? "there are none" : list) +
         (names.size() > most ? ", ...)" : ")");
}

}  // namespace verlet_cable
