#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "scene/scene_errors.h"

namespace verlet_cable {

/// Index of each name in a list of descriptions; of names that are used twice, the first.
using NameIndex = std::map<std::string, std::size_t>;

template <class Desc>
NameIndex index_of_names(const std::vector<Desc>& descs) {
  NameIndex index;
  for (std::size_t i = 0; i < descs.size(); ++i) index.emplace(descs[i].name, i);
  return index;
}

/// What a name may be, for messages: `a body of the scene (a, b)`.
std::string one_of(const char* kind, const NameIndex& names);

/// What a scene's descriptions refer to.
struct SceneNames {
  explicit SceneNames(const SceneDesc& scene);

  NameIndex cables;
  NameIndex bodies;
  std::vector<int> joints;  ///< one a cable: how many places of it are in junctions or guides
};

/// What something is held by, and where: a frame or a body.
template <class Desc>
void check_holder(const std::string& key, const SceneNames& names, const Desc& desc, Errors& errors) {
  if (!desc.frame.empty() && !is_frame_name(desc.frame)) errors.add(key + ".frame", in_quotes(desc.frame), frame_words);
  if (!desc.body.empty() && !names.bodies.count(desc.body))
    errors.add(key + ".body", in_quotes(desc.body), one_of("body", names.bodies));
  if (!desc.body.empty() && !desc.frame.empty())
    errors.add(key + ".body", in_quotes(desc.body) + ", given together with frame " + in_quotes(desc.frame), "one of the two");
  if (!desc.body.empty() && desc.initial_pose)
    errors.add(key + ".initial_pose", "given together with body " + in_quotes(desc.body),
               "only with frame; a body has its own pose");
  check_vector(key + ".offset", desc.offset, "m", errors);
  check_vector(key + ".rotation", desc.rotation, "rad", errors);
  if (desc.initial_pose) check_numbers(key + ".initial_pose", *desc.initial_pose, coordinate, "m, rad", errors);
}

/// Calls `visit` with the key and the description of all that names a frame by a key of that name.
template <class Visit>
void visit_frame_users(const SceneDesc& scene, const Visit& visit) {
  const auto visit_all = [&](const std::string& list, const auto& users) {
    for (std::size_t i = 0; i < users.size(); ++i) visit(indexed(list, i), users[i]);
  };
  for (std::size_t i = 0; i < scene.cables.size(); ++i)
    visit_all(indexed("cables", i) + ".attachments", scene.cables[i].attachments);
  for (std::size_t i = 0; i < scene.nets.size(); ++i) visit_all(indexed("nets", i) + ".attachments", scene.nets[i].attachments);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    visit_all(indexed("bodies", i) + ".attachments", scene.bodies[i].attachments);
  visit_all("guides", scene.guides);
  visit_all("obstacles", scene.obstacles);
}

}  // namespace verlet_cable
