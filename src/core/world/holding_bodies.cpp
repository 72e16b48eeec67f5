#include "world/holding_bodies.h"

#include <algorithm>

namespace verlet_cable {

bool turns_bodies(int cable, const std::vector<Attachment>& attachments, const State& state) {
  const SceneDesc& scene = *state.scene;
  return std::any_of(attachments.begin(), attachments.end(), [&](const Attachment& a) {
    if (a.body != cable_id(cable) || a.holder < 0 || a.guide >= 0) return false;
    // Junctions come after the scene's bodies; what is not stiff there is welded as a hinge, of a cable that may be elsewhere.
    if (a.is_junction) return scene.junctions[a.holder - scene.bodies.size()].type == JunctionDesc::Type::rigid;
    return a.type == AttachmentType::clamp;
  });
}

bool is_twisted(int cable, const std::vector<Attachment>& attachments) {
  const auto count = [&](auto&& is_counted) {
    return std::count_if(attachments.begin(), attachments.end(),
                         [&](const Attachment& a) { return a.body == cable_id(cable) && is_counted(a); });
  };
  return count([](const Attachment& a) { return a.type == AttachmentType::clamp; }) > 1 && count(is_wheel) < 2;
}

}  // namespace verlet_cable
