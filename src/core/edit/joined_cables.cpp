#include "edit/joined_cables.h"

#include <algorithm>
#include <set>

namespace verlet_cable {

std::vector<int> joints_that_go_with(int cable, const State& state) {
  std::vector<int> joints;
  std::set<int> seen;
  for (int a = 0; a < static_cast<int>(state.attachments.size()); ++a) {
    const Attachment& attachment = state.attachments[a];
    if (!attachment.is_junction || !seen.insert(attachment.holder).second || attachment.body != cable_id(cable)) continue;
    if (state.body_progress[attachment.holder].holders.empty()) joints.push_back(a);
  }
  return joints;
}

std::vector<char> cables_that_follow(const std::vector<edit::SetState::OfCable>& set, const State& state) {
  std::vector<char> follows(state.cables.size(), 0);
  for (const edit::SetState::OfCable& of : set) {
    if (!gives_something(of)) continue;
    for (const int joint : joints_that_go_with(of.cable, state))
      for (const Attachment& a : state.attachments)
        if (a.holder == state.attachments[joint].holder && a.body.is_cable()) follows[a.body.index] = 1;
  }
  for (const edit::SetState::OfCable& of : set)
    if (of.positions) follows[of.cable] = 0;
  return follows;
}

std::vector<const edit::SetState::OfCable*> trunks_first(const std::vector<edit::SetState::OfCable>& set, const State& state) {
  const auto place = [&](const edit::SetState::OfCable* of) {
    return std::find_if(state.attachments.begin(), state.attachments.end(),
                        [&](const Attachment& a) { return a.is_junction && a.body == cable_id(of->cable); });
  };
  std::vector<const edit::SetState::OfCable*> ordered;
  for (const edit::SetState::OfCable& of : set) ordered.push_back(&of);
  std::stable_sort(ordered.begin(), ordered.end(),
                   [&](const auto* first, const auto* second) { return place(first) < place(second); });
  return ordered;
}

}  // namespace verlet_cable
