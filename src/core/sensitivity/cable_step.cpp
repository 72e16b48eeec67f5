#include <algorithm>
#include <cmath>

#include "law/length_rate.h"
#include "rod/substep.h"
#include "rod/unresolved_motion.h"
#include "sensitivity/cable_sensitivity.h"
#include "sensitivity/column_algebra.h"

namespace verlet_cable {

namespace {

/// [segment lengths] What a step has found is no further from the solution of its equations, besides what its tolerance leaves.
constexpr double step_error = 1e-6;
/// [segment lengths a step] Velocities that are retraced are those of the state up to this.
constexpr double velocity_error = 1e-6;
/// [m] Holders are where their attachments want them.
constexpr double holder_error = 1e-9;
/// [m/s] As of frames that start: see follow_aims.
constexpr double fastest_start = 50;
/// Of the impulses that start a cable with its holders: see project_velocities.
constexpr double start_regularisation = 1e-12;

/// Impulses over length along the segments that end all change of their lengths, see CableStepper::project: of these velocities.
std::vector<Column> impulses_of(const std::vector<ColumnVector>& segments, const std::vector<ColumnVector>& velocities,
                                const std::vector<Column>& mobility, double regularisation) {
  const int n = static_cast<int>(segments.size());
  std::vector<Column> diagonal(n), off(n), x(n);
  for (int i = 0; i < n; ++i) {
    const bool is_held = mobility[i].value == 0 && mobility[i + 1].value == 0;
    diagonal[i] =
        is_held ? Column(1) : length_rate_diagonal(dot(segments[i], segments[i]), mobility[i] + mobility[i + 1], regularisation);
    if (i + 1 < n) off[i] = length_rate_coupling(dot(segments[i], segments[i + 1]), mobility[i + 1]);
    if (!is_held) x[i] = dot(segments[i], velocities[i] - velocities[i + 1]);
  }
  for (int i = 1; i < n; ++i) {
    const Column ratio = off[i - 1] / diagonal[i - 1];
    diagonal[i] -= ratio * off[i - 1];
    x[i] -= ratio * x[i - 1];
  }
  for (int i = n - 1; i >= 0; --i) x[i] = (i + 1 < n ? x[i] - off[i] * x[i + 1] : x[i]) / diagonal[i];
  return x;
}

/// What they are on a node [N s].
ColumnVector impulse_on(int node, const std::vector<ColumnVector>& segments, const std::vector<Column>& impulses) {
  ColumnVector impulse = zero_vector<Column>();
  if (node > 0) impulse = impulse + impulses[node - 1] * segments[node - 1];
  if (node < static_cast<int>(segments.size())) impulse = impulse - impulses[node] * segments[node];
  return impulse;
}

/// As the function of this name in kinematic_targets.cpp.
ColumnVector velocity_at_end(const ColumnVector& start, const ColumnVector& mean, const ColumnVector& headed) {
  const Vector3 reach = values_of(start) - values_of(mean), change = values_of(headed) - values_of(mean);
  if (!(change.norm() > reach.norm())) return headed;
  if (reach.isZero(0)) return mean;
  return mean + (norm(start - mean) / norm(headed - mean)) * (headed - mean);
}

double greatest_difference(const std::vector<ColumnVector>& a, const std::vector<Vector3>& b) {
  double greatest = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    const double difference = (values_of(a[i]) - b[i]).norm();
    if (!(difference <= greatest)) greatest = difference;
  }
  return greatest;
}

}  // namespace

/// Retraces a step. `first` has the matrix of its equations.
std::string CableSensitivity::follow(const State& state, Columns& first, Columns& columns) {
  Step step{state, numbers_of(columns, state), state.scene->time_step, before_.state.segments()};
  take_values(before_.state, columns);
  std::string problem = follow_holders(columns, step);
  if (problem.empty()) problem = find_solution(first, columns, step);
  if (!problem.empty()) return problem;
  find_velocities(columns, step);
  if (!stretches(before_.model->material)) project(columns, step);
  const std::vector<Column> start_multipliers = columns.multipliers;
  const bool is_unresolved = advance(columns, step);
  if (is_unresolved) problem = clean(step.numbers, start_multipliers, step.h, step.forces, columns);
  if (!problem.empty()) return problem;
  const double shortest = *std::min_element(before_.state.rest_lengths.begin(), before_.state.rest_lengths.end());
  if (!(greatest_difference(columns.velocities, state.cables[cable_].state.velocities) < velocity_error * shortest / step.h))
    return "its velocities are changed in a way that derivatives do not know of";
  set_wrenches(state, step.forces, targets_, columns);
  return {};
}

