#include <algorithm>
#include <cmath>
#include <utility>

#include "guide/flow.h"
#include "rod/cable_stepper.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// A flow may change its mode so often in a substep; then it keeps it.
constexpr int most_changes = 8;
/// [m/s] Against its friction nothing flows faster.
constexpr double turned_round = 1e-9;

/// With which what a guide holds drives a way, whose work is what it gives back [N], and how that grows with the way [N/m]: with
/// the parts p and q of its length at the start and the end, -E ((1 - q²)² - (1 - p²)²) / (q - p).
std::array<double, 2> held_force(const GuidedFlow& guided, double way) {
  const double length = guided.held_length, start = guided.held_way / length, end = start + way / length;
  const double per_length = guided.held_energy / length;
  if (guided.held_energy == 0 || std::abs(start) >= 1) return {0, 0};
  if (std::abs(end) >= 1) {
    const double force = per_length * held_part(start) / (end - start);
    return {force, -force / way};
  }
  const double squares = start * start + end * end - 2;
  return {-per_length * (start + end) * squares, -per_length / length * (squares + 2 * end * (start + end))};
}

}  // namespace

bool CableStepper::grows(int segment) const {
  return std::any_of(flows_.begin(), flows_.end(), [&](const Flow& f) { return f.before == segment || f.after == segment; });
}

bool CableStepper::lies_on_wheel(int segment) const {
  return std::any_of(flows_.begin(), flows_.end(), [&](const Flow& f) { return f.first <= segment && segment < f.last; });
}

void CableStepper::start_flows(const Substep& s, const CableState& state) {
  if (flows_.empty()) return;
  const CableMaterials materials(s.model, state);
  bending_.start_flows(state, segment_, s.boundary.flows);
  system_.flow_load.assign(flows_.size(), 0.0);
  flow_response_.resize(3 * flows_.size() * flows_.size());
  flow_matrix_.resize(flows_.size() * flows_.size());
  flow_solution_.resize(flows_.size());
  for (std::size_t k = 0; k < flows_.size(); ++k) {
    Flow& flow = flows_[k];
    const GuidedFlow& guided = s.boundary.flows[k];
    flow.rate = s.statics ? 0 : guided.rate;
    flow.acceleration = s.statics ? 0 : guided.acceleration;
    flow.changes = 0;
    flow.changed = false;
    flow.way = flow.correction = 0;
    const double length = flowing_length(state.rest_lengths, flow.first, flow.last);
    flow.density = materials[flow.before].linear_density;
    flow.mass = flow.density * length + guided.inertia;
    flow.drag = materials[flow.before].drag / s.damping_time() * length;
    for (const int side : {0, 1}) {
      const int i = side == 0 ? flow.before : flow.after;
      flow.start_length[side] = state.rest_lengths[i];
      flow.stretch[side] = target_length_[i] / state.rest_lengths[i];
    }
    Vector3 start = get(velocity_, flow.first), end = start;
    for (const HeldNode& held : s.boundary.nodes)
      if (held.node == flow.first) {
        end = held.velocity;
        flow.moves = held.body >= 0;
      }
    flow.velocity_change = s.statics ? Vector3::Zero() : Vector3(end - start);
    flow.velocity = s.statics ? Vector3::Zero() : Vector3(get(displacement_, flow.first) / s.h);
    flow.mode = Flow::Mode::free;
    if (!resists(guided)) continue;
    flow.changes = -1;
    if (flow.rate >= 0)
      flow.mode = flow.rate > 0 && !guided.is_blocked[0] ? Flow::Mode::forward : Flow::Mode::stops_forward;
    else
      flow.mode = guided.is_blocked[1] ? Flow::Mode::stops_backward : Flow::Mode::backward;
  }
}

void CableStepper::predict_flows(const Substep& s) {
  for (Flow& flow : flows_)
    flow.way = is_stopped(flow) ? stopped_way(s, flow) : s.statics ? 0 : s.h * (flow.rate + 0.5 * s.h * flow.acceleration);
}

/// With which the flow stands at the end of the substep [m].
double CableStepper::resting_way(const Substep& s, const Flow& flow) const {
  if (s.statics) return 0;
  const VelocityWeights weights = velocity_weights(s.scheme);
  return -s.h * (weights.velocity * flow.rate + weights.acceleration * s.h * flow.acceleration) / weights.displacement;
}

