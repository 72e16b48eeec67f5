#include "rod/initial_shape.h"

#include <algorithm>
#include <cmath>

#include "rod/catenary.h"
#include "rod/length_projection.h"
#include "rod/rod_frames.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

bool is_held_between_ends(const std::vector<HeldNode>& held, const CableState& state) {
  return held.size() == 1 && held.front().node > 0 && held.front().node < state.segments();
}

namespace {

/// Relative; more is not left by steps, but by holders that have gone.
constexpr double tolerated_length_error = 1e-3;

std::vector<Vector3> straight_line(const Vector3& from, const Vector3& direction, const CableState& state) {
  std::vector<Vector3> nodes;
  for (const double s : state.arc_length()) nodes.push_back(from + s * direction);
  return nodes;
}

/// The bight of a cable that is to be settled is at least so wide [of its length].
constexpr double width_to_settle = 0.2;
/// Of a segment's length.
constexpr double rounding_of_slack = 1e-9;

/// A place like `to`, but not so nearly above or below `from` that the bight of a chain of that length between the two would be
/// less than `width` wide [m].
Vector3 moved_apart(const Vector3& from, const Vector3& to, const Vector3& down, double length, double width) {
  const Vector3 span = to - from, level = span - span.dot(down) * down;
  if (level.norm() >= width) return to;
  const Vector3 side = level.norm() > 0 ? Vector3(level.normalized()) : Vector3(down.unitOrthogonal());
  const Vector3 apart = span - level + width * side;
  return apart.norm() < length ? Vector3(from + apart) : to;
}

/// Hangs between each two neighbouring holders, straight down from the outer ones.
std::vector<Vector3> hanging(const CableModel& model, const CableState& state, const std::vector<HeldNode>& held,
                             const Vector3& gravity, Folds folds) {
  if (held.empty()) return straight_line(Vector3::Zero(), Vector3::UnitX(), state);
  const bool weightless = gravity.norm() == 0;
  const Vector3 down = weightless ? Vector3(-Vector3::UnitZ()) : Vector3(gravity.normalized());
  const double weight = weightless ? 1 : gravity.norm();
  const CableMaterials materials(model, state);
  const bool balances = folds == Folds::nowhere && is_held_between_ends(held, state);
  const Vector3 after = balances ? Vector3(down.unitOrthogonal()) : down, before = balances ? Vector3(-after) : down;
  std::vector<Vector3> nodes(state.nodes());
  nodes[held.front().node] = held.front().position;
  for (int i = held.front().node; i-- > 0;) nodes[i] = nodes[i + 1] + state.rest_lengths[i] * before;
  for (std::size_t k = 0; k + 1 < held.size(); ++k) {
    const int first = held[k].node, last = held[k + 1].node;
    nodes[last] = held[k + 1].position;
    if (held[k].slides && last == first + 1) continue;  // on a wheel, or as straight as it can be
    const std::vector<double> lengths(state.rest_lengths.begin() + first, state.rest_lengths.begin() + last);
    std::vector<double> weights;
    for (int i = first + 1; i < last; ++i) weights.push_back(weight * state.masses[i]);
    std::vector<double> axial_stiffness;
    for (int i = first; i < last; ++i) axial_stiffness.push_back(materials[i].axial_stiffness);
    const Vector3 &from = held[k].position, &to = held[k + 1].position;
    const double length = state.length(first, last);
    double width = folds == Folds::anywhere ? 0 : width_to_settle * length;
    // Side by side: folded onto itself it would carry a body, as a column does. With less slack its last link stands askew.
    const double slack = length - (to - from).norm(), shortest = *std::min_element(lengths.begin(), lengths.end());
    if ((held[k].body >= 0 || held[k + 1].body >= 0) && slack > (2 - rounding_of_slack) * shortest)
      width = std::max(width, 2 * materials.largest([](const MaterialDesc& material) { return material.radius; }));
    const Vector3 end = moved_apart(from, to, down, length, width);
    std::vector<Vector3> span = hanging_chain(from, end, lengths, weights, down, axial_stiffness);
    for (int i = 0; i <= last - first; ++i) span[i] += static_cast<double>(i) / (last - first) * (to - end);
    std::copy(span.begin(), span.end(), nodes.begin() + first);
  }
  for (int i = held.back().node; i < state.segments(); ++i) nodes[i + 1] = nodes[i] + state.rest_lengths[i] * after;
  return nodes;
}

/// Value of a polyline's per-point quantity at each node, the nodes spread along its arc length as they are along the cable's.
std::vector<Vector3> spread(const std::vector<Vector3>& points, const std::vector<Vector3>& values, const CableState& state) {
  std::vector<double> along{0};
  for (std::size_t i = 1; i < points.size(); ++i) along.push_back(along.back() + (points[i] - points[i - 1]).norm());
  std::vector<Vector3> nodes;
  std::size_t k = 0;
  for (const double s : state.arc_length()) {
    const double target = std::min(s / state.length(), 1.0) * along.back();
    while (k + 2 < along.size() && along[k + 1] < target) ++k;
    const double gap = along[k + 1] - along[k];
    const double fraction = gap > 0 ? std::min((target - along[k]) / gap, 1.0) : 0;
    nodes.push_back(values[k] + fraction * (values[k + 1] - values[k]));
  }
  return nodes;
}

}  // namespace

