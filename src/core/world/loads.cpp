#include "world/loads.h"

#include <algorithm>

namespace verlet_cable {

namespace {

/// Of a load that was taken off its node.
constexpr int nowhere = -1;

void move_loads(int cable, int from, int to, State& state) {
  for (Load& load : state.loads)
    if (load.body == cable_id(cable) && load.node == from) load.node = to;
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

void take_off(int cable, int node, State& state) {
  move_loads(cable, node, nowhere, state);
}

void put_on(int cable, int node, State& state) {
  move_loads(cable, nowhere, node, state);
}

}  // namespace verlet_cable
