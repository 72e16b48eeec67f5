#include "confidence.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable::cable_fit {
namespace {

/// Whole recordings are the parts where there are so many; fewer are cut.
constexpr int fewest_parts = 8;
/// Quantile 0.975 of Student's distribution, by degrees of freedom from 1.
constexpr double student[] = {12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                              2.201, 2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086};
constexpr double normal_quantile = 1.960;
/// Where the interval reaches from a third to three times the value, the value says little.
constexpr double widest_logarithmic = 0.5;
constexpr double near_limit = 0.02;  // decades

double student_quantile(int degrees) {
  return degrees <= static_cast<int>(std::size(student)) ? student[degrees - 1] : normal_quantile;
}

}  // namespace

std::vector<Confidence> confidence(const Problem& problem, const std::vector<double>& values) {
  std::vector<int> all(problem.recordings.size());
  std::iota(all.begin(), all.end(), 0);
  const Linearization linearization = linearize(problem, all, values, true);
  const Prior prior(problem.parameters, values);
  const auto count = static_cast<Eigen::Index>(values.size());
  Eigen::MatrixXd information = prior.slopes.transpose() * prior.slopes;
  // The prior is one more thing known, as uncertain as it says.
  Eigen::MatrixXd scatter = information;
  const int recordings = static_cast<int>(all.size());
  const int parts = (fewest_parts + recordings - 1) / recordings;
  for (const RecordingDifferences& recording : linearization) {
    information += recording.slopes.transpose() * recording.slopes;
    for (int part = 0; part < parts; ++part) {
      const Eigen::Index first = recording.values.size() * part / parts, last = recording.values.size() * (part + 1) / parts;
      const Eigen::VectorXd gradient =
          recording.slopes.middleRows(first, last - first).transpose() * recording.values.segment(first, last - first);
      scatter += gradient * gradient.transpose() * parts * recordings / (parts * recordings - 1.0);
    }
  }
  // Parameters differ in scale by orders of magnitude.
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd inverse =
      scale.asDiagonal() *
      (scale.asDiagonal() * information * scale.asDiagonal()).completeOrthogonalDecomposition().pseudoInverse() *
      scale.asDiagonal();
  const Eigen::MatrixXd covariance = inverse * scatter * inverse;
  const double quantile = student_quantile(parts * recordings - 1);
  std::vector<Confidence> result;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Parameter& parameter = problem.parameters[i];
    Confidence& confidence = result.emplace_back();
    confidence.half_width = information(i, i) > 0 ? quantile * std::sqrt(std::max(covariance(i, i), 0.0)) : infinity;
    confidence.told = parameter.logarithmic
                          ? confidence.half_width < widest_logarithmic && values[i] > parameter.lowest + near_limit &&
                                values[i] < parameter.highest - near_limit
                      : parameter.likely > 0 ? confidence.half_width < std::max(parameter.likely, std::abs(values[i]))
                                             : confidence.half_width < infinity;
  }
  return result;
}

}  // namespace verlet_cable::cable_fit