bool set_initial_state(const InitialShapeDesc& initial, Folds folds, const CableModel& model, const std::vector<HeldNode>& held,
                       const Vector3& gravity, CableState& state) {
  using Type = InitialShapeDesc::Type;
  state.velocities.assign(state.nodes(), Vector3::Zero());
  state.accelerations.assign(state.nodes(), Vector3::Zero());
  state.unresolved.acceleration_changes.assign(state.nodes(), Vector3::Zero());
  state.unresolved.turns.assign(state.nodes(), Vector3::Zero());
  state.tension.assign(state.segments(), 0.0);
  state.last_tension.assign(state.segments(), 0.0);
  state.axial_multiplier.assign(state.segments(), 0.0);
  bool fits = true;
  switch (initial.type) {
    case Type::straight:
      state.positions = straight_line(initial.from, (initial.to - initial.from).normalized(), state);
      fits = carry_along(model, held, gravity, state);
      break;
    case Type::points:
      state.positions = spread(initial.points, initial.points, state);
      if (!initial.velocities.empty()) state.velocities = spread(initial.points, initial.velocities, state);
      fits = carry_along(model, held, gravity, state);
      break;
    case Type::automatic:
    case Type::catenary:
    case Type::settled:
      state.positions = hanging(model, state, held, gravity, folds);
      project_positions(model, held, state);
      break;
  }
  // What holds it may leave no shape at all, as a wheel does that is wound more than once.
  const auto is_finite = [](const Vector3& v) { return v.allFinite(); };
  if (std::all_of(state.positions.begin(), state.positions.end(), is_finite) &&
      std::all_of(state.velocities.begin(), state.velocities.end(), is_finite))
    return fits;
  state.positions = straight_line(held.empty() ? Vector3(Vector3::Zero()) : held.front().position, Vector3::UnitX(), state);
  state.velocities.assign(state.nodes(), Vector3::Zero());
  return false;
}

bool settles_at_start(const CableDesc& desc, const CableModel& model, const CableState& state) {
  using Type = InitialShapeDesc::Type;
  if (desc.initial.type != Type::automatic) return desc.initial.type == Type::settled;
  if (!CableMaterials(model, state).any_bends()) return false;
  int ends = 0, between_ends = 0;  // on frames
  for (const AttachmentDesc& attachment : desc.attachments) {
    if (!attachment.body.empty()) continue;
    const int node = node_at(desc, attachment.place);
    ++(node > 0 && node < desc.segments ? between_ends : ends);
  }
  return std::any_of(desc.attachments.begin(), desc.attachments.end(),
                     [](const AttachmentDesc& a) { return a.type == AttachmentType::clamp; }) ||
         (ends == 0 && between_ends == 1);
}