/// Where a flow stops that comes from before, and one that comes from after [m]: where it stands at the end of the substep, or
/// has not flowed in all. That against which it stops does no work on it then.
std::pair<double, double> CableStepper::stopped_ways(const Substep& s, const Flow& flow) const {
  const double way = resting_way(s, flow);
  if (flow.rate == 0) return {way, way};
  return {std::max(0.0, way), std::min(0.0, way)};
}

double CableStepper::stopped_way(const Substep& s, const Flow& flow) const {
  const auto [forward, backward] = stopped_ways(s, flow);
  return flow.mode == Flow::Mode::stops_forward ? forward : backward;
}

/// Whether it stands at the end of the substep.
bool CableStepper::comes_to_rest(const Substep& s, const Flow& flow) const {
  return is_stopped(flow) && stopped_way(s, flow) == resting_way(s, flow);
}

/// [m/s]
double CableStepper::end_rate(const Substep& s, const Flow& flow) const {
  if (s.statics) return flow.way / s.h;
  const VelocityWeights weights = velocity_weights(s.scheme);
  return weights.displacement * flow.way / s.h + weights.velocity * flow.rate + weights.acceleration * s.h * flow.acceleration;
}

/// The segments beside guides have other lengths at the end of the substep.
void CableStepper::set_flow_lengths(const Substep& s) {
  for (const Flow& flow : flows_) {
    target_length_[flow.before] = flow.stretch[0] * flow.start_length[0];
    target_length_[flow.after] = flow.stretch[1] * flow.start_length[1];
    rest_growth_[flow.before] = rest_growth_[flow.after] = 0;
  }
  for (const GrowingSegment& growing : s.boundary.growing) rest_growth_[growing.segment] = s.h * growing.growth;
  bending_.forget_flows();
  if (rod_.active()) rod_.forget_flows();
  for (const Flow& flow : flows_) {
    target_length_[flow.before] -= flow.stretch[0] * flow.way;
    target_length_[flow.after] += flow.stretch[1] * flow.way;
    rest_growth_[flow.before] -= flow.way;
    rest_growth_[flow.after] += flow.way;
    bending_.add_flow(flow.before, flow.after, flow.way);
    if (rod_.active()) rod_.add_flow(flow.before, flow.after, flow.way);
  }
}

/// Of an elastic segment; sets its row.
DrawnLength CableStepper::evaluate_flowing_length(const Substep& s, int i) {
  const Straining strained = straining(s, i);
  const FlowingLength flowing{strained.start, strained.end, length_[i], std::sqrt(end_square_[i])};
  DrawnLength drawn = draw({axial_stiffness_[i], axial_damping_[i] / s.damping_time()}, flowing, tension_density_[i], s.part());
  if (keeps_tension(i)) {
    // The winch takes in what would lessen it.
    const double mean = flowing.start_length + s.part() * (flowing.length - flowing.start_length);
    const double tension = mean * (tension_density_[i] - drawn.row.gap / drawn.row.compliance);
    drawn.row = kept_row({tension, 0}, tension_density_[i], mean, flowing.length, s.part(), least_winch_stiffness());
    drawn.slope = 0;
  }
  set_row(i, drawn.row);
  return drawn;
}

