#include "world/loads.h"

#include <algorithm>
#include <vector>

namespace verlet_cable {

namespace {

/// Of a load that was taken off its node.
constexpr int nowhere = -1;

void move_loads(int cable, int from, int to, State& state) {
  for (Load& load : state.loads)
    if (load.body == cable_id(cable) && load.node == from) load.node = to;
}

/// By cable: whether it is joined with a cable or body, by way of bodies.
std::vector<char> joined_with(const BodyId& body, const State& state) {
  std::vector<char> cables(state.cables.size(), 0), bodies(state.bodies.size(), 0);
  (body.is_cable() ? cables : bodies)[body.index] = 1;
  for (bool grows = true; grows;) {
    grows = false;
    for (const Attachment& attachment : state.attachments) {
      if (attachment.holder < 0 || attachment.body.is_net()) continue;
      char& held = (attachment.body.is_cable() ? cables : bodies)[attachment.body.index];
      char& holder = bodies[attachment.holder];
      grows = grows || held != holder;
      held = holder = static_cast<char>(held | holder);
    }
  }
  return cables;
}

}  // namespace

bool is_loaded(int cable, const State& state) {
  return std::any_of(state.loads.begin(), state.loads.end(), [&](const Load& load) { return load.body == cable_id(cable); });
}

void load_nodes(int cable, const State& state, Boundary& boundary) {
  boundary.loads.clear();
  for (const Load& load : state.loads)
    if (load.body == cable_id(cable)) boundary.loads.push_back({load.node, load.force});
}

void put_off_last_damped(const BodyId& loaded, State& state) {
  const auto is_last = [](const SimulatedCable& cable) { return cable.state.unresolved.damped == 1; };
  if (std::none_of(state.cables.begin(), state.cables.end(), is_last)) return;
  const std::vector<char> joined = joined_with(loaded, state);
  for (std::size_t i = 0; i < state.cables.size(); ++i)
    if (joined[i] != 0 && is_last(state.cables[i])) ++state.cables[i].state.unresolved.damped;
}

void take_off(int cable, int node, State& state) {
  move_loads(cable, node, nowhere, state);
}

void put_on(int cable, int node, State& state) {
  move_loads(cable, nowhere, node, state);
}

}  // namespace verlet_cable
