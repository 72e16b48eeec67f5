#include "confidence.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>

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
/// Of many numbers that are likely zero, one in twenty has an interval without it, and what a model leaves unexplained bends
/// cables, too: only those count that are this many times further away.
constexpr double far_from_zero = 4;
constexpr double near_limit = 0.02;  // decades

double student_quantile(int degrees) {
  return degrees <= static_cast<int>(std::size(student)) ? student[degrees - 1] : normal_quantile;
}

int parts_of_each(int recordings) {
  return (fewest_parts + recordings - 1) / recordings;
}

}  // namespace

Eigen::VectorXd scale_of(const Eigen::MatrixXd& information) {
  return information.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
}

Eigen::MatrixXd inverse_scaled(const Eigen::MatrixXd& information, const Eigen::VectorXd& scale) {
  return (scale.asDiagonal() * information * scale.asDiagonal()).completeOrthogonalDecomposition().pseudoInverse();
}

void add_scatter(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& differences, int recordings, Eigen::MatrixXd& scatter) {
  const int parts = parts_of_each(recordings);
  for (int part = 0; part < parts; ++part) {
    const Eigen::Index first = differences.size() * part / parts, last = differences.size() * (part + 1) / parts;
    const Eigen::VectorXd gradient =
        slopes.middleRows(first, last - first).transpose() * differences.segment(first, last - first);
    scatter += gradient * gradient.transpose() * parts * recordings / (parts * recordings - 1.0);
  }
}

std::vector<Confidence> confidence_of(const std::vector<Parameter>& parameters, const std::vector<double>& values,
                                      const Eigen::MatrixXd& by_noise, const Eigen::MatrixXd& by_scatter, int recordings) {
  const double quantile_of_parts = student_quantile(parts_of_each(recordings) * recordings - 1);
  std::vector<Confidence> result;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& parameter = parameters[i];
    const auto k = static_cast<Eigen::Index>(i);
    const auto half = [&](const Eigen::MatrixXd& covariance, double quantile) {
      return quantile * std::sqrt(std::max(covariance(k, k), 0.0));
    };
    Confidence& confidence = result.emplace_back();
    const double random = std::max(half(by_noise, normal_quantile), half(by_scatter, quantile_of_parts));
    confidence.half_width = random > 0 ? std::hypot(random, normal_quantile * parameter.unresolved) : infinity;
    confidence.told = parameter.logarithmic
                          ? confidence.half_width < widest_logarithmic && values[i] > parameter.lowest + near_limit &&
                                values[i] < parameter.highest - near_limit
                      : parameter.likely > 0 ? std::abs(values[i]) > far_from_zero * confidence.half_width
                                             : confidence.half_width < infinity;
  }
  return result;
}

std::vector<Confidence> confidence_by_scatter(const Problem& problem, const std::vector<int>& all,
                                              const std::vector<double>& values) {
  const Prior prior(problem.parameters, values);
  Eigen::MatrixXd information = prior.slopes.transpose() * prior.slopes;
  // The prior is one more thing known, as uncertain as it says.
  Eigen::MatrixXd scatter = information;
  const int count = static_cast<int>(all.size());
  for (const RecordingDifferences& recording : linearize(problem, all, values, true)) {
    information += recording.slopes.transpose() * recording.slopes;
    add_scatter(recording.slopes, recording.values, count, scatter);
  }
  const Eigen::VectorXd scale = scale_of(information);
  const Eigen::MatrixXd inverse = scale.asDiagonal() * inverse_scaled(information, scale) * scale.asDiagonal();
  const Eigen::MatrixXd covariance = inverse * scatter * inverse;
  return confidence_of(problem.parameters, values, Eigen::MatrixXd::Zero(covariance.rows(), covariance.cols()), covariance,
                       count);
}

}  // namespace verlet_cable::cable_fit
