#include "scene/harnesses.h"

#include <algorithm>
#include <numeric>

#include "scene/validate_holders.h"

namespace verlet_cable {

std::vector<JunctionPlace> junction_places(const SceneDesc& scene, const CableDesc& cable) {
  std::vector<JunctionPlace> places;
  for (int j = 0; j < static_cast<int>(scene.junctions.size()); ++j) {
    const JunctionDesc& junction = scene.junctions[j];
    if (junction.cable == cable.name) places.push_back({j, node_at(cable, junction.place), nullptr});
    for (const BranchDesc& branch : junction.branches)
      if (branch.cable == cable.name) places.push_back({j, branch.end == BranchDesc::End::start ? 0 : cable.segments, &branch});
  }
  return places;
}

bool is_welded(const SceneDesc& scene, const std::string& cable) {
  return std::any_of(scene.junctions.begin(), scene.junctions.end(), [&](const JunctionDesc& junction) {
    return junction.type == JunctionDesc::Type::rigid &&
           (junction.cable == cable || std::any_of(junction.branches.begin(), junction.branches.end(),
                                                   [&](const BranchDesc& branch) { return branch.cable == cable; }));
  });
}

std::vector<int> harnesses_of(const SceneDesc& scene) {
  std::vector<int> labels(scene.cables.size());
  std::iota(labels.begin(), labels.end(), 0);
  const NameIndex index = index_of_names(scene.cables);
  const auto join = [&](int a, int b) { std::replace(labels.begin(), labels.end(), std::max(a, b), std::min(a, b)); };
  for (const JunctionDesc& junction : scene.junctions)
    for (const BranchDesc& branch : junction.branches) join(labels[index.at(junction.cable)], labels[index.at(branch.cable)]);
  for (const BodyDesc& body : scene.bodies) {
    int first = -1;
    for (std::size_t i = 0; i < scene.cables.size(); ++i) {
      if (!hangs_on(scene, body, scene.cables[i])) continue;
      if (first >= 0) join(labels[first], labels[i]);
      first = static_cast<int>(i);
    }
  }
  return labels;
}

bool hangs_on(const SceneDesc& scene, const BodyDesc& body, const CableDesc& cable) {
  return std::any_of(cable.attachments.begin(), cable.attachments.end(),
                     [&](const AttachmentDesc& attachment) { return attachment.body == body.name; }) ||
         std::any_of(scene.guides.begin(), scene.guides.end(),
                     [&](const GuideDesc& guide) { return guide.place && guide.cable == cable.name && guide.body == body.name; });
}

}  // namespace verlet_cable
