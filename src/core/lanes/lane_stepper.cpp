#include "lanes/lane_stepper.h"

#include <algorithm>
#include <cmath>

#include "geometry/eigen_vectors.h"
#include "law/stretch.h"

namespace verlet_cable {

namespace {

/// Shorter cables have no room for two lanes.
constexpr int fewest_segments = 4;
constexpr int lane_iterations = 40;
/// A matrix serves so many iterations; what has not converged then moves so violently that every one needs its own.
constexpr int iterations_of_first_matrix = 4;
/// Sides of clamps; a cable with more of them takes its memory in its first step.
constexpr int expected_clamps = 8;

bool bends(const CableModel& model) {
  return model.material.bending_stiffness.largest() > 0 || model.material.bending_damping > 0;
}

bool is_elastic(const CableModel& model) {
  return model.material.axial_stiffness < infinity;
}

double* numbers(std::vector<Vector3>& vectors) {
  return vectors.front().data();
}

}  // namespace

bool fits_lanes(const Substep& s, const CableState& state, bool is_held) {
  const MaterialDesc& material = s.model.material;
  const bool is_simple = state.section_material.empty() && state.directors.empty() && state.flexible_fraction.empty() &&
                         (s.spans.empty() || (material.torsional_stiffness == 0 && material.torsional_damping == 0));
  // Of a free one, what bending damping does to the angular momentum is given back.
  const bool is_steady = is_held || material.bending_damping == 0;
  const bool is_moved_simply =
      s.boundary.growing.empty() && s.environment.fluid.density == 0 && s.environment.gravity.type == GravityDesc::Type::uniform;
  return is_simple && is_steady && is_moved_simply && !s.statics && s.scheme == Scheme::conserving &&
         s.treatment != Treatment::damping && state.segments() >= fewest_segments;
}

LaneLaw law_of(const Substep& s, const CableState& state) {
  LaneLaw law;
  law.bends = bends(s.model);
  law.is_damped = s.model.material.bending_damping > 0;
  law.is_elastic = is_elastic(s.model);
  law.is_watched = s.treatment != Treatment::none;
  law.segments = state.segments();
  law.h = s.h;
  return law;
}

int widest_lanes() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) return 8;
  if (__builtin_cpu_supports("avx2")) return 4;
#endif
  return 2;
}

void LaneStepper::advance(std::vector<LaneMember>& members, int widest, CableStepper& cleaner) {
  choose_passes(members.size(), widest);
  resize(law_of(members.front().substep, *members.front().state));
  load(members);
  iterate(members);
  const int count = static_cast<int>(members.size());
  for (int c = 0; c < count; ++c)
    if (members[c].result.converged) react(c, members[c]);
  passes_.project(work_);
  for (int c = 0; c < count; ++c)
    if (members[c].result.converged && values_.projects[2 * c] != 0) scale_to_lose(c, members[c]);
  passes_.finish(work_);
  for (int c = 0; c < count; ++c) values_.stores[2 * c] = values_.stores[2 * c + 1] = members[c].result.converged ? 1 : 0;
  for (int c = 0; c < count; ++c) {
    if (!members[c].result.converged) continue;
    set_held_accelerations(c, members[c]);
    const bool unresolved = leaves_unresolved(c, members[c]);
    if (unresolved)
      start_multipliers_[c] = members[c].state->axial_multiplier;
    else
      start_multipliers_[c].clear();
  }
  passes_.store(work_);
  for (int c = 0; c < count; ++c) {
    if (!members[c].result.converged) continue;
    complete(c, members[c]);
    const bool cleans = !start_multipliers_[c].empty();
    const bool mends = cleans || values_.projects[2 * c] != 0;
    balance_laws(c, members[c]);
    if (cleans) {
      cleaner.resize(work_.law.segments);
      cleaner.clean(members[c].substep, start_multipliers_[c], *members[c].state);
    }
    if (mends)
      members[c].result.balance.dissipated.unresolved +=
          kinetic_energy_before_mending(c, members[c]) - kinetic_energy_of_free(members[c]);
  }
}

/// The narrowest that take them all.
void LaneStepper::choose_passes(std::size_t cables, int widest) {
  if (cables == 1 || widest == 2)
    passes_ = passes_of_2_lanes();
  else if (cables == 2 || widest == 4)
    passes_ = passes_of_4_lanes();
  else
    passes_ = passes_of_8_lanes();
}

