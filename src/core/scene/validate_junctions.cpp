#include "scene/validate_junctions.h"

#include <cstdlib>
#include <map>
#include <utility>

#include "scene/validate_place.h"

namespace verlet_cable {
namespace {

/// A node of a cable, by their indices.
using CableNode = std::pair<std::size_t, int>;

constexpr int fewest_segments_of_loop = 3;

const char* name_of(BranchDesc::End end) {
  return end == BranchDesc::End::start ? "start" : "end";
}

class JunctionChecker {
 public:
  JunctionChecker(const SceneDesc& scene, const SceneNames& names, Errors& errors)
      : scene_(scene), names_(names), errors_(errors) {}

  void check() {
    UniqueNames names;
    for (std::size_t i = 0; i < scene_.junctions.size(); ++i) {
      names.check(indexed("junctions", i) + ".name", scene_.junctions[i].name, errors_);
      check_trunk(indexed("junctions", i), scene_.junctions[i]);
    }
    for (std::size_t i = 0; i < scene_.junctions.size(); ++i) {
      const JunctionDesc& junction = scene_.junctions[i];
      const std::string key = indexed("junctions", i) + ".branches";
      if (junction.branches.empty()) errors_.add(key, "none", "a list of at least one branch");
      for (std::size_t k = 0; k < junction.branches.size(); ++k) check_branch(indexed(key, k), junction, junction.branches[k]);
    }
  }

 private:
  const CableDesc* find_cable(const std::string& key, const std::string& name) {
    const auto found = names_.cables.find(name);
    if (found != names_.cables.end()) return &scene_.cables[found->second];
    errors_.add(key + ".cable", in_quotes(name), one_of("cable", names_.cables));
    return nullptr;
  }

  CableNode node_of(const CableDesc& cable, int node) const { return {&cable - scene_.cables.data(), node}; }

  void check_trunk(const std::string& key, const JunctionDesc& junction) {
    check_fields(key + ".", junction_fields, junction, errors_);
    const CableDesc* cable = find_cable(key, junction.cable);
    if (!cable || !check_place(key + ".at", *cable, junction.place, errors_) || !has_sound_size(*cable)) return;
    const int node = node_at(*cable, junction.place);
    const auto [first, is_new] = trunks_.emplace(node_of(*cable, node), key);
    if (!is_new)
      errors_.add(key + ".at", "node " + std::to_string(node) + " of " + in_quotes(cable->name),
                  "a node that has no other junction; " + first->second + " is there");
  }

  void check_branch(const std::string& key, const JunctionDesc& junction, const BranchDesc& branch) {
    check_vector(key + ".rotation", branch.rotation, "rad", errors_);
    const CableDesc* cable = find_cable(key, branch.cable);
    if (!cable || !has_sound_size(*cable)) return;
    const int node = branch.end == BranchDesc::End::start ? 0 : cable->segments;
    const std::string place = std::string(name_of(branch.end)) + " of " + in_quotes(cable->name);
    if (branch.cable == junction.cable && is_sound(*cable, junction.place)) {
      const int segments = std::abs(node_at(*cable, junction.place) - node);
      if (segments == 0)
        return errors_.add(key, place + ", where the junction is",
                           "another cable, or another place of this one: a cable cannot be joined with itself at one place");
      if (segments < fewest_segments_of_loop)
        errors_.add(key, place + ", " + std::to_string(segments) + " of its segments from the junction",
                    "an end at least " + std::to_string(fewest_segments_of_loop) + " segments away: fewer are no loop");
    }
    const CableNode end = node_of(*cable, node);
    const auto [first, is_new] = branches_.emplace(end, key);
    if (!is_new) errors_.add(key + ".end", place, "an end that is joined once; " + first->second + " joins it already");
    if (const auto trunk = trunks_.find(end); trunk != trunks_.end())
      errors_.add(key + ".end", place, "an end without a junction of its own; " + trunk->second + " is there");
    for (const AttachmentDesc& attachment : cable->attachments)
      if (is_sound(*cable, attachment.place) && node_at(*cable, attachment.place) == node)
        errors_.add(key + ".end", place, "an end that nothing else holds; attachment " + in_quotes(attachment.name) + " does");
  }

  const SceneDesc& scene_;
  const SceneNames& names_;
  Errors& errors_;
  std::map<CableNode, std::string> trunks_;    ///< the junctions' own places, and their keys
  std::map<CableNode, std::string> branches_;  ///< ends that are joined, and the branches' keys
};

}  // namespace

void check_junctions(const SceneDesc& scene, const SceneNames& scene_names, Errors& errors) {
  JunctionChecker(scene, scene_names, errors).check();
}

}  // namespace verlet_cable
