#pragma once

#include <type_traits>

#include "lanes/finish.h"
#include "lanes/load.h"
#include "lanes/store.h"
#include "lanes/sweep.h"
#include "lanes/turn.h"

namespace verlet_cable {
// Without linkage: what is compiled for one processor is not to be used for another.
namespace {

template <Bends value>
using BendsConstant = std::integral_constant<Bends, value>;

/// Calls what is compiled for the cables' law.
template <class Call>
void by_law(const LaneLaw& law, const Call& call) {
  const auto with = [&](auto bends) {
    if (law.is_elastic)
      call(bends, std::true_type());
    else
      call(bends, std::false_type());
  };
  if (law.is_damped)
    with(BendsConstant<Bends::damped>());
  else if (law.bends)
    with(BendsConstant<Bends::freely>());
  else
    with(BendsConstant<Bends::not_at_all>());
}

template <class Real>
bool any_projects(const LaneWork& w) {
  bool any = false;
  for (int i = 0; i < lanes_of<Real>; ++i) any = any || w.values->projects[i] != 0;
  return any;
}

template <class Real>
LanePasses passes_of_lanes() {
  LanePasses passes;
  passes.lanes = lanes_of<Real>;
  passes.load = [](const LaneWork& w) {
    by_law(w.law, [&](auto bends, auto elastic) { load_lanes<bends.value, elastic.value, Real>(w); });
  };
  passes.turn = turn_lanes<Real>;
  passes.sweep = [](const LaneWork& w) {
    by_law(w.law, [&](auto bends, auto elastic) { sweep_lanes<bends.value, elastic.value, false, Real>(w); });
  };
  passes.light_sweep = [](const LaneWork& w) {
    by_law(w.law, [&](auto bends, auto elastic) { sweep_lanes<bends.value, elastic.value, true, Real>(w); });
  };
  passes.project = [](const LaneWork& w) {
    any_projects<Real>(w) ? project_lanes<true, Real>(w) : project_lanes<false, Real>(w);
  };
  passes.finish = [](const LaneWork& w) { any_projects<Real>(w) ? finish_lanes<true, Real>(w) : finish_lanes<false, Real>(w); };
  passes.store = [](const LaneWork& w) {
    by_law(w.law, [&](auto bends, auto elastic) { store_lanes<bends.value, elastic.value, Real>(w); });
  };
  return passes;
}

}  // namespace
}  // namespace verlet_cable
