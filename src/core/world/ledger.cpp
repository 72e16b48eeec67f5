#include "world/energy.h"
#include "world/implementation.h"

namespace verlet_cable {

Energy World::Implementation::energy() const {
  Energy energy;
  for (std::size_t k = 0; k < state.cables.size(); ++k) energy += energy_of_cable(state, static_cast<int>(k));
  for (std::size_t k = 0; k < state.bodies.size(); ++k) energy += energy_of_body(state, static_cast<int>(k));
  add_net_energy(energy);
  return energy;
}

/// [J] By which the energies of cables and bodies have changed since the ledger knew them.
double World::Implementation::follow_energies() {
  double change = 0;
  for (std::size_t k = 0; k < state.cables.size(); ++k) change += follow_energy_of_cable(static_cast<int>(k), state);
  for (std::size_t k = 0; k < state.bodies.size(); ++k) change += follow_energy_of_body(static_cast<int>(k), state);
  return change;
}

/// [J]
double World::Implementation::energy_of_nets_and_particles() const {
  Energy energy;
  add_net_energy(energy);
  return energy.total();
}

/// What has started or was placed brings its energy along.
void World::Implementation::begin_account(double of_nets_before) {
  state.initial_energy += follow_energies() + energy_of_nets_and_particles() - of_nets_before;
}

/// What is changed before the first step is as if it had been in the scene.
void World::Implementation::account_for_edit_since(double energy_before) {
  if (state.steps == 0) {
    for (CableProgress& progress : state.cable_progress) progress.energy = 0;
    for (BodyProgress& progress : state.body_progress) progress.energy = 0;
    state.initial_energy = 0;
    return begin_account(0);
  }
  account_for_edit(energy().total() - energy_before, state.ledger.balance);
  follow_energies();
}

/// Adds what the step has done, one island after the other, and finds those in which energy has come from nowhere or gone.
void World::Implementation::close_ledger() {
  findings.unaccounted.reserve(island_outcomes.value.size());
  for (std::size_t i = 0; i < island_outcomes.value.size(); ++i) {
    const Island& island = islands.value.all()[i];
    EnergyBalance balance = island_outcomes.value[i].balance;
    double change = island_outcomes.value[i].change;
    for (const int cable : island.cables) {
      balance += cable_outcomes.value[cable].balance;
      change += cable_outcomes.value[cable].change;
    }
    state.ledger.balance += balance;
    const double unaccounted = change - balance.net();
    if (is_accounted(unaccounted, island, state, balance)) continue;
    const BodyId body = island.cables.empty() ? rigid_body_id(island.bodies.front()) : cable_id(island.cables.front());
    findings.unaccounted.push_back({body, unaccounted});
  }
  if (!findings.unaccounted.empty()) ++state.ledger.unaccounted_steps;
}

}  // namespace verlet_cable