void CableStepper::evaluate_flows(const Substep& s) {
  const double part = s.part();
  for (std::size_t k = 0; k < flows_.size(); ++k) {
    Flow& flow = flows_[k];
    const GuidedFlow& guided = s.boundary.flows[k];
    const double density = flow.density;
    const bool elastic = is_elastic_at(flow.before);
    const std::array<int, 2> segments{flow.before, flow.after};
    std::array<double, 2> arm, drawn;
    // Friction is between tensions T, and acts on what is stretched: EA e^2 / 2 less than T (1 + e) is drawn on either side, in
    // all their difference times 1 and the mean of the strains.
    double stretched = 1;
    for (const int side : {0, 1}) {
      const int i = segments[side];
      const double sign = side == 0 ? -1 : 1, end = target_length_[i];
      if (elastic) {
        const DrawnLength length = evaluate_flowing_length(s, i);
        drawn[side] = length.force;
        flow.gap[side] = sign * length.slope;
        arm[side] = mean(length_[i], std::sqrt(end_square_[i]), part);
        stretched += 0.5 * length.strain;
      } else {
        arm[side] = mean(length_[i], end, part);
        flow.gap[side] = keeps_tension(i) ? 0 : sign * flow.stretch[side] * end;
        drawn[side] = tension_density_[i] * arm[side];
      }
    }

    if (flow.moves && !s.statics) {
      const Vector3 u = get(displacement_, flow.first), v = get(velocity_, flow.first);
      flow.velocity = u / s.h;
      flow.velocity_change = s.inertia() * (u / s.h - v);
    }

    // What drives it: tensions, the weight of what flows, and the energy of bends beside the guide.
    const GravityDesc& law = s.environment.gravity;
    const Vector3 gravity =
        law.at(get(position_, flow.first)) - (s.statics ? Vector3(Vector3::Zero()) : Vector3(flow.velocity_change / s.h));
    Vector3 along = get(middle_, flow.before) + get(middle_, flow.after);
    for (int i = flow.first; i < flow.last; ++i) along += 2 * get(middle_, i);
    double drive = drawn[1] - drawn[0] + 0.5 * density * gravity.dot(along);
    drive += rod_.active() ? rod_.flow_force(flow.before, flow.after) : bending_.flow_force(flow.before, flow.after, middle_);
    if (fluid_.active()) {
      const Vector3 direction = 0.5 * (get(middle_, flow.before).normalized() + get(middle_, flow.after).normalized());
      drive += fluid_.force(flow.first).dot(direction);
    }
    // The neighbours lose and gain mass. Along the cable it comes with the velocity that it has; across it is another.
    for (const int side : {0, 1}) {
      const int node = side == 0 ? flow.before : flow.after + 1;
      if (system_.movable[node] == 0) continue;
      const double gain = (side == 0 ? -0.5 : 0.5) * density * flow.way;
      const Vector3 u = get(displacement_, node), v = get(velocity_, node);
      Vector3 load = 0.5 * gain * law.at(get(position_, node));
      if (!s.statics) {
        load -= 0.5 * gain * s.inertia() / s.h * (u / s.h - v);
        const Vector3 direction = get(middle_, segments[side]).normalized();
        const Vector3 mean = u / s.h - flow.velocity, start = v - (get(velocity_, flow.first));
        const double along_it = mean.dot(direction);
        load -= gain / s.h * (mean - along_it * direction);
        const double sign = side == 0 ? 1 : -1;
        drive += sign * density * (0.5 * along_it * along_it - 0.25 * start.dot(2 * mean - start));
      }
      set(system_.load, node, get(system_.load, node) + load);
    }
    const double bends = bending_.flow_column(flow.before, flow.after, middle_, flow.column);
    // The weight of what flows hangs on other nodes then.
    for (const int side : {0, 1}) {
      const int node = side == 0 ? flow.before : flow.after + 1;
      flow.column[node - flow.first_node()] += (side == 0 ? -0.5 : 0.5) * part * density * gravity;
    }
    const auto [held, held_slope] = s.statics ? std::array{0.0, 0.0} : held_force(guided, flow.way);
    drive += held;
    drive -= flow.drag * flow.way;
    drive -= flow.mass * s.inertia() / s.h * (flow.way / s.h - flow.rate);

    // Friction follows how hard the guide presses on the cable. Between the middle of a segment and the guide is half of it,
    // which weighs and is accelerated, too.
    const double gain = s.statics ? 0 : (end_rate(s, flow) - flow.rate) / s.h;
    const auto half = [&](int i) -> Vector3 {
      const Vector3 direction = get(middle_, i).normalized();
      return 0.5 * density * target_length_[i] * (gravity - gain * direction);
    };
    const Vector3 before = get(segment_force_, flow.before) - half(flow.before);
    const Vector3 after = get(segment_force_, flow.after) + half(flow.after);
    const Vector3 from = get(middle_, flow.before).normalized(), to = get(middle_, flow.after).normalized();
    const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
    const Vector3 tangent = (from + to).stableNormalized(), given = after - before;
    const Vector3 across = given - given.dot(tangent) * tangent;
    const double press = across.norm(), grip = rubbing_part(guided.grip, angle);
    // A bearing resists no more than the cable holds on its wheel.
    const bool slips = grip < infinity && grip * press < guided.resistance;
    const double part_of_press = stretched * (rubbing_part(guided.friction, angle) + (slips ? grip : 0));
    const double rubs = part_of_press < infinity ? part_of_press * press + (slips ? 0 : stretched * guided.resistance) : infinity;
    // A winch that has just changed its mode leaves tensions that say nothing of the flow's: where neither gives way, what is
    // between them has any.
    const bool may_change = flow.changes < most_changes && !(winch_.segment >= 0 && winch_.changed);
    const Flow::Mode mode = !resists(guided) ? Flow::Mode::free
                            : may_change     ? next_mode(s, flow, guided, drive, rubs)
                                             : flow.mode;
    // The first time tensions are those of the substep before.
    flow.changed = mode != flow.mode || flow.changes < 0;
    if (flow.changed) ++flow.changes;
    flow.mode = mode;
    const bool sticks = is_stopped(flow);
    const double sense = mode == Flow::Mode::forward ? 1 : mode == Flow::Mode::backward ? -1 : 0;
    flow.resistance = sticks ? drive : sense == 0 ? 0 : sense * rubs;

    // How it follows the forces, which act along segments that turn.
    const Vector3 rise = sense == 0 || !(press > 0) ? Vector3::Zero() : Vector3(sense * part_of_press / press * across);
    flow.rubbing.fill(Vector3::Zero());
    for (const int side : {0, 1}) {
      const int i = segments[side], first = i - flow.first_node();
      const double turned = (tension_density_[i] < 0 ? compressed_part_ : part) * tension_density_[i];
      const Vector3 more = side == 0 ? Vector3(-turned * rise) : Vector3(turned * rise);
      flow.rubbing[first] -= more;
      flow.rubbing[first + 1] += more;
    }

    if (sticks) {
      flow.row = {0, 0};
      flow.diagonal = -1;
      system_.flow_load[k] = stopped_way(s, flow) - flow.way;
      continue;
    }
    flow.row = {-arm[0] + rise.dot(get(middle_, flow.before)), arm[1] - rise.dot(get(middle_, flow.after))};
    flow.diagonal = -flow.mass * s.inertia() / (s.h * s.h) - flow.drag + bends + held_slope;
    if (!elastic) flow.diagonal += part * (tension_density_[flow.before] + tension_density_[flow.after]);
    system_.flow_load[k] = drive - flow.resistance;
  }
}

