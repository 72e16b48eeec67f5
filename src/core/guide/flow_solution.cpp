// How CableStepper solves for flows through guides together with the cable: the flows' rows and columns are eliminated last.
#include <algorithm>
#include <cmath>
#include <utility>

#include "rod/cable_stepper.h"

namespace verlet_cable {

namespace {

/// Of the length of a segment: no flow takes so much that less is left.
constexpr double least_left = 0.02;

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

}  // namespace

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

}  // namespace verlet_cable
