#include "simulation/batch_scenes.h"

#include <utility>
#include <vector>

#include "scene/scene_structure.h"
#include "verlet_cable/core/name_list.h"

namespace verlet_cable {

void check_alike(const SceneDesc& first, const SceneDesc& other, const std::string& name) {
  if (&first == &other) return;
  const SceneStructure wanted = structure_of(first), given = structure_of(other);
  std::vector<std::string> errors;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (given[i].second != wanted[i].second)
      errors.push_back(name + "." + wanted[i].first + ": " + NameList(given[i].second).text() +
                       "; allowed: scenes that differ in numbers only, the first has " + NameList(wanted[i].second).text());
  if (!errors.empty()) throw SceneError(std::move(errors));
}

}  // namespace verlet_cable
