#include "smoothing.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace verlet_cable::cable_fit {
namespace {

constexpr int order = 3;  ///< of the differences: what accelerates evenly is not changed
constexpr double weakest = 0.1, strongest = 1e8, factor = 3;

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Row by coordinate of some markers.
Eigen::MatrixXd coordinates(const Recording& recording, const std::vector<int>& markers) {
  Eigen::MatrixXd values(recording.rows(), 3 * static_cast<Eigen::Index>(markers.size()));
  for (int row = 0; row < recording.rows(); ++row)
    for (std::size_t i = 0; i < markers.size(); ++i)
      values.block<1, 3>(row, 3 * static_cast<Eigen::Index>(i)) = recording.markers[row][markers[i]].transpose();
  return values;
}

/// Smooths some markers; the variance of their noise [m^2] and how strongly they were smoothed.
std::pair<double, double> smooth_alike(const std::vector<int>& markers, Recording& recording) {
  const Eigen::MatrixXd measured = coordinates(recording, markers);
  const SparseMatrix difference = third_differences(recording.times);
  const SparseMatrix penalty = difference.transpose() * difference;
  SparseMatrix identity(measured.rows(), measured.rows());
  identity.setIdentity();
  Eigen::MatrixXd best;
  double least = -1, variance = 0, best_strength = 0;
  for (double strength = weakest; strength <= strongest; strength *= factor) {
    const Eigen::SimplicialLDLT<SparseMatrix> solver(SparseMatrix(identity + strength * penalty));
    const Eigen::MatrixXd smooth = solver.solve(measured);
    const double residual = (measured - smooth).squaredNorm() / static_cast<double>(measured.size());
    const double removed = 1 - degrees_of_freedom(measured.rows(), strength) / static_cast<double>(measured.rows());
    const double score = residual / (removed * removed);
    if (least >= 0 && score >= least) continue;
    least = score;
    variance = residual / removed;
    best = smooth;
    best_strength = strength;
  }
  for (int row = 0; row < recording.rows(); ++row)
    for (std::size_t i = 0; i < markers.size(); ++i)
      recording.markers[row][markers[i]] = best.block<1, 3>(row, 3 * static_cast<Eigen::Index>(i)).transpose();
  return {variance, best_strength};
}

}  // namespace

SparseMatrix third_differences(const std::vector<double>& times) {
  const auto rows = static_cast<Eigen::Index>(times.size());
  const double mean = (times.back() - times.front()) / static_cast<double>(rows - 1);
  SparseMatrix result(rows, rows);
  result.setIdentity();
  for (int k = 1; k <= order; ++k) {
    SparseMatrix next(rows - k, rows - k + 1);
    for (Eigen::Index i = 0; i < next.rows(); ++i) {
      const double weight = k * mean / (times[i + k] - times[i]);
      next.insert(i, i) = -weight;
      next.insert(i, i + 1) = weight;
    }
    result = SparseMatrix(next * result);
  }
  return result;
}

double degrees_of_freedom(Eigen::Index rows, double strength) {
  double sum = 0;  // over eigenvalues as of even times
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double half = std::sin(0.5 * M_PI * static_cast<double>(i) / static_cast<double>(rows));
    sum += 1 / (1 + strength * std::pow(2 * half, 2 * order));
  }
  return sum;
}

Smoothed smoothed(const Recording& recording) {
  const int count = recording.marker_count();
  std::vector<int> on_hands, between;
  for (int marker = 0; marker < count; ++marker)
    (std::min(marker, count - 1 - marker) < 2 ? on_hands : between).push_back(marker);
  Smoothed result{recording, 0, 0};
  const auto [variance, strength] = smooth_alike(on_hands, result.recording);
  const double of_others = between.empty() ? variance : smooth_alike(between, result.recording).first;
  const double share = static_cast<double>(on_hands.size()) / count;
  result.noise = std::sqrt(share * variance + (1 - share) * of_others);
  result.strength = strength;
  return result;
}

}  // namespace verlet_cable::cable_fit
