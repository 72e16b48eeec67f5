#include "smoothing.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cmath>
#include <vector>

namespace verlet_cable::cable_fit {
namespace {

constexpr int order = 3;  ///< of the differences: what accelerates evenly is not changed
constexpr double weakest = 0.1, strongest = 1e8, factor = 3;

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Row by coordinate.
Eigen::MatrixXd coordinates(const Recording& recording) {
  Eigen::MatrixXd values(recording.rows(), 3 * recording.marker_count());
  for (int row = 0; row < recording.rows(); ++row)
    for (int marker = 0; marker < recording.marker_count(); ++marker)
      values.block<1, 3>(row, 3 * marker) = recording.markers[row][marker].transpose();
  return values;
}

/// Divided differences, times such a power of the mean interval that they are plain differences where times are even.
SparseMatrix differences(const std::vector<double>& times) {
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

/// How many of the data's degrees of freedom are left, of so many rows: eigenvalues as of even times.
double degrees_of_freedom(Eigen::Index rows, double strength) {
  double sum = 0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double half = std::sin(0.5 * M_PI * static_cast<double>(i) / static_cast<double>(rows));
    sum += 1 / (1 + strength * std::pow(2 * half, 2 * order));
  }
  return sum;
}

}  // namespace

Smoothed smoothed(const Recording& recording) {
  const Eigen::MatrixXd measured = coordinates(recording);
  const SparseMatrix difference = differences(recording.times);
  const SparseMatrix penalty = difference.transpose() * difference;
  SparseMatrix identity(measured.rows(), measured.rows());
  identity.setIdentity();
  Eigen::MatrixXd best;
  double least = -1, noise = 0;
  for (double strength = weakest; strength <= strongest; strength *= factor) {
    const Eigen::SimplicialLDLT<SparseMatrix> solver(SparseMatrix(identity + strength * penalty));
    const Eigen::MatrixXd smooth = solver.solve(measured);
    const double residual = (measured - smooth).squaredNorm() / static_cast<double>(measured.size());
    const double removed = 1 - degrees_of_freedom(measured.rows(), strength) / static_cast<double>(measured.rows());
    const double score = residual / (removed * removed);
    if (least >= 0 && score >= least) continue;
    least = score;
    noise = std::sqrt(residual / removed);
    best = smooth;
  }
  Smoothed result{recording, noise};
  for (int row = 0; row < recording.rows(); ++row)
    for (int marker = 0; marker < recording.marker_count(); ++marker)
      result.recording.markers[row][marker] = best.block<1, 3>(row, 3 * marker).transpose();
  return result;
}

}  // namespace verlet_cable::cable_fit
