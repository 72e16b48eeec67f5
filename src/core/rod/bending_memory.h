#pragma once

#include <initializer_list>
#include <utility>

#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Shares of what halves of segments remember of bending.
HalfBend sum_of(std::initializer_list<std::pair<double, HalfBend>> shares);

/// Gives a cable that remembers how it was bent the array for that.
void fit_bending_memory(const CableModel& model, CableState& state);

/// What the half of a segment at a border remembers, a metre [rad/m], and what goes over a border with `way` [m] of material
/// towards the cable's end. Borders are counted by halves of segments from the start: even ones are nodes, odd ones segments'
/// middles.
HalfBend bends_at_border(int border, double way, const CableState& state);

/// Ways [m] of material over at most five borders one after the other, which it takes what it remembers over. What comes in at
/// the cable's ends remembers nothing.
void carry_bends(int first_border, std::initializer_list<double> ways, CableState& state);

}  // namespace verlet_cable
