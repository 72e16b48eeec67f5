#include "scene/coupled_places.h"

#include <algorithm>
#include <map>

#include "scene/scene_errors.h"
#include "scene/scene_materials.h"
#include "scene/validate_holders.h"

namespace verlet_cable {
namespace {

/// A node that something holds.
struct Place {
  bool moves = false;    ///< with what is solved for: a body or a junction
  bool divides = false;  ///< what happens on one side is not felt on the other
};

using Places = std::map<int, Place>;  ///< by node

class PlaceCounter {
 public:
  explicit PlaceCounter(const SceneDesc& scene)
      : scene_(scene), index_(index_of_names(scene.cables)), guides_(scene.cables.size(), 0), places_(scene.cables.size()) {
    for (const GuideDesc& guide : scene.guides) ++guides_[index_.at(guide.cable)];
    for (std::size_t i = 0; i < scene.cables.size(); ++i)
      for (const AttachmentDesc& attachment : scene.cables[i].attachments)
        hold(i, node_at(scene.cables[i], attachment.place), !attachment.body.empty(), attachment.type == AttachmentType::clamp);
    for (const JunctionDesc& junction : scene.junctions) {
      const std::size_t trunk = index_.at(junction.cable);
      const int node = node_at(scene.cables[trunk], junction.place);
      const bool is_rigid = junction.type == JunctionDesc::Type::rigid;
      hold(trunk, node, true, is_rigid && bends_at(scene, scene.cables[trunk], node));
      for (const BranchDesc& branch : junction.branches) {
        const std::size_t cable = index_.at(branch.cable);
        hold(cable, branch.end == BranchDesc::End::start ? 0 : scene.cables[cable].segments, true, false);
      }
    }
  }

  /// The largest number of places of a cable that feel each other.
  int most(std::size_t cable) const {
    const CableDesc& desc = scene_.cables[cable];
    const bool slides = guides_[cable] > 0;
    int most = guides_[cable], count = guides_[cable];
    for (const auto& [node, place] : places_[cable]) {
      count += place.moves;
      most = std::max(most, count);
      const bool inside = node > 0 && node < desc.segments;
      if (inside && !slides && (place.divides || !bends(desc))) count = place.moves;
    }
    return most;
  }

 private:
  void hold(std::size_t cable, int node, bool moves, bool divides) {
    Place& place = places_[cable][node];
    place.moves = place.moves || moves;
    place.divides = place.divides || divides;
  }

  bool bends(const CableDesc& cable) const {
    const auto resists = [&](const std::string& name) {
      const MaterialDesc& material = *scene_.find_material(name);
      return material.bending_stiffness.largest() > 0 || material.bending_damping > 0;
    };
    return resists(cable.material) || std::any_of(cable.sections.begin(), cable.sections.end(),
                                                  [&](const SectionDesc& section) { return resists(section.material); });
  }

  const SceneDesc& scene_;
  const NameIndex index_;
  std::vector<int> guides_;     ///< by cable; clips that are open, too
  std::vector<Places> places_;  ///< by cable
};

}  // namespace

std::vector<std::string> too_many_coupled_places(const SceneDesc& scene) {
  Errors errors;
  const PlaceCounter counter(scene);
  for (std::size_t i = 0; i < scene.cables.size(); ++i) {
    const int places = counter.most(i);
    if (places <= most_coupled_places) continue;
    errors.add(
        indexed("cables", i),
        std::to_string(places) + " guides, bodies and junctions on " + in_quotes(scene.cables[i].name) + " feel each other",
        "at most " + std::to_string(most_coupled_places) +
            "; on a cable without guides, clamps and rigid junctions divide it into parts that are counted apart");
  }
  return errors.take();
}

}  // namespace verlet_cable