namespace {

/// Nodes where they would hang between what holds them, whatever they did before.
void hang_nodes_anew(const CableModel& model, const std::vector<HeldNode>& held, const Vector3& gravity, CableState& state) {
  state.positions = hanging(model, state, held, gravity, Folds::anywhere);
  project_positions(model, held, state);
}

/// Where holders are nearer to each other than the lengths between them allow no shape fits, and none may be found.
void keep_finite(const std::vector<Vector3>& before, CableState& state) {
  const auto is_finite = [](const Vector3& place) { return place.allFinite(); };
  if (!std::all_of(state.positions.begin(), state.positions.end(), is_finite)) state.positions = before;
}

/// Gives the segments lengths [m] from a node on, along the directions that they have.
void set_lengths(int anchor, const std::vector<double>& lengths, CableState& state) {
  const std::vector<Vector3> before = state.positions;
  const auto direction = [&](int i) -> Vector3 {
    const Vector3 d = before[i + 1] - before[i];
    return d.norm() > 0 ? Vector3(d.normalized()) : Vector3(Vector3::UnitX());
  };
  for (int i = anchor; i < state.segments(); ++i) state.positions[i + 1] = state.positions[i] + lengths[i] * direction(i);
  for (int i = anchor; i-- > 0;) state.positions[i] = state.positions[i + 1] - lengths[i] * direction(i);
}

int anchor_of(const std::vector<HeldNode>& held, const CableState& state) {
  return held.empty() ? state.segments() / 2 : held.front().node;
}

bool carry_nodes_along(const CableModel& model, const std::vector<HeldNode>& held, const Vector3& gravity, CableState& state) {
  if (!held.empty()) {
    const std::vector<double> arc_length = state.arc_length();
    std::vector<Vector3> jumps;
    for (const HeldNode& h : held) jumps.push_back(h.position - state.positions[h.node]);
    std::size_t k = 0;
    for (int i = 0; i < state.nodes(); ++i) {
      while (k + 2 < held.size() && held[k + 1].node <= i) ++k;
      const HeldNode& before = held[k];
      if (k + 1 == held.size()) {
        state.positions[i] += jumps[k];
        continue;
      }
      const double gap = arc_length[held[k + 1].node] - arc_length[before.node];
      const double fraction = std::clamp((arc_length[i] - arc_length[before.node]) / gap, 0.0, 1.0);
      state.positions[i] += jumps[k] + fraction * (jumps[k + 1] - jumps[k]);
    }
  }
  if (project_positions(model, held, state)) return true;
  if (held.size() > 1) {
    // Holders that come close along a straight cable do not tell where its slack goes.
    hang_nodes_anew(model, held, gravity, state);
    return false;
  }
  // A cable with a free end can have any lengths where it is.
  const CableMaterials materials(model, state);
  std::vector<double> lengths = state.rest_lengths;
  for (int i = 0; i < state.segments(); ++i)
    if (is_elastic(materials[i])) lengths[i] = (state.positions[i + 1] - state.positions[i]).norm();
  set_lengths(anchor_of(held, state), lengths, state);
  return true;
}

}  // namespace

bool carry_along(const CableModel& model, const std::vector<HeldNode>& held, const Vector3& gravity, CableState& state) {
  const std::vector<Vector3> before = state.positions;
  const bool fits = carry_nodes_along(model, held, gravity, state);
  carry_frames(before, state);
  return fits;
}

void hang_anew(const CableModel& model, const std::vector<HeldNode>& held, const Vector3& gravity, CableState& state) {
  const std::vector<Vector3> before = state.positions;
  hang_nodes_anew(model, held, gravity, state);
  carry_frames(before, state);
}

void carry_with_targets(const CableModel& model, const std::vector<HeldNode>& held, const Vector3& gravity, CableState& state) {
  const std::vector<Vector3> before = state.positions;
  std::vector<double> lengths(state.segments());
  for (int i = 0; i < state.segments(); ++i) lengths[i] = (before[i + 1] - before[i]).norm();
  carry_nodes_along(model, held, gravity, state);
  const bool elastic = CableMaterials(model, state).any_elastic();
  if (elastic && !project_lengths(held, lengths, state)) {
    if (held.size() > 1)
      state.positions = hanging(model, state, held, gravity, Folds::anywhere);
    else
      set_lengths(anchor_of(held, state), lengths, state);
  }
  keep_finite(before, state);
  carry_frames(before, state);
}

void restore_lengths(const CableModel& model, const std::vector<HeldNode>& held, const Vector3& gravity, CableState& state) {
  const CableMaterials materials(model, state);
  if (!materials.any_rigid()) return;
  const int n = state.segments();
  std::vector<double> lengths(n);
  reachable_lengths(model, state, held, lengths);
  bool wrong = false;
  for (int i = 0; i < n; ++i) {
    const double length = (state.positions[i + 1] - state.positions[i]).norm();
    const auto slides_at = [&](int node) {
      return std::any_of(held.begin(), held.end(), [&](const HeldNode& h) { return h.slides && h.node == node; });
    };
    if (is_elastic(materials[i])) lengths[i] = length;
    if (slides_at(i) && slides_at(i + 1)) continue;
    wrong = wrong || std::abs(length - lengths[i]) > tolerated_length_error * lengths[i];
  }
  if (!wrong) return;
  const std::vector<Vector3> before = state.positions;
  set_lengths(anchor_of(held, state), lengths, state);
  carry_nodes_along(model, held, gravity, state);
  keep_finite(before, state);
  carry_frames(before, state);
  project_velocities(model, held, state);
  std::fill(state.accelerations.begin(), state.accelerations.end(), Vector3::Zero());
}

}  // namespace verlet_cable
