#pragma once

#include "verlet_cable/core/ledger.h"
#include "verlet_cable/core/world.h"
#include "world/islands.h"
#include "world/state.h"

namespace verlet_cable {

/// [J] Of a cable with what flows through the guides on it, see Energy, where the state is that at a part of the step, 0 to 1,
/// and clamps are turned as they are then. `directions`: scratch.
Energy energy_of_cable(const State& state, int cable, double part, std::vector<HeldDirection>& directions);
/// The same at the world's time.
Energy energy_of_cable(const State& state, int cable);
/// [J]
Energy energy_of_body(const State& state, int body);
/// [J] Of all cables and bodies of an island, likewise.
double energy_of(const Island& island, const State& state, double part, std::vector<HeldDirection>& directions);
/// [J] Of their motion, without that of material in guides and of turning sections.
double kinetic_energy_of(const Island& island, const State& state);

/// [J] By which the energy of a cable, or of a body, has changed since the ledger knew it; it knows it then.
double follow_energy_of_cable(int cable, State& state, std::vector<HeldDirection>& directions);
double follow_energy_of_cable(int cable, State& state);
double follow_energy_of_body(int body, State& state);

/// Whether what a step of an island leaves unaccounted for [J] is no more than rounding and tolerances explain: a ten-thousandth
/// of its kinetic energy, of the work in the step, and of its weight lifted by a segment.
bool is_accounted(double unaccounted, const Island& island, const State& state, const EnergyBalance& balance);

/// A change of the state at once, not by motion: what it takes away are edits, what it adds is work of what holds the cable.
void account_for_displacement(double change, EnergyBalance& balance);
/// The same of what is not followed law by law: nets and particles in a step, and what is stopped or put elsewhere because no
/// step was found. What it loses it does not resolve.
void account_for_unfollowed(double change, EnergyBalance& balance);
/// The same of an edit: what it adds is applied from outside.
void account_for_edit(double change, EnergyBalance& balance);

}  // namespace verlet_cable