void LaneStepper::resize(const LaneLaw& law) {
  const int nodes = law.segments + 1;
  work_.law = law;
  work_.padded = nodes % 2 == 1;
  work_.last_node = nodes + (work_.padded ? 1 : 0) - 1;
  work_.lane = (work_.last_node + 1) / 2 - 1;
  work_.record = record_size(law);
  const std::size_t places = work_.lane + 1, lanes = passes_.lanes;
  const auto extend = [&](std::size_t numbers, Array& array) {
    const std::size_t blocks = (numbers * lanes + most_lanes - 1) / most_lanes;
    if (array.size() < blocks) array.resize(blocks);
  };
  extend(places * work_.record, records_);
  extend(places * elimination_size(law), eliminations_);
  cables_.resize(most_lanes / 2);
  middles_.resize(most_lanes / 2);
  clamps_.resize(most_lanes / 2);
  bendings_.resize(most_lanes / 2);
  start_multipliers_.resize(most_lanes / 2);
  for (int c = 0; c < most_lanes / 2; ++c) {
    clamps_[c].reserve(expected_clamps);
    start_multipliers_[c].reserve(law.segments);
  }
  convergences_.reserve(most_lanes / 2);
  work_.records = records_.data()->values;
  work_.eliminations = eliminations_.data()->values;
  work_.middles = middles_.data();
  work_.cables = cables_.data();
  work_.values = &values_;
}

void LaneStepper::load(std::vector<LaneMember>& members) {
  const int count = static_cast<int>(members.size());
  for (int c = 0; c < count; ++c) set_cable(c, members[c]);
  // Lanes that are left over compute what the first cable's do.
  for (int c = 0; c < passes_.lanes / 2; ++c) {
    if (c >= count) cables_[c] = cables_[0];
    set_values(c, members[c < count ? c : 0]);
  }
  passes_.load(work_);
  for (int c = 0; c < passes_.lanes / 2; ++c) {
    if (work_.padded) set_pad(c);
    if (work_.law.is_damped) set_damping(c, members[c < count ? c : 0]);
    set_ends(c, members[c < count ? c : 0]);
    hold(c, members[c < count ? c : 0]);
  }
}

void LaneStepper::set_cable(int c, LaneMember& member) {
  CableState& state = *member.state;
  const Substep& s = member.substep;
  LaneCable& cable = cables_[c];
  cable.positions = numbers(state.positions);
  cable.velocities = numbers(state.velocities);
  cable.accelerations = numbers(state.accelerations);
  cable.acceleration_changes = numbers(state.unresolved.acceleration_changes);
  cable.turns = numbers(state.unresolved.turns);
  cable.tension = state.tension.data();
  cable.last_tension = state.last_tension.data();
  cable.axial_multiplier = state.axial_multiplier.data();
  cable.masses = state.masses.data();
  cable.rest_lengths = state.rest_lengths.data();
  member.result = {};
  find_clamp_joints(
      s.model, state, s.boundary.directions, [&state](int i) -> Vector3 { return state.positions[i + 1] - state.positions[i]; },
      s.h, s.part(), clamps_[c]);
}

void LaneStepper::set_values(int c, const LaneMember& member) {
  const Substep& s = member.substep;
  const MaterialDesc& material = s.model.material;
  const Vector3 gravity = s.environment.gravity.acceleration, fluid = s.environment.fluid.velocity;
  for (const int lane : {2 * c, 2 * c + 1}) {
    values_.gravity_x[lane] = gravity.x();
    values_.gravity_y[lane] = gravity.y();
    values_.gravity_z[lane] = gravity.z();
    values_.fluid_x[lane] = fluid.x();
    values_.fluid_y[lane] = fluid.y();
    values_.fluid_z[lane] = fluid.z();
    values_.drag[lane] = material.drag;
    values_.bending_stiffness[lane] = material.bending_stiffness.largest();
    values_.axial_stiffness[lane] = material.axial_stiffness;
    values_.axial_damping[lane] = material.axial_damping / s.h;
    values_.active[lane] = 1;
    values_.projects[lane] = !is_elastic(s.model) && holders_accelerate(s, *member.state) ? 1 : 0;
    values_.known[lane] = known_part(member.state->unresolved);
    values_.smooths[lane] = work_.law.is_watched && member.state->unresolved.known > 0 ? 1 : 0;
    values_.mended[lane] = 1;
    values_.stores[lane] = 0;
  }
}

/// A held node without couplings, and the segment to it.
void LaneStepper::set_pad(int c) {
  const int lane = 2 * c + 1;
  for (int field = 0; field < work_.record; ++field) value(static_cast<LaneField>(field), 0, lane) = 0;
  value(LaneField::inertia, 0, lane) = value(LaneField::target_length, 0, lane) = value(LaneField::pivot, 0, lane) = 1;
  if (work_.law.is_elastic) value(LaneField::start_length, 0, lane) = value(LaneField::axial_stiffness, 0, lane) = 1;
}