/// Where holders go, see follow_aims; a cable whose holders start begins to move with them.
std::string CableSensitivity::follow_holders(Columns& columns, Step& step) const {
  const State& state = step.state;
  const CableState& after = state.cables[cable_].state;
  const KinematicTargets& targets_after = state.cable_progress[cable_].targets;
  if (after.segments() != step.segments || targets_after.nodes.size() != targets_.nodes.size() ||
      targets_after.directions.size() != targets_.directions.size())
    return "it was edited";
  if (after.yielding > 0) return "its holders draw it straight (overstretched)";
  bool starts = false;
  for (std::size_t k = 0; k < targets_.nodes.size(); ++k) {
    const KinematicTarget& target = targets_.nodes[k];
    const Attachment& attachment = state.attachments[target.attachment];
    if (targets_after.nodes[k].jumping_steps > 0) return "its holder jumps";
    const Vector3 own = (state.frames.poses[attachment.frame] * attachment.pose).position;
    if (target.node == attachment.node && !((own - after.positions[target.node]).norm() < holder_error))
      return "it is still brought to its holder";
    step.wanted.push_back(wanted_place(columns, state, target, after.positions[target.node]));
    step.means.push_back(times(1 / step.h, step.wanted.back() - columns.positions[target.node]));
    set_values(target.velocity, columns.holder_velocities[k]);
    set_values(target.mean_velocity, columns.holder_means[k]);
    if (!target.starts) continue;
    starts = true;
    if (values_of(step.means.back()).norm() <= fastest_start)
      columns.holder_velocities[k] = columns.holder_means[k] = step.means.back();
  }
  for (std::size_t k = 0; k < targets_.directions.size(); ++k) {
    const Attachment& attachment = state.attachments[targets_.directions[k].attachment];
    const Quaternion own = (state.frames.poses[attachment.frame] * attachment.pose).orientation;
    const Vector3 difference = own * Vector3::UnitX() - targets_after.directions[k].orientation * Vector3::UnitX();
    if (!(difference.norm() < holder_error)) return "it is still brought to its clamp";
  }
  step.mobility.resize(step.segments + 1);
  for (int i = 0; i <= step.segments; ++i) step.mobility[i] = 1.0 / step.numbers.masses[i];
  for (const KinematicTarget& target : targets_.nodes) step.mobility[target.node] = 0;
  if (starts) start_with_holders(columns, step);
  for (std::size_t k = 0; k < step.wanted.size(); ++k) {
    const ColumnVector& mean = step.means[k];
    const ColumnVector headed = mean + times(0.5, mean - columns.holder_means[k]);
    columns.holder_velocities[k] = velocity_at_end(columns.holder_velocities[k], mean, headed);
  }
  columns.holder_means = step.means;
  return {};
}

void CableSensitivity::start_with_holders(Columns& columns, const Step& step) const {
  for (std::size_t k = 0; k < targets_.nodes.size(); ++k)
    columns.velocities[targets_.nodes[k].node] = columns.holder_velocities[k];
  if (stretches(before_.model->material)) return;
  std::vector<ColumnVector> segments(step.segments);
  for (int i = 0; i < step.segments; ++i) segments[i] = columns.positions[i + 1] - columns.positions[i];
  const std::vector<Column> impulses = impulses_of(segments, columns.velocities, step.mobility, start_regularisation);
  for (int i = 0; i <= step.segments; ++i)
    columns.velocities[i] = columns.velocities[i] + step.mobility[i] * impulse_on(i, segments, impulses);
}

/// The equations of the step, at the solution that it has found.
std::string CableSensitivity::find_solution(Columns& first, Columns& columns, const Step& step) const {
  const CableState &before = before_.state, &after = step.state.cables[cable_].state;
  const int n = step.segments;
  PlainEquations& e = columns.equations;
  set_equations(step.state, step.numbers, targets_, step.h, false, columns);
  e.displacement.resize(n + 1);
  e.density.resize(n);
  for (int i = 0; i <= n; ++i) e.displacement[i] = constant(after.positions[i] - before.positions[i]);
  for (std::size_t k = 0; k < step.wanted.size(); ++k) {
    const int node = targets_.nodes[k].node;
    e.displacement[node] = step.wanted[k] - columns.positions[node];
  }
  for (int i = 0; i < n; ++i) {
    if (e.fixed_density[i] != 0) {
      e.density[i] = columns.multipliers[i] / step.numbers.rest_lengths[i];
      continue;
    }
    double length = before.rest_lengths[i];
    if (stretches(before_.model->material))
      length =
          0.5 * ((before.positions[i + 1] - before.positions[i]).norm() + (after.positions[i + 1] - after.positions[i]).norm());
    e.density[i] = after.axial_multiplier[i] / length;
  }
  e.evaluate();
  if (&columns == &first && !e.factor()) return "the step's equations have no unique solution";
  const double shortest = *std::min_element(before.rest_lengths.begin(), before.rest_lengths.end());
  const double tolerated = step_error + 100 * step.state.scene->tolerance * std::min(step.h, longest_tolerated);
  if (!(e.solve(first.equations) < tolerated * shortest)) return "something acts on it that derivatives do not know of";
  return {};
}

