#include "publish/ring_choice.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace verlet_cable {
namespace {

constexpr double color_tolerance = 0.025;  // of a channel
/// Of a straight line's length, by which it may be off at most: in sharp bends, where that is less than the tolerance, one line
/// turns against the next by a quarter of a radian. Less than the smallest part of the tolerance cannot be seen.
constexpr double steepest = 1.0 / 40, smallest_part = 0.3;
/// Of the rings of `spread_rings`: those that straight stretches get, too, for their colors.
constexpr double even_share = 0.1;

/// By how much the color at `part` of the way from one ring to the next is not the one wanted there: the worst channel.
double color_error(const std_msgs::ColorRGBA& from, const std_msgs::ColorRGBA& to, float part,
                   const std_msgs::ColorRGBA& wanted) {
  const auto error = [&](float a, float b, float c) { return std::abs(a + part * (b - a) - c); };
  return std::max({error(from.r, to.r, wanted.r), error(from.g, to.g, wanted.g), error(from.b, to.b, wanted.b),
                   error(from.a, to.a, wanted.a)});
}

/// Whether rings at the nodes `first` and `last` are enough for those between.
bool are_enough(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors, double tolerance, int first,
                int last) {
  const Vector3 along = centers[last] - centers[first];
  const double squared_length = along.squaredNorm();
  const double allowed = std::clamp(steepest * std::sqrt(squared_length), smallest_part * tolerance, tolerance);
  for (int node = first + 1; node < last; ++node) {
    const Vector3 offset = centers[node] - centers[first];
    const double part = squared_length > 0 ? std::clamp(offset.dot(along) / squared_length, 0.0, 1.0) : 0;
    if ((offset - part * along).squaredNorm() > allowed * allowed) return false;
    if (color_error(colors[first], colors[last], static_cast<float>(part), colors[node]) > color_tolerance) return false;
  }
  return true;
}

/// Per segment, the integral of the square root of the curvature, of which rings at distances for which straight lines are
/// equally far off have equal shares.
std::vector<double> bends(const std::vector<Vector3>& centers) {
  const std::size_t segments = centers.size() - 1;
  std::vector<double> lengths(segments), bends(segments, 0);
  for (std::size_t i = 0; i < segments; ++i) lengths[i] = (centers[i + 1] - centers[i]).norm();
  for (std::size_t i = 1; i < segments; ++i) {
    if (lengths[i - 1] == 0 || lengths[i] == 0) continue;
    const double turn = ((centers[i + 1] - centers[i]) / lengths[i] - (centers[i] - centers[i - 1]) / lengths[i - 1]).norm();
    const double root = std::sqrt(2 * turn / (lengths[i - 1] + lengths[i]));
    bends[i - 1] += root * lengths[i - 1] / 2;
    bends[i] += root * lengths[i] / 2;
  }
  return bends;
}

}  // namespace

std::vector<int> choose_rings(const std::vector<Vector3>& centers, const std::vector<std_msgs::ColorRGBA>& colors,
                              double tolerance, int most) {
  const auto enough = [&](int first, int last) { return are_enough(centers, colors, tolerance, first, last); };
  std::vector<int> rings{0}, next{static_cast<int>(centers.size()) - 1};  // those behind the last of `rings`, the nearest last
  while (!next.empty()) {
    const int first = rings.back(), last = next.back(), nodes = last - first;
    if (static_cast<int>(rings.size() + next.size()) > most) return {};
    const int half = first + nodes / 2, third = first + nodes / 3, two_thirds = first + 2 * nodes / 3;
    if (enough(first, last)) {
      rings.push_back(last);
      next.pop_back();
    } else if (enough(first, third) && enough(third, two_thirds) && enough(two_thirds, last) &&
               !(enough(first, half) && enough(half, last))) {
      next.insert(next.end(), {two_thirds, third});
    } else {
      next.push_back(half);
    }
  }
  return rings;
}

std::vector<double> spread_rings(const std::vector<Vector3>& centers, int count) {
  std::vector<double> sums = bends(centers);  // up to the end of each segment
  double all = 0;
  for (const double bend : sums) all += bend;
  const double even = all > 0 ? even_share / (1 - even_share) * all / static_cast<double>(sums.size()) : 1;
  double sum = 0;
  for (double& s : sums) s = sum += s + even;

  std::vector<double> places{0};
  std::size_t segment = 0;
  for (int ring = 1; ring + 1 < count; ++ring) {
    const double wanted = sum * ring / (count - 1);
    while (segment + 1 < sums.size() && sums[segment] < wanted) ++segment;
    const double before = segment == 0 ? 0 : sums[segment - 1];
    places.push_back(static_cast<double>(segment) + std::min((wanted - before) / (sums[segment] - before), 1.0));
  }
  places.push_back(static_cast<double>(sums.size()));
  return places;
}

}  // namespace verlet_cable
