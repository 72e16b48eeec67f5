#include "world/limits.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "rod/joint_views.h"
#include "verlet_cable/core/cable_materials.h"
#include "world/step_contacts.h"

namespace verlet_cable {

namespace {

/// [s] What comes back within this time is the same excursion: what trembles about its limit is one.
constexpr double quiet_time = 0.1;

bool has_limit(const MaterialDesc& material) {
  return material.minimum_bend_radius > 0 || material.maximum_tension < infinity || material.maximum_squeeze < infinity;
}

/// Looks at the loads of one kind, node by node, in ascending order; a node may have several.
class Watch {
 public:
  Watch(int cable, Excursion::Kind kind, int quiet_steps, CableState& state, std::vector<Excursion>& found)
      : kind_(static_cast<std::size_t>(kind)), quiet_steps_(quiet_steps), state_(state), found_(found) {
    worst_.cable = cable;
    worst_.kind = kind;
  }

  /// `load`: of what is allowed; `value` and `allowed`: in the limit's own unit; `other`: what does it.
  void add(int node, double load, double value, double allowed, const std::string& other = {}) {
    if (!(load > 1)) return;
    if (last_ < 0 || node > last_ + 1) {
      finish();
      is_known_ = was_beyond(node - 1);
    }
    if (node != last_) is_known_ = is_known_ || was_beyond(node);
    state_.beyond_limits[node][kind_] = quiet_steps_;
    last_ = node;
    if (load <= worst_load_) return;
    worst_load_ = load;
    worst_.node = node;
    worst_.value = value;
    worst_.allowed = allowed;
    worst_.other = other;
  }

  /// Those at neighbouring nodes, if there were any, are an excursion that is told if it is new.
  void finish() {
    if (last_ >= 0 && !is_known_ && !was_beyond(last_ + 1)) found_.push_back(worst_);
    last_ = -1;
    worst_load_ = 0;
  }

 private:
  bool was_beyond(int node) const { return node >= 0 && node < state_.nodes() && state_.beyond_limits[node][kind_] > 0; }

  std::size_t kind_;
  int quiet_steps_;
  CableState& state_;
  std::vector<Excursion>& found_;
  Excursion worst_;
  double worst_load_ = 0;
  int last_ = -1;  // node of those that are looked at
  bool is_known_ = false;
};

void watch_bends(int index, int quiet_steps, const CableMaterials& materials, const std::vector<DirectionTarget>& clamps,
                 CableState& state, std::vector<Excursion>& found) {
  Watch watch(index, Excursion::Kind::bend, quiet_steps, state, found);
  const auto add = [&](int node, double curvature, const MaterialDesc& material) {
    watch.add(node, curvature * material.minimum_bend_radius, 1 / curvature, material.minimum_bend_radius);
  };
  visit_joints(state, clamps, [&](const Joint& joint) {
    const double curvature = joint.curvature();
    if (joint.side != Joint::Side::both)
      return add(joint.node, curvature, materials[joint.node - (joint.side == Joint::Side::before ? 1 : 0)]);
    const std::array<double, 2> sides = curvature_beside(materials, state, joint.node, joint.length * curvature);
    for (const int side : {0, 1}) add(joint.node, sides[side], materials[joint.node - 1 + side]);
  });
  watch.finish();
}

void watch_tension(int index, int quiet_steps, const CableMaterials& materials, CableState& state,
                   std::vector<Excursion>& found) {
  Watch watch(index, Excursion::Kind::tension, quiet_steps, state, found);
  for (int i = 0; i < state.segments(); ++i) {
    const double most = materials[i].maximum_tension;
    watch.add(i, state.tension[i] / most, state.tension[i], most);
  }
  watch.finish();
}

/// What squeezes a section, from wherever it does: the force [N/m] that a contact presses with on a length.
void watch_squeeze(int index, int quiet_steps, const CableMaterials& materials, const State& state,
                   const std::vector<SimulatedContact>& contacts, std::vector<Squeeze>& squeezes, CableState& cable,
                   std::vector<Excursion>& found) {
  squeezes.clear();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const SimulatedContact& contact = contacts[k];
    const double force = contact.normal.dot(contact.force);
    if (contact.cable == index && contact.length > 0)
      squeezes.push_back({contact.segment, force / contact.length, &name_of_touched(contact, state)});
    if (contact.other_cable == index && contact.other_length > 0)
      squeezes.push_back({contact.other_segment, force / contact.other_length, &state.cables[contact.cable].model->name});
  }
  std::sort(squeezes.begin(), squeezes.end(), [](const Squeeze& a, const Squeeze& b) {
    return a.segment != b.segment ? a.segment < b.segment : a.force > b.force;
  });
  Watch watch(index, Excursion::Kind::squeeze, quiet_steps, cable, found);
  for (const Squeeze& squeeze : squeezes) {
    const double most = materials[squeeze.segment].maximum_squeeze;
    watch.add(squeeze.segment, squeeze.force / most, squeeze.force, most, *squeeze.other);
  }
  watch.finish();
}

}  // namespace

void watch_limits(SimulatedCable& cable) {
  if (cable.state.beyond_limits.empty() && CableMaterials(cable).any(has_limit))
    cable.state.beyond_limits.assign(cable.state.nodes(), {0, 0, 0});
}

void find_excursions(const std::vector<SimulatedContact>& contacts, State& state, std::vector<Squeeze>& squeezes,
                     std::vector<Excursion>& found) {
  const int quiet_steps = 1 + static_cast<int>(std::ceil(quiet_time / state.scene->time_step));
  for (std::size_t k = 0; k < state.cables.size(); ++k) {
    CableState& cable = state.cables[k].state;
    if (cable.beyond_limits.empty()) continue;
    const CableMaterials materials(state.cables[k]);
    watch_bends(static_cast<int>(k), quiet_steps, materials, state.cable_progress[k].targets.directions, cable, found);
    watch_tension(static_cast<int>(k), quiet_steps, materials, cable, found);
    if (materials.any([](const MaterialDesc& material) { return material.maximum_squeeze < infinity; }))
      watch_squeeze(static_cast<int>(k), quiet_steps, materials, state, contacts, squeezes, cable, found);
    for (std::array<int, 3>& steps : cable.beyond_limits)
      for (int& left : steps) left = std::max(left - 1, 0);
  }
}

}  // namespace verlet_cable
