#include "scene/validate_holders.h"

#include "verlet_cable/core/name_list.h"

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
  NameList list;
  for (const auto& [name, index] : names) list.add(name);
  return std::string("a ") + kind + " of the scene (" + list.text("there are none") + ")";
}

}  // namespace verlet_cable
