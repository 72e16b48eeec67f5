#include <algorithm>
#include <cmath>
#include <utility>

#include "rod/bending_memory.h"
#include "rod/cable_stepper.h"
#include "rod/rod_frames.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// A flow may change its mode so often in a substep; then it keeps it.
constexpr int most_changes = 8;
/// Of the length of a segment: no flow takes so much that less is left.
constexpr double least_left = 0.02;
/// [m/s] Against its friction nothing flows faster.
constexpr double turned_round = 1e-9;

/// Solves a small dense system with pivots from each column; `matrix` is by rows, and both are used up.
void solve_dense(int size, std::vector<double>& matrix, std::vector<double>& vector) {
  const auto at = [&](int row, int column) -> double& { return matrix[row * size + column]; };
  for (int k = 0; k < size; ++k) {
    int pivot = k;
    for (int i = k + 1; i < size; ++i)
      if (std::abs(at(i, k)) > std::abs(at(pivot, k))) pivot = i;
    if (pivot != k) {
      for (int j = k; j < size; ++j) std::swap(at(k, j), at(pivot, j));
      std::swap(vector[k], vector[pivot]);
    }
    for (int i = k + 1; i < size; ++i) {
      const double factor = at(i, k) / at(k, k);
      for (int j = k + 1; j < size; ++j) at(i, j) -= factor * at(k, j);
      vector[i] -= factor * vector[k];
    }
  }
  for (int k = size - 1; k >= 0; --k) {
    for (int j = k + 1; j < size; ++j) vector[k] -= at(k, j) * vector[j];
    vector[k] /= at(k, k);
  }
}

double mean(double a, double b, double part) {
  return a + part * (b - a);
}
std::array<double, 2> mean(const std::array<double, 2>& a, const std::array<double, 2>& b, double part) {
  return {mean(a[0], b[0], part), mean(a[1], b[1], part)};
}

/// What the material at the guide's nodes has: where it comes from, there it was.
template <class T>
void flow_on(const Flow& flow, const std::vector<double>& rest_lengths, std::vector<T>& values) {
  for (const int node : {flow.first, flow.last}) {
    const int from = flow.way > 0 ? node - 1 : node + 1;
    const double length = rest_lengths[std::min(from, node)];
    values[node] = mean(values[node], values[from], std::min(std::abs(flow.way) / length, 1.0));
    if (flow.first == flow.last) break;
  }
}

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

/// What unit ways do to the tensions beside all guides.
void CableStepper::factor_flows() {
  const int count = static_cast<int>(flows_.size());
  std::swap(system_.load, kept_load_);
  std::swap(system_.gap, kept_gap_);
  std::swap(rod_.torque(), kept_torque_);
  const bool moves_held = std::exchange(system_.moves_held, false);
  system_.load.assign(segments_ + 2, 0.0);
  rod_.torque().assign(segments_ + 2, 0.0);
  for (int j = 0; j < count; ++j) {
    system_.gap.assign(segments_ + 2, 0.0);
    system_.gap[flows_[j].before] += flows_[j].gap[0];
    system_.gap[flows_[j].after] += flows_[j].gap[1];
    add_column(flows_[j], 1);
    solve_segments();
    for (int k = 0; k < count; ++k) {
      double* const response = &flow_response_[3 * (j * count + k)];
      response[0] = multiplier_correction()[flows_[k].before];
      response[1] = multiplier_correction()[flows_[k].after];
      response[2] = along_row(flows_[k]);
    }
    add_column(flows_[j], -1);
  }
  system_.moves_held = moves_held;
  std::swap(system_.load, kept_load_);
  std::swap(system_.gap, kept_gap_);
  std::swap(rod_.torque(), kept_torque_);
}

