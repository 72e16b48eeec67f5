#include "input_errors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace verlet_cable::cable_fit {
namespace {

constexpr Eigen::Index beyond = 3;  ///< coefficients of cubic splines more than they have intervals
/// [s] Hands move no faster than splines of such intervals. In long recordings they are fewer: the time that the fit takes grows
/// with the square of their number.
constexpr double shortest_interval = 0.1;
constexpr double most_intervals = 60;
/// [s] A start's velocity is as uncertain as noise over this time makes it: the rows after it are for the model to explain.
constexpr double start_time = 0.02;
constexpr double marker_unit = 0.001;  // [m]
constexpr double roll_unit = 0.02;     // [rad]
/// How far the roll of hands may be from that of the smallest rotation, and how long [s] it takes them to change it.
constexpr double likely_roll = 0.2, roll_time = 0.5;

/// Cubic B-splines over so many equal intervals: a row, a coefficient.
Eigen::MatrixXd cubic_splines(const std::vector<double>& times, Eigen::Index intervals) {
  const auto rows = static_cast<Eigen::Index>(times.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows, intervals + beyond);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double place = (times[row] - times.front()) / (times.back() - times.front()) * static_cast<double>(intervals);
    const Eigen::Index interval = std::min(static_cast<Eigen::Index>(place), intervals - 1);
    const double s = place - static_cast<double>(interval), r = 1 - s;
    result.block<1, 4>(row, interval) << r * r * r / 6, (4 - 6 * s * s + 3 * s * s * s) / 6, (4 - 6 * r * r + 3 * r * r * r) / 6,
        s * s * s / 6;
  }
  return result;
}

/// The markers on the hands.
std::array<int, 4> held_markers(const Recording& recording) {
  const int last = recording.marker_count() - 1;
  return {0, 1, last - 1, last};
}

/// The same end, rolled about its x axis.
FrameTrack rolled(const FrameTrack& track, const Eigen::VectorXd& angles) {
  FrameTrack result;
  for (std::size_t row = 0; row < track.times().size(); ++row) {
    const Pose& pose = track.poses()[row];
    const Eigen::AngleAxisd roll(angles[static_cast<Eigen::Index>(row)], Vector3::UnitX());
    result.add(track.times()[row], {pose.position, pose.orientation * Quaternion(roll)});
  }
  return result;
}

HeldEnds held_ends(const Markers& markers, const Input& input) {
  const HeldEnds ends = held_ends(markers, input.recording);
  return {rolled(ends.start, input.rolls[0]), rolled(ends.end, input.rolls[1])};
}

/// The first row that each coefficient of splines changes.
std::vector<int> first_rows(const Eigen::MatrixXd& splines) {
  std::vector<int> rows(static_cast<std::size_t>(splines.cols()), 0);
  for (Eigen::Index k = 0; k < splines.cols(); ++k)
    while (splines(rows[k], k) == 0) ++rows[k];
  return rows;
}

}  // namespace

Prediction predict(const SceneDesc& cable, const Markers& markers, const Input& input) {
  return predict(cable, markers, input.recording, held_ends(markers, input), true);
}

Waypoints predict_by(std::vector<int> rows, const SceneDesc& cable, const Markers& markers, const Input& input) {
  return predict_by(std::move(rows), cable, markers, input.recording, held_ends(markers, input), true);
}

Prediction predict_on(const Waypoints& waypoints, std::size_t which, const SceneDesc& cable, const Markers& markers,
                      const Input& input) {
  return predict_on(waypoints, which, cable, markers, input.recording, held_ends(markers, input));
}

InputErrors::InputErrors(const Recording& recording, const Smoothed& input, double variance) : input_(input.recording) {
  const auto rows = static_cast<Eigen::Index>(recording.rows());
  const auto splines = [&](double intervals) {
    const double most =
        std::min({most_intervals, recording.times.back() / shortest_interval, static_cast<double>(rows - beyond)});
    return cubic_splines(recording.times, static_cast<Eigen::Index>(std::ceil(std::clamp(intervals, 1.0, std::max(most, 1.0)))));
  };
  splines_ = splines(degrees_of_freedom(rows, input.strength));
  roll_splines_ = splines(recording.times.back() / roll_time);
  const Eigen::MatrixXd rough = third_differences(recording.times) * splines_;
  const Eigen::MatrixXd of_coordinate = splines_.transpose() * splines_ + input.strength * rough.transpose() * rough;
  const Eigen::Index coefficients = splines_.cols(), held = 12 * coefficients;
  const Eigen::Index started = 6 * static_cast<Eigen::Index>(recording.marker_count() - 4);
  const Eigen::Index rolls = 2 * roll_splines_.cols();
  const double of_noise = marker_unit * marker_unit / variance, of_roll = roll_unit * roll_unit / (likely_roll * likely_roll);
  precision_ = Eigen::MatrixXd::Zero(held + started + rolls, held + started + rolls);
  for (Eigen::Index i = 0; i < held; i += coefficients)
    precision_.block(i, i, coefficients, coefficients) = of_noise * of_coordinate;
  precision_.diagonal().segment(held, started).setConstant(of_noise);
  precision_.diagonal().tail(rolls).setConstant(of_roll);
  const auto add_rows = [&](const Eigen::MatrixXd& of) {
    const std::vector<int> rows_of = first_rows(of);
    first_rows_.insert(first_rows_.end(), rows_of.begin(), rows_of.end());
  };
  for (Eigen::Index i = 0; i < held; i += coefficients) add_rows(splines_);
  first_rows_.resize(static_cast<std::size_t>(held + started), 0);
  for (int end = 0; end < 2; ++end) add_rows(roll_splines_);
}

Input InputErrors::changed(const Eigen::VectorXd& errors) const {
  Input result{input_, {}};
  Recording& recording = result.recording;
  Eigen::Index next = 0;
  for (const int marker : held_markers(input_))
    for (int axis = 0; axis < 3; ++axis, next += splines_.cols()) {
      const Eigen::VectorXd change = marker_unit * splines_ * errors.segment(next, splines_.cols());
      for (int row = 0; row < recording.rows(); ++row) recording.markers[row][marker][axis] += change[row];
    }
  const double share = recording.times[1] / start_time;
  for (int marker = 2; marker + 2 < recording.marker_count(); ++marker, next += 6) {
    recording.markers[0][marker] += marker_unit * errors.segment<3>(next);
    recording.markers[1][marker] += marker_unit * (errors.segment<3>(next) + share * errors.segment<3>(next + 3));
  }
  for (Eigen::VectorXd& roll : result.rolls) {
    roll = roll_unit * roll_splines_ * errors.segment(next, roll_splines_.cols());
    next += roll_splines_.cols();
  }
  return result;
}

}  // namespace verlet_cable::cable_fit