/// The mode that a flow's present way calls for, whatever drives it.
Flow::Mode CableStepper::mode_of_way(const Substep& s, const Flow& flow) const {
  using Mode = Flow::Mode;
  const auto [forward, backward] = stopped_ways(s, flow);
  const double rounding = turned_round * s.h;
  switch (flow.mode) {
    case Mode::forward:
      return flow.way < forward - rounding ? Mode::stops_forward : Mode::forward;
    case Mode::backward:
      return flow.way > backward + rounding ? Mode::stops_backward : Mode::backward;
    case Mode::turns:
      return flow.way > forward + rounding    ? Mode::stops_forward
             : flow.way < backward - rounding ? Mode::stops_backward
                                              : Mode::turns;
    default:
      return flow.mode;
  }
}

/// `drive` [N] of the present iterate; `rubs` [N]: what friction has against it.
Flow::Mode CableStepper::next_mode(const Substep& s, const Flow& flow, const GuidedFlow& guided, double drive,
                                   double rubs) const {
  using Mode = Flow::Mode;
  if (!is_stopped(flow)) return mode_of_way(s, flow);
  const auto [forward, backward] = stopped_ways(s, flow);
  const bool at_forward = forward == backward || flow.mode == Mode::stops_forward;
  const bool at_backward = forward == backward || flow.mode == Mode::stops_backward;
  if (drive > (!at_forward ? 0 : guided.is_blocked[0] ? infinity : rubs)) return at_forward ? Mode::forward : Mode::turns;
  if (drive < -(!at_backward ? 0 : guided.is_blocked[1] ? infinity : rubs)) return at_backward ? Mode::backward : Mode::turns;
  return flow.mode;
}

bool CableStepper::flows_are_consistent(const Substep& s) const {
  if (winch_.segment >= 0 && !winch_is_consistent(s)) return false;
  return std::all_of(flows_.begin(), flows_.end(), [&](const Flow& flow) {
    return !flow.changed && (flow.changes >= most_changes || mode_of_way(s, flow) == flow.mode);
  });
}

/// On the holder of a node: what flows turns round the guide, and is accelerated there; neither is in the equations of its held
/// nodes.
Vector3 CableStepper::flow_reaction(const Substep& s, int node) const {
  if (s.statics) return Vector3::Zero();
  const auto flow = std::find_if(flows_.begin(), flows_.end(), [node](const Flow& f) { return f.first == node; });
  if (flow == flows_.end()) return Vector3::Zero();
  const Vector3 before = get(middle_, flow->before), after = get(middle_, flow->after);
  const double speed = flow->way / s.h, gain = (end_rate(s, *flow) - flow->rate) / s.h;
  Vector3 way = 0.5 * (before + after);
  for (int i = flow->first; i < flow->last; ++i) way += get(middle_, i);
  return -flow->density * (speed * speed * (after.normalized() - before.normalized()) + gain * way);
}

}  // namespace verlet_cable