/// The solution of the segments alone becomes that of segments and flows.
void CableStepper::let_flow() {
  const int count = static_cast<int>(flows_.size());
  const std::vector<double>& multiplier = multiplier_correction();
  for (int k = 0; k < count; ++k) {
    const Flow& flow = flows_[k];
    const double moves = is_stopped(flow) ? 0 : 1;
    flow_solution_[k] = system_.flow_load[k] + flow.row[0] * multiplier[flow.before] + flow.row[1] * multiplier[flow.after] +
                        moves * along_row(flow);
    for (int j = 0; j < count; ++j) {
      const double* response = &flow_response_[3 * (j * count + k)];
      flow_matrix_[k * count + j] =
          -flow.row[0] * response[0] - flow.row[1] * response[1] - moves * response[2] - (j == k ? flow.diagonal : 0);
    }
  }
  solve_dense(count, flow_matrix_, flow_solution_);
  flow_gap_ = system_.gap;
  for (int k = 0; k < count; ++k) {
    flows_[k].correction = flow_solution_[k];
    system_.gap[flows_[k].before] += flows_[k].gap[0] * flow_solution_[k];
    system_.gap[flows_[k].after] += flows_[k].gap[1] * flow_solution_[k];
  }
  flow_node_load_ = system_.load;
  for (const Flow& flow : flows_) add_column(flow, flow.correction);
  solve_segments();
  std::swap(system_.load, flow_node_load_);
  std::swap(system_.gap, flow_gap_);
}

/// Adds what a way changes of the loads on nodes.
void CableStepper::add_column(const Flow& flow, double way) {
  for (std::size_t i = 0; i < flow.column.size(); ++i) {
    const int node = flow.first_node() + static_cast<int>(i);
    if (node < 0 || node > segments_) continue;
    set(system_.load, node, get(system_.load, node) + way * flow.column[i]);
  }
}

/// What the nodes of the last solution do to what drives a flow [N].
double CableStepper::along_row(const Flow& flow) const {
  return along(flow, flow.column) - along(flow, flow.rubbing);
}

double CableStepper::along(const Flow& flow, const FlowColumn& column) const {
  double sum = 0;
  for (std::size_t i = 0; i < column.size(); ++i) {
    const int node = flow.first_node() + static_cast<int>(i);
    if (node >= 0 && node <= segments_) sum += column[i].dot(get(correction(), node));
  }
  return sum;
}

