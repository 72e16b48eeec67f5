#include "world/limits.h"

#include <algorithm>

#include "rod/joint_views.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// An excursion is over where the load, of what is allowed, falls below this: what trembles about its limit is one.
constexpr double ended = 0.95;

/// What CableState::beyond_limits remembers of a kind of limit, and beside it while a step's loads are looked at.
unsigned char flag_of(Excursion::Kind kind) {
  return kind == Excursion::Kind::bend ? 1 : 2;
}
constexpr int now_shift = 2;
constexpr unsigned char remembered = 3;

bool has_limit(const MaterialDesc& material) {
  return material.minimum_bend_radius > 0 || material.maximum_tension < infinity;
}

/// Looks at the loads of one kind, node by node, in ascending order; a node may have several.
class Watch {
 public:
  Watch(int cable, Excursion::Kind kind, CableState& state, std::vector<Excursion>& found)
      : flag_(flag_of(kind)), state_(state), found_(found) {
    worst_.cable = cable;
    worst_.kind = kind;
  }

  /// `load`: of what is allowed; `value` and `allowed`: in the limit's own unit.
  void add(int node, double load, double value, double allowed) {
    unsigned char& beyond = state_.beyond_limits[node];
    if (!(load > ((beyond & flag_) != 0 ? ended : 1))) return;
    beyond |= flag_ << now_shift;
    if (last_ >= 0 && node > last_ + 1) finish();
    if (last_ < 0) first_ = node;
    last_ = node;
    if (load <= worst_load_) return;
    worst_load_ = load;
    worst_.node = node;
    worst_.value = value;
    worst_.allowed = allowed;
  }

  /// The excursion that was open, if there was one, is told if it is new.
  void finish() {
    if (last_ < 0) return;
    const auto begin = state_.beyond_limits.begin();
    const auto from = begin + std::max(first_ - 1, 0), to = begin + std::min(last_ + 2, state_.nodes());
    if (std::none_of(from, to, [this](unsigned char beyond) { return (beyond & flag_) != 0; })) found_.push_back(worst_);
    last_ = -1;
    worst_load_ = 0;
  }

 private:
  unsigned char flag_;
  CableState& state_;
  std::vector<Excursion>& found_;
  Excursion worst_;
  double worst_load_ = 0;
  int first_ = -1, last_ = -1;  // nodes of the excursion that is open
};

void watch_bends(int index, const CableMaterials& materials, const std::vector<DirectionTarget>& clamps, CableState& state,
                 std::vector<Excursion>& found) {
  Watch watch(index, Excursion::Kind::bend, state, found);
  const auto add = [&](int node, double curvature, const MaterialDesc& material) {
    watch.add(node, curvature * material.minimum_bend_radius, 1 / curvature, material.minimum_bend_radius);
  };
  visit_joints(state, clamps, [&](const Joint& joint) {
    const double curvature = joint.curvature();
    if (joint.side != Joint::Side::both || !materials.vary()) {
      add(joint.node, curvature,
          materials[joint.side == Joint::Side::before || joint.side == Joint::Side::both ? joint.node - 1 : joint.node]);
      return;
    }
    const std::array<double, 2> sides = curvature_beside(materials, state, joint.node, joint.length * curvature);
    for (const int side : {0, 1}) add(joint.node, sides[side], materials[joint.node - 1 + side]);
  });
  watch.finish();
}

void watch_tension(int index, const CableMaterials& materials, CableState& state, std::vector<Excursion>& found) {
  Watch watch(index, Excursion::Kind::tension, state, found);
  for (int i = 0; i < state.segments(); ++i) {
    const double most = materials[i].maximum_tension;
    watch.add(i, state.tension[i] / most, state.tension[i], most);
  }
  watch.finish();
}

}  // namespace

void watch_limits(SimulatedCable& cable) {
  if (cable.state.beyond_limits.empty() && CableMaterials(cable).any(has_limit))
    cable.state.beyond_limits.assign(cable.state.nodes(), 0);
}

void find_excursions(State& state, std::vector<Excursion>& found) {
  for (std::size_t k = 0; k < state.cables.size(); ++k) {
    CableState& cable = state.cables[k].state;
    if (cable.beyond_limits.empty()) continue;
    const CableMaterials materials(state.cables[k]);
    watch_bends(static_cast<int>(k), materials, state.cable_progress[k].targets.directions, cable, found);
    watch_tension(static_cast<int>(k), materials, cable, found);
    for (unsigned char& beyond : cable.beyond_limits) beyond = beyond >> now_shift & remembered;
  }
}

}  // namespace verlet_cable