/// And its clamps, which are damped, too.
void LaneStepper::set_damping(int c, const LaneMember& member) {
  const Substep& s = member.substep;
  const CableState& state = *member.state;
  const int n = work_.law.segments;
  Bending& bending = bendings_[c];
  if (static_cast<int>(segments_.x.size()) != n + 1) segments_.assign(n + 1, 0.0);
  if (bending.segments() != n) bending.resize(n);
  for (int i = 0; i < n; ++i) set(segments_, i, state.positions[i + 1] - state.positions[i]);
  bending.start(s.model, state, segments_, s.boundary.directions, s.h, s.part());
  for (int i = 1; i < n; ++i) {
    const BendDamping<double> damping = bending.damping_at(i);
    at(LaneField::joint_damping, c, i) = damping.damping;
    set_vector_at(LaneField::driven_x, c, i, vector_of(damping.driven));
    set_vector_at(LaneField::turned_x, c, i, vector_of(damping.turned));
  }
  clamps_[c] = bending.clamps();
}

/// As much as damps least.
void LaneStepper::turn_with_material(int cables) {
  passes_.turn(work_);
  for (int c = 0; c < cables; ++c) {
    if (values_.active[2 * c] == 0) continue;
    const double along = values_.along[2 * c] + values_.along[2 * c + 1];
    values_.share[2 * c] = values_.share[2 * c + 1] = turned_share(along, bendings_[c].turned_square());
  }
}

void LaneStepper::read_displacement(int c) {
  const std::size_t nodes = work_.law.segments + 1;
  if (displacement_.x.size() != nodes) displacement_.assign(nodes, 0.0);
  for (int i = 0; i <= work_.law.segments; ++i) set(displacement_, i, vector_at(LaneField::displacement_x, c, i));
}

void LaneStepper::set_ends(int c, const LaneMember& member) {
  if (!work_.law.bends) return;
  at(LaneField::joint_stiffness, c, 0) = at(LaneField::joint_stiffness, c, work_.law.segments) = 0;
  if (work_.law.is_damped) at(LaneField::joint_damping, c, 0) = at(LaneField::joint_damping, c, work_.law.segments) = 0;
  for (const HeldDirection& clamp : member.substep.boundary.directions) at(LaneField::joint_stiffness, c, clamp.node) = 0;
}

void LaneStepper::hold(int c, const LaneMember& member) {
  const Substep& s = member.substep;
  const std::vector<HeldNode>& held = s.boundary.nodes;
  const CableState& state = *member.state;
  for (const HeldNode& target : held) {
    const Vector3 displacement = target.position - state.positions[target.node];
    // So that the end velocity comes out as the holder's.
    const Vector3 velocity = 2 / s.h * displacement - target.velocity;
    set_vector_at(LaneField::displacement_x, c, target.node, displacement);
    set_vector_at(LaneField::velocity_x, c, target.node, velocity);
    at(LaneField::movable, c, target.node) = at(LaneField::inverse_mass, c, target.node) = 0;
  }
  if (work_.law.is_elastic || held.size() < 2) return;
  for (std::size_t k = 0; k + 1 < held.size(); ++k)
    if (held[k].node + 1 == held[k + 1].node)
      each_lane_of(c, held[k].node, [&](int place, int lane, double) { value(LaneField::adjustable, place, lane) = 0; });
  const double stiffness = stiffness_of_taut(s, state);
  for (int i = held.front().node; i < held.back().node; ++i) {
    each_lane_of(c, i, [&](int place, int lane, double) {
      value(LaneField::compliance, place, lane) = taut_compliance(value(LaneField::target_length, place, lane), stiffness);
    });
  }
}

/// Newton's method, with the same matrices whichever cables there are.
void LaneStepper::iterate(std::vector<LaneMember>& members) {
  convergences_.clear();
  for (const LaneMember& member : members) convergences_.emplace_back(member.substep);
  const int count = static_cast<int>(members.size());
  int active = count;
  for (int i = 0; i < lane_iterations && active > 0; ++i) {
    if (work_.law.bends)
      for (int c = 0; c < count; ++c) bend_clamps(c, members[c]);
    if (work_.law.is_damped) turn_with_material(count);
    if (i == 0 || i >= iterations_of_first_matrix)
      passes_.sweep(work_);
    else
      passes_.light_sweep(work_);
    for (int c = 0; c < count; ++c) {
      if (values_.active[2 * c] == 0) continue;
      ++members[c].result.iterations;
      const double square = values_.largest[2 * c] + 0 * values_.largest[2 * c + 1];
      const double size = std::sqrt(std::max(square, values_.largest[2 * c + 1])) / members[c].state->rest_lengths[0];
      const bool fails = !(size < largest_correction);
      members[c].result.converged = !fails && convergences_[c].is_reached(size);
      if (!fails && !members[c].result.converged) continue;
      bendings_[c].set_share(values_.share[2 * c]);
      values_.active[2 * c] = values_.active[2 * c + 1] = 0;
      --active;
    }
  }
}

