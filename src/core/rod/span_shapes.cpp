#include "rod/span_shapes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "rod/initial_shape.h"
#include "rod/rod_frames.h"

namespace verlet_cable {
namespace {

/// Of a span's length: one that is no longer than its ends are apart, or hardly, is straight; the bow that is left then is 1 %.
constexpr double nearly_straight = 3e-4;
/// Of a span's length: no shape is known of what bows less, and none of what would have to bow so many times as far.
constexpr double least_bow = 1e-3, most_deepened = 4;
/// Of a segment's length: what elastic cables are strained by.
constexpr double length_tolerance = 1e-7;
constexpr int rounds = 100, halvings = 60;
/// Of a span's length: rounding of the places of its ends.
constexpr double unmoved = 1e-9;

std::vector<double> along_of(const std::vector<double>& lengths) {
  std::vector<double> along{0};
  for (const double length : lengths) along.push_back(along.back() + length);
  return along;
}

std::vector<double> lengths_of(const std::vector<Vector3>& points) {
  std::vector<double> lengths;
  for (std::size_t i = 1; i < points.size(); ++i) lengths.push_back((points[i] - points[i - 1]).norm());
  return lengths;
}

/// Of a polyline, at increasing distances along it [m]; beyond its end straight on.
std::vector<Vector3> sampled(const std::vector<Vector3>& points, const std::vector<double>& distances) {
  const std::vector<double> along = along_of(lengths_of(points));
  std::vector<Vector3> samples;
  std::size_t k = 0;
  for (const double distance : distances) {
    while (k + 2 < along.size() && along[k + 1] < distance) ++k;
    const double length = along[k + 1] - along[k];
    samples.push_back(length > 0 ? Vector3(points[k] + (distance - along[k]) / length * (points[k + 1] - points[k])) : points[k]);
  }
  return samples;
}

double length_of(const std::vector<Vector3>& line, const std::vector<Vector3>& bows, double factor) {
  double length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1] + factor * (bows[i] - bows[i - 1])).norm();
  return length;
}

/// [m] Of segments with these lengths at rest, strained as others were: each as it was where they are the same ones.
std::vector<double> strained(std::vector<double> rest_lengths, const std::vector<double>& before,
                             const std::vector<Vector3>& points) {
  const std::vector<double> drawn = lengths_of(points);
  if (rest_lengths == before) return drawn;
  const double strain = along_of(drawn).back() / along_of(before).back();
  for (double& length : rest_lengths) length *= strain;
  return rest_lengths;
}

/// Between two places, with the lengths of its segments [m], as a polyline goes; none where that does not say how.
std::optional<std::vector<Vector3>> shape_between(const Vector3& from, const Vector3& to, std::vector<Vector3> points,
                                                  const std::vector<double>& lengths) {
  std::vector<double> along = along_of(lengths);
  const double whole = along.back();
  std::vector<Vector3> line;
  for (const double s : along) line.push_back(from + s / whole * (to - from));
  if ((to - from).norm() >= (1 - nearly_straight) * whole) return line;
  // The ends' ways, in proportion to the length between them.
  const std::vector<double> before = along_of(lengths_of(points));
  if (!(before.back() > 0)) return std::nullopt;
  const Vector3 first = from - points.front(), last = to - points.back();
  for (std::size_t i = 0; i < points.size(); ++i) points[i] += first + before[i] / before.back() * (last - first);
  for (int round = 0; round < rounds; ++round) {
    const std::vector<double> of_points = lengths_of(points);
    const double drawn = std::accumulate(of_points.begin(), of_points.end(), 0.0);
    if (!(drawn > 0)) return std::nullopt;
    std::vector<double> distances;
    for (const double s : along) distances.push_back(s / whole * drawn);
    points = sampled(points, distances);
    std::vector<Vector3> bows;
    double widest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      bows.push_back(i == 0 || i + 1 == points.size() ? Vector3(Vector3::Zero()) : Vector3(points[i] - line[i]));
      widest = std::max(widest, bows.back().norm());
    }
    if (!(widest > least_bow * whole)) return std::nullopt;
    // The length is a convex function of the factor, and least where that is 0.
    double low = 0, high = most_deepened;
    if (length_of(line, bows, high) < whole) return std::nullopt;
    for (int i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (low + high);
      (length_of(line, bows, middle) < whole ? low : high) = middle;
    }
    double error = 0;
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = line[i] + high * bows[i];
    for (std::size_t i = 0; i < lengths.size(); ++i)
      error = std::max(error, std::abs((points[i + 1] - points[i]).norm() / lengths[i] - 1));
    if (error < length_tolerance) break;
  }
  return points;
}