/// False if so much would flow that next to nothing is left.
bool CableStepper::correct_flows(double part) {
  bool is_left = true;
  const std::vector<double>& multiplier = multiplier_correction();
  for (Flow& flow : flows_) {
    flow.way += part * flow.correction;
    is_left =
        is_left && flow.way < (1 - least_left) * flow.start_length[0] && -flow.way < (1 - least_left) * flow.start_length[1];
    if (!is_resisted(flow)) continue;
    // What of the corrections is not in the row, friction takes.
    const auto arm = [&](int i) { return 0.5 * (length_[i] + std::sqrt(end_square_[i])); };
    flow.resistance += part * (arm(flow.after) - flow.row[1]) * multiplier[flow.after];
    flow.resistance -= part * (arm(flow.before) + flow.row[0]) * multiplier[flow.before];
    flow.resistance += part * along(flow, flow.rubbing);
  }
  return is_left;
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

namespace {

/// What is remembered goes with the material, by the lengths that it had.
void carry_memory(const Flow& flow, CableState& state) {
  const int border = 2 * flow.before + 1;
  if (flow.first == flow.last)
    carry_bends(border, {0.5 * flow.way, flow.way, 0.5 * flow.way}, state);
  else
    carry_bends(border, {0.5 * flow.way, flow.way, flow.way, flow.way, 0.5 * flow.way}, state);
}

}  // namespace

void CableStepper::finish_flows(const Substep& s, CableState& state) {
  if (!state.bending_memory.empty())
    for (const Flow& flow : flows_) carry_memory(flow, state);
  for (std::size_t k = 0; k < flows_.size(); ++k) {
    const Flow& flow = flows_[k];
    const double half_density = 0.5 * flow.density;
    GuidedFlow& guided = s.boundary.flows[k];
    double rate = s.statics || comes_to_rest(s, flow) ? 0 : end_rate(s, flow);
    if ((flow.mode == Flow::Mode::forward && rate < 0) || (flow.mode == Flow::Mode::backward && rate > 0)) rate = 0;
    guided.rate = rate;
    guided.acceleration = s.statics ? 0 : (rate - flow.rate) / s.h;
    if (s.scheme == Scheme::damped) guided.acceleration = (flow.way / s.h - flow.rate) / s.h + 0.5 * flow.acceleration;
    if (!s.statics) guided.held_way += flow.way;
    state.rest_lengths[flow.before] -= flow.way;
    state.rest_lengths[flow.after] += flow.way;
    state.masses[flow.before] -= half_density * flow.way;
    state.masses[flow.first] -= half_density * flow.way;
    state.masses[flow.last] += half_density * flow.way;
    state.masses[flow.after + 1] += half_density * flow.way;
  }
}

/// The same in the linear system of impulses, whose unknowns for flows are the changes of their rates.
void CableStepper::begin_flow_projection(const Substep& s, const CableState& state) {
  system_.flow_load.assign(flows_.size(), 0.0);
  for (std::size_t k = 0; k < flows_.size(); ++k) {
    Flow& flow = flows_[k];
    const bool moves = !comes_to_rest(s, flow);
    const double rate = s.boundary.flows[k].rate;
    flow.row = flow.gap = {0, 0};
    flow.column.fill(Vector3::Zero());
    flow.rubbing.fill(Vector3::Zero());
    flow.diagonal = moves ? -flow.mass : -1;
    for (const int side : {0, 1}) {
      const int i = side == 0 ? flow.before : flow.after;
      if (is_elastic_at(i)) continue;
      const double length = side == 0 ? -state.rest_lengths[i] : state.rest_lengths[i];
      system_.gap[i] += length * rate;
      flow.gap[side] = length;
      if (moves) flow.row[side] = length;
    }
  }
}

/// The frame of a segment that flows on is that of other material then, in its middle.
void CableStepper::carry_frames_with_flows(const CableModel& model, CableState& state) const {
  const auto twist_rate = [&](int node) {
    if (node < 0 || node > segments_) return 0.0;
    return material_twist(model, state, node) / joint_length(state, node);
  };
  for (const Flow& flow : flows_) {
    // Where what comes to the middle is now
    const std::array<double, 2> rates = flow.way > 0 ? std::array{twist_rate(flow.before), twist_rate(flow.last)}
                                                     : std::array{twist_rate(flow.first), twist_rate(flow.after + 1)};
    for (const int side : {0, 1}) {
      const int segment = side == 0 ? flow.before : flow.after;
      const double turn = -0.5 * flow.way * rates[side];
      turn_segment(segment, turn, state);
      state.joint_twist[segment] += turn;
      state.joint_twist[segment + 1] -= turn;
    }
    if (!state.rest_curvature.empty()) flow_on(flow, state.rest_lengths, state.rest_curvature);
    if (!state.rest_twist.empty()) flow_on(flow, state.rest_lengths, state.rest_twist);
  }
}

/// In the system of impulses.
FlowRate CableStepper::rate_of(const Substep& s, const Flow& flow) const {
  return {flow.first,
          flow.last,
          target_length_[flow.before],
          target_length_[flow.after],
          comes_to_rest(s, flow) ? infinity : flow.mass,
          s.boundary.flows[&flow - flows_.data()].rate};
}

/// Impulses along the segments beside a guide move what flows, too.
void CableStepper::project_flows(const Substep& s) {
  for (const Flow& flow : flows_)
    if (!is_elastic_at(flow.before)) add_flow_rate(rate_of(s, flow), pivot_, off_, impulse_);
  keep_unmoved(segments_, pivot_, impulse_);
}

void CableStepper::push_flows(const Substep& s, SubstepResult& result) {
  for (std::size_t k = 0; k < flows_.size(); ++k) {
    const Flow& flow = flows_[k];
    if (!is_elastic_at(flow.before)) mend_flow(flow, change_of_rate(rate_of(s, flow), impulse_), s.boundary.flows[k], result);
  }
}

/// As velocities are mended. `change`: of the rate [m/s].
void CableStepper::mend_flow(const Flow& flow, double change, GuidedFlow& guided, SubstepResult& result) {
  result.balance.dissipated.unresolved -= flow.mass * change * (guided.rate + 0.5 * change);
  guided.rate += change;
}

}  // namespace verlet_cable
