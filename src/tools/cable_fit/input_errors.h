#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "prediction.h"
#include "smoothing.h"

namespace verlet_cable::cable_fit {

/// What a prediction starts from and what holds its cable.
struct Input {
  Recording recording;
  std::array<Eigen::VectorXd, 2> rolls;  ///< [rad] of the hands, a row: more than they are taken to have
};

/// The prediction of a recording by such an input, which starts along a smooth curve.
Prediction predict(const SceneDesc& cable, const Markers& markers, const Input& input);
Waypoints predict_by(std::vector<int> rows, const SceneDesc& cable, const Markers& markers, const Input& input);
Prediction predict_on(const Waypoints& waypoints, std::size_t which, const SceneDesc& cable, const Markers& markers,
                      const Input& input);

/// By how much a prediction's input may be off: numbers, each of which changes it by about as much as derivatives are taken over.
/// They are the markers on the hands, as cubic splines over time that are about as fine as what smoothing lets through; where the
/// other markers start and how fast; and the roll of the hands, which no marker shows.
class InputErrors {
 public:
  /// `variance` [m^2]: of the noise of a coordinate.
  InputErrors(const Recording& recording, const Smoothed& input, double variance);

  Eigen::Index count() const { return precision_.rows(); }
  /// The first row whose input one of them changes.
  int first_row(Eigen::Index which) const { return first_rows_[static_cast<std::size_t>(which)]; }
  /// So many of them, the last ones, are the roll of the hands.
  Eigen::Index roll_count() const { return 2 * roll_splines_.cols(); }
  /// The input, changed.
  Input changed(const Eigen::VectorXd& errors) const;
  /// What is known of them without a model: the inverse of their covariance.
  const Eigen::MatrixXd& precision() const { return precision_; }

 private:
  Recording input_;
  Eigen::MatrixXd splines_, roll_splines_;  // a row, a coefficient
  Eigen::MatrixXd precision_;
  std::vector<int> first_rows_;  // a number
};

}  // namespace verlet_cable::cable_fit