/// From where it is held on, along a polyline that begins there.
std::vector<Vector3> free_end(const Vector3& from, const std::vector<Vector3>& points, const std::vector<double>& lengths) {
  const std::vector<Vector3> places = sampled(points, along_of(lengths));
  std::vector<Vector3> nodes{from};
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const Vector3 way = places[i + 1] - places[i];
    nodes.push_back(nodes.back() + lengths[i] * (way.norm() > 0 ? Vector3(way.normalized()) : Vector3(Vector3::UnitX())));
  }
  return nodes;
}

}  // namespace

void lay_straight(const std::vector<HeldNode>& held, CableState& state) {
  const std::vector<Vector3> before = state.positions;
  for (std::size_t k = 0; k <= held.size(); ++k) {
    const bool is_head = k == 0, is_tail = k == held.size();
    const int first = is_head ? 0 : held[k - 1].node, last = is_tail ? state.segments() : held[k].node;
    if (first == last) continue;
    Vector3 from = is_head ? before[first] : held[k - 1].position, to = is_tail ? before[last] : held[k].position;
    const double length = state.length(first, last);
    if (is_head) from = to - length * (before[last] - before[last - 1]).normalized();
    if (is_tail) to = from + length * (before[first + 1] - before[first]).normalized();
    double along = 0;
    for (int i = first; i <= last; ++i) {
      state.positions[i] = from + along / length * (to - from);
      if (i < last) along += state.rest_lengths[i];
    }
  }
  carry_frames(before, state);
}

SpanShapes::SpanShapes(const std::vector<HeldNode>& held, const CableState& state) {
  int first = 0;
  const auto add = [&](int last) {
    spans_.push_back({{state.positions.begin() + first, state.positions.begin() + last + 1},
                      {state.rest_lengths.begin() + first, state.rest_lengths.begin() + last}});
    first = last;
  };
  for (const HeldNode& h : held) add(h.node);
  add(state.segments());
}

void SpanShapes::apply(const CableModel& model, const std::vector<HeldNode>& held, const Vector3& gravity,
                       CableState& state) const {
  const std::vector<Vector3> before = state.positions;
  std::optional<CableState> hanging;
  for (std::size_t k = 0; k < spans_.size(); ++k) {
    const Span& span = spans_[k];
    const bool is_head = k == 0, is_tail = k == held.size();
    const int first = is_head ? 0 : held[k - 1].node, last = is_tail ? state.segments() : held[k].node;
    if (first == last) continue;
    const Vector3 &from = is_head ? span.points.front() : held[k - 1].position,
                  &to = is_tail ? span.points.back() : held[k].position;
    const std::vector<double> rest_lengths(state.rest_lengths.begin() + first, state.rest_lengths.begin() + last);
    std::vector<double> lengths = strained(rest_lengths, span.rest_lengths, span.points);
    const double moved = (from - span.points.front()).norm() + (to - span.points.back()).norm();
    const auto place = state.positions.begin() + first;
    if (rest_lengths == span.rest_lengths && moved <= unmoved * along_of(lengths).back()) {
      std::copy(span.points.begin(), span.points.end(), place);
      *place = from;
      state.positions[last] = to;
    } else if (!is_head && !is_tail && last == first + 1) {  // on a wheel, or as straight as it can be
      *place = from;
      *(place + 1) = to;
    } else if (is_tail) {
      const std::vector<Vector3> nodes = free_end(from, span.points, lengths);
      std::copy(nodes.begin(), nodes.end(), place);
    } else if (is_head) {
      std::reverse(lengths.begin(), lengths.end());
      const std::vector<Vector3> nodes = free_end(to, {span.points.rbegin(), span.points.rend()}, lengths);
      std::copy(nodes.rbegin(), nodes.rend(), place);
    } else if (const auto nodes = shape_between(from, to, span.points, lengths)) {
      std::copy(nodes->begin(), nodes->end(), place);
    } else {
      if (!hanging) hang_anew(model, held, gravity, hanging.emplace(state));
      std::copy(hanging->positions.begin() + first, hanging->positions.begin() + last + 1, place);
    }
  }
  carry_frames(before, state);
}

}  // namespace verlet_cable
