#include "verlet_cable/core/pin_rules.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {

bool has_guide_room(double distance, double segment_length) {
  constexpr double rounding = 1e-9;  // relative
  return distance >= guide_room * segment_length * (1 - rounding);
}

int holder_of(const BodyId& body, int node, const std::vector<Attachment>& attachments) {
  const auto is_here = [&](const Attachment& a) { return a.body == body && a.node == node; };
  const auto joint =
      std::find_if(attachments.begin(), attachments.end(), [&](const Attachment& a) { return a.is_junction && is_here(a); });
  const int junction = joint == attachments.end() ? -1 : joint->holder;
  const auto holder = std::find_if(attachments.begin(), attachments.end(), [&](const Attachment& a) {
    return !a.is_junction && (is_here(a) || (junction >= 0 && a.held_junction == junction));
  });
  return holder == attachments.end() ? -1 : static_cast<int>(holder - attachments.begin());
}

NearGuide guide_near(const BodyId& cable, int node, const SimulatedCable& simulated, const std::vector<Attachment>& attachments) {
  const std::vector<double> arc_length = simulated.state.arc_length();
  for (std::size_t i = 0; i < attachments.size(); ++i) {
    const Attachment& a = attachments[i];
    if (a.guide < 0 || a.body != cable) continue;
    const int nearest = std::clamp(node, a.node, last_node(a));
    const double distance = std::abs(arc_length[node] - arc_length[nearest]);
    if (!has_guide_room(distance, simulated.model->segment_length)) return {static_cast<int>(i), distance};
  }
  return {};
}

}  // namespace verlet_cable