void LaneStepper::bend_clamps(int c, const LaneMember& member) {
  for (ClampJoint& clamp : clamps_[c])
    each_lane_of(c, clamp.segment, [&](int place, int lane, double) {
      for (const LaneField field :
           {LaneField::clamp_force_x, LaneField::clamp_force_y, LaneField::clamp_force_z, LaneField::clamp_stiffness})
        value(field, place, lane) = 0;
    });
  for (ClampJoint& clamp : clamps_[c]) {
    const int i = clamp.segment;
    bend_clamp(member.substep.part(), vector_at(LaneField::displacement_x, c, i + 1) - vector_at(LaneField::displacement_x, c, i),
               clamp);
    const Vector3 force = clamp.inverse_length * clamp.moment;
    each_lane_of(c, i, [&](int place, int lane, double sign) {
      value(LaneField::clamp_force_x, place, lane) += sign * force.x();
      value(LaneField::clamp_force_y, place, lane) += sign * force.y();
      value(LaneField::clamp_force_z, place, lane) += sign * force.z();
      value(LaneField::clamp_stiffness, place, lane) += stiffness_across(clamp, member.substep.part());
    });
  }
}

void LaneStepper::set_held_accelerations(int c, const LaneMember& member) {
  for (const HeldNode& target : member.substep.boundary.nodes) {
    const Vector3 acceleration = (target.velocity - member.state->velocities[target.node]) / member.substep.h;
    set_vector_at(LaneField::acceleration_x, c, target.node, acceleration);
  }
}

bool LaneStepper::leaves_unresolved(int c, const LaneMember& member) const {
  if (!work_.law.is_watched) return false;
  const int first = 2 * c, second = first + 1;
  MotionSums sums;
  sums.product = values_.product[first] + values_.product[second];
  sums.square = values_.square[first] + values_.square[second];
  sums.mass = values_.mass[first] + values_.mass[second];
  return is_unresolved(member.substep.treatment, sums, member.state->unresolved);
}

void LaneStepper::complete(int c, LaneMember& member) {
  const int first = 2 * c, second = first + 1;
  const double longest = std::max(values_.longest[first], values_.longest[second]);
  const double shortest = std::min(values_.shortest[first], values_.shortest[second]);
  member.result.max_strain = std::max(std::sqrt(longest) - 1, 1 - std::sqrt(shortest));
  for (const HeldNode& target : member.substep.boundary.nodes) {
    member.state->positions[target.node] = target.position;
    member.state->velocities[target.node] = target.velocity;
  }
  member.state->yielding = 0;  // nothing draws it straight, else it would not be here
  if (values_.projects[first] != 0) react_to_projection(c, member);
}

double& LaneStepper::value(LaneField field, int place, int lane) {
  return work_.records[(place * work_.record + static_cast<int>(field)) * passes_.lanes + lane];
}

double& LaneStepper::at(LaneField field, int c, int node) {
  return node <= work_.lane ? value(field, node, 2 * c) : value(field, work_.last_node - node, 2 * c + 1);
}

Vector3 LaneStepper::vector_at(LaneField first, int c, int node) {
  const int x = static_cast<int>(first);
  return {at(first, c, node), at(static_cast<LaneField>(x + 1), c, node), at(static_cast<LaneField>(x + 2), c, node)};
}

void LaneStepper::set_vector_at(LaneField first, int c, int node, const Vector3& vector) {
  for (int k = 0; k < 3; ++k) at(static_cast<LaneField>(static_cast<int>(first) + k), c, node) = vector[k];
}

/// Towards the segment's second node.
Vector3 LaneStepper::segment_at(LaneField first, int c, int segment) {
  const int x = static_cast<int>(first);
  Vector3 v;
  each_lane_of(c, segment, [&](int place, int lane, double sign) {
    for (int component = 0; component < 3; ++component)
      v[component] = sign * value(static_cast<LaneField>(x + component), place, lane);
  });
  return v;
}

}  // namespace verlet_cable