/// At the end of the step, and forces on holders, before velocities are mended.
void CableSensitivity::find_velocities(const Columns& columns, Step& step) const {
  const PlainEquations& e = columns.equations;
  const int n = step.segments;
  const double h = step.h;
  step.velocities.resize(n + 1);
  step.ends.resize(n);
  step.forces.assign(n + 1, zero_vector<Column>());
  for (int i = 0; i <= n; ++i) step.velocities[i] = times(2 / h, e.displacement[i]) - columns.velocities[i];
  for (int i = 0; i < n; ++i) step.ends[i] = e.start[i] + e.change_of(i);
  for (std::size_t k = 0; k < targets_.nodes.size(); ++k) {
    const int i = targets_.nodes[k].node;
    const Column& mass = step.numbers.masses[i];
    step.velocities[i] = columns.holder_velocities[k];
    // What the equations lack is what the holder supplies; they have the inertia of a node that is not held.
    step.forces[i] = e.residual()[i] + mass * times(2 / h, times(1 / h, e.displacement[i]) - columns.velocities[i]) -
                     mass * times(1 / h, step.velocities[i] - columns.velocities[i]);
  }
}

/// See CableStepper::project and scale_to_lose.
void CableSensitivity::project(const Columns& columns, Step& step) const {
  const int n = step.segments;
  const double h = step.h;
  // As they were at the start
  CableState started = before_.state;
  for (int i = 0; i <= n; ++i) started.velocities[i] = values_of(columns.velocities[i]);
  Boundary boundary;
  for (const KinematicTarget& target : targets_.nodes) {
    boundary.nodes.emplace_back();
    boundary.nodes.back().node = target.node;
    boundary.nodes.back().velocity = values_of(step.velocities[target.node]);
  }
  std::vector<TwistSpan> spans;
  const Environment environment{step.state.scene->gravity, step.state.scene->fluid, no_waves};
  if (!holders_accelerate({*before_.model, environment, boundary, spans, h}, started)) return;
  std::vector<Column> impulses = impulses_of(step.ends, step.velocities, step.mobility, length_rate_regularisation);
  Column ended, along, known;
  for (int i = 0; i < n; ++i) ended += impulses[i] * dot(step.ends[i], step.velocities[i] - step.velocities[i + 1]);
  along = ended;
  for (const KinematicTarget& target : targets_.nodes) {
    const int i = target.node;
    const ColumnVector &start = columns.velocities[i], &end = step.velocities[i];
    const ColumnVector mean = times(1 / h, columns.equations.displacement[i]);
    along += dot(impulse_on(i, step.ends, impulses), end - mean);
    known -= step.numbers.masses[i] * dot(end - start, times(0.5, start + end) - mean);
  }
  if (known.value < 0) known = 0;
  const Column share = losing_share(known, along, 0.5 * ended);
  for (Column& impulse : impulses) impulse = share * impulse;
  for (int i = 0; i <= n; ++i) {
    const ColumnVector impulse = impulse_on(i, step.ends, impulses);
    step.velocities[i] = step.velocities[i] + step.mobility[i] * impulse;
    if (columns.equations.movable[i] == 0) step.forces[i] = step.forces[i] + times(1 / h, impulse);
  }
}

/// To the end of the step. Returns whether motion is found that it has not resolved: see MotionCleaner.
bool CableSensitivity::advance(Columns& columns, const Step& step) const {
  const PlainEquations& e = columns.equations;
  const UnresolvedMotion& unresolved = before_.state.unresolved;
  const bool is_watched = step.state.scene->numerical_damping;
  const int n = step.segments;
  const double known = known_part(unresolved);
  MotionSums sums;
  for (int i = 0; i <= n; ++i) {
    const ColumnVector acceleration = times(1 / step.h, step.velocities[i] - columns.velocities[i]);
    columns.positions[i] = columns.positions[i] + e.displacement[i];
    columns.velocities[i] = step.velocities[i];
    if (is_watched) {
      const ColumnVector change = acceleration - columns.accelerations[i], turn = times(known, change - columns.changes[i]);
      const double weight = e.movable[i] * before_.state.masses[i];
      const Vector3 now = values_of(turn), last = values_of(columns.turns[i]);
      sums.product += weight * now.dot(last);
      sums.square += 0.5 * weight * (now.squaredNorm() + last.squaredNorm());
      sums.mass += weight;
      columns.changes[i] = change;
      columns.turns[i] = turn;
    }
    columns.accelerations[i] = acceleration;
  }
  const bool is_smoothed = is_watched && unresolved.known > 0;
  for (int i = 0; i < n; ++i) {
    columns.multipliers[i] = e.density[i] * e.mean_length[i];
    const Column tension = bends(before_.model->material) ? columns.multipliers[i] + e.force_along[i] : columns.multipliers[i];
    columns.tensions[i] = is_smoothed ? 0.5 * (columns.last_tensions[i] + tension) : tension;
    columns.last_tensions[i] = tension;
  }
  UnresolvedMotion motion = unresolved;
  return is_watched && is_unresolved(Treatment::cleaning, sums, motion);
}

}  // namespace verlet_cable
