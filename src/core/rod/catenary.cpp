#include "rod/catenary.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace verlet_cable {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr int catenary_iterations = 200;
constexpr int halvings = 60;
constexpr double straight = 1 - 1e-12;        // of the length: from there on a line
constexpr double position_tolerance = 1e-14;  // of the length

/// Of the length: what is less is rounding.
constexpr double close_enough = 1e-12;

/// A chain in the vertical plane through its ends: sideways towards its end, upwards. Its length and its weight are 1.
struct Chain {
  std::vector<double> lengths;
  std::vector<double> weights;  ///< of the nodes before a link, all together
  std::vector<double> axial_stiffness;
  double mean_stiffness = 0;  ///< of all links one after the other
  int strut = -1;             ///< the link that is compressed, -1: none is

  int links() const { return static_cast<int>(lengths.size()); }
  double sign(int link) const { return link == strut ? -1 : 1; }
  Vector2d force(const Vector2d& first, int link) const { return first + Vector2d(0, weights[link]); }
  Vector2d reach(const Vector2d& first, int link) const {
    const Vector2d f = force(first, link);
    const double size = f.norm();
    return lengths[link] * ((size > 0 ? sign(link) / size : 0) + 1 / axial_stiffness[link]) * f;
  }
};

/// The chain's end as a function of the force in its first link: the gradient of the complementary energy.
struct ChainEnd {
  Vector2d position = Vector2d::Zero();
  Matrix2d slope = Matrix2d::Zero();
};

ChainEnd chain_end(const Chain& chain, const Vector2d& first) {
  ChainEnd end;
  for (int i = 0; i < chain.links(); ++i) {
    const double length = chain.lengths[i], elastic = length / chain.axial_stiffness[i];
    const Vector2d force = chain.force(first, i);
    const double size = std::max(force.norm(), std::numeric_limits<double>::min());
    const Vector2d across(-force.y() / size, force.x() / size);
    end.position += chain.reach(first, i);
    end.slope += chain.sign(i) * length / size * across * across.transpose() + elastic * Matrix2d::Identity();
  }
  return end;
}

/// Newton's method. Without a strut the force is where the complementary energy less the work at the ends, which is convex, is
/// least: steps that go far beyond the least along their line are shortened. With one, steps after which the end misses by more.
void solve(const Chain& chain, const Vector2d& span, Vector2d& force) {
  constexpr double beyond = 0.1, before = 0.5;  // of the slope at the start of a step
  ChainEnd end = chain_end(chain, force);
  for (int iteration = 0; iteration < catenary_iterations; ++iteration) {
    const Vector2d miss = span - end.position;
    if (miss.norm() < position_tolerance) return;
    const Vector2d change = end.slope.fullPivLu().solve(miss);
    const double slope = miss.dot(change);
    ChainEnd next;
    double low = 0, high = 1, part = 1;
    for (int i = 0; i < halvings; ++i, part = 0.5 * (low + high)) {
      next = chain_end(chain, force + part * change);
      const Vector2d next_miss = span - next.position;
      const double next_slope = next_miss.dot(change);
      const bool is_far = chain.strut < 0 ? next_slope < -beyond * slope : !(next_miss.norm() < miss.norm());
      if (is_far)
        high = part;
      else if (chain.strut < 0 && part < 1 && next_slope > before * slope)
        low = part;
      else
        break;
    }
    force += part * change;
    end = next;
  }
}

/// What link `slack` would have to reach if it bore nothing and all others hung straight down from the chain's ends.
Vector2d left_for(const Chain& chain, int slack, const Vector2d& span) {
  Vector2d left = span;
  for (int i = 0; i < chain.links(); ++i) {
    if (i != slack) left.y() -= i < slack ? -chain.lengths[i] : chain.lengths[i];
    left.y() -= chain.lengths[i] * (chain.weights[i] - chain.weights[slack]) / chain.axial_stiffness[i];
  }
  return left;
}

/// Links bear compression, too: one that would be slack keeps its length as a strut, which spreads those beside it. The first
/// guess of the force in it is that of small deflections, where the others give way by `sideways` and `upwards` [of the force].
Vector2d strut_force(const Chain& chain, const Vector2d& left) {
  const int strut = chain.strut;
  const double length = chain.lengths[strut], own = length / chain.axial_stiffness[strut];
  double sideways = own, upwards = own;
  for (int i = 0; i < chain.links(); ++i) {
    if (i == strut) continue;
    sideways += chain.lengths[i] * (1 / std::abs(chain.weights[i] - chain.weights[strut]) + 1 / chain.axial_stiffness[i]);
    upwards += chain.lengths[i] / chain.axial_stiffness[i];
  }
  const double most = length / sideways;
  double low = 0, high = most;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    const Vector2d direction(left.x() / (length - sideways * middle), left.y() / (length - upwards * middle));
    (direction.norm() < 1 ? low : high) = middle;
  }
  const double size = low, up = std::clamp(left.y() / (length - upwards * size), -1.0, 1.0);
  return -size * Vector2d(std::sqrt(1 - up * up), up);
}

/// The force in the first link of a chain whose ends are above each other and that has no slack link: it hangs from both ends, or
/// from one, along a line.
Vector2d force_on_line(const Chain& chain, double rise) {
  double total = std::accumulate(chain.lengths.begin(), chain.lengths.end(), 0.0);
  double reach = 0, best_miss = std::numeric_limits<double>::infinity(), best = 0;
  for (int i = 0; i < chain.links(); ++i) reach += chain.lengths[i] * (1 + chain.weights[i] / chain.axial_stiffness[i]);
  // The first k links go down, the others up.
  for (int k = 0; k <= chain.links(); ++k) {
    if (k > 0) reach -= 2 * chain.lengths[k - 1];
    const double low = k < chain.links() ? -chain.weights[k] : -std::numeric_limits<double>::infinity();
    const double high = k > 0 ? -chain.weights[k - 1] : std::numeric_limits<double>::infinity();
    const double middle = k == 0 ? low + 1 : k == chain.links() ? high - 1 : 0.5 * (low + high);
    const double wanted =
        chain.mean_stiffness < std::numeric_limits<double>::infinity() ? (rise - reach) * chain.mean_stiffness / total : middle;
    const double force = std::clamp(wanted, std::min(low + close_enough, middle), std::max(high - close_enough, middle));
    const double miss = std::abs(reach + total * force / chain.mean_stiffness - rise);
    if (miss >= best_miss) continue;
    best_miss = miss;
    best = force;
  }
  return {0, best};
}

double miss(const Chain& chain, const Vector2d& force, const Vector2d& span) {
  return (span - chain_end(chain, force).position).norm();
}

/// The force in a chain's strut. Short chains bend far: other guesses where the first finds nothing.
Vector2d solve_strut(const Chain& chain, const Vector2d& left, const Vector2d& span) {
  const Vector2d guess = strut_force(chain, left);
  Vector2d best = guess;
  solve(chain, span, best);
  for (const double size : {1.0, 0.5, 2.0, 0.25, 4.0})
    for (const double turn : {0.0, 0.3, -0.3, 0.8, -0.8}) {
      if (miss(chain, best, span) < close_enough) return best;
      Vector2d force = Eigen::Rotation2Dd(turn) * (size * guess);
      solve(chain, span, force);
      if (miss(chain, force, span) < miss(chain, best, span)) best = force;
    }
  return best;
}

/// The force in the first link, `weights` being changed to be those from the link on that bears least: its force is not rounded.
Vector2d first_force(Chain& chain, const Vector2d& span) {
  int slackest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < chain.links(); ++i) {
    const double spare = left_for(chain, i, span).norm() - chain.lengths[i];
    if (spare >= least) continue;
    slackest = i;
    least = spare;
  }
  const double length = chain.lengths[slackest];
  const Vector2d left = left_for(chain, slackest, span);
  const double before = chain.weights[slackest];
  for (double& weight : chain.weights) weight -= before;
  if (least < -close_enough * length) {
    chain.strut = slackest;
    return solve_strut(chain, left, span);
  }
  if (span.x() == 0) return force_on_line(chain, span.y());
  Vector2d force = least < length ? Vector2d(std::max(least, close_enough * length) * left.normalized()) : Vector2d(0.1, -0.5);
  solve(chain, span, force);
  return force;
}

/// [N] Of links one after the other.
double mean_stiffness(const std::vector<double>& lengths, const std::vector<double>& axial_stiffness) {
  const double first = axial_stiffness.front();
  if (std::all_of(axial_stiffness.begin(), axial_stiffness.end(), [first](double other) { return other == first; })) return first;
  double length = 0, compliance = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    length += lengths[i];
    compliance += lengths[i] / axial_stiffness[i];
  }
  return length / compliance;
}

}  // namespace

std::vector<Vector3> hanging_chain(const Vector3& from, const Vector3& to, const std::vector<double>& lengths,
                                   const std::vector<double>& weights, const Vector3& down,
                                   const std::vector<double>& axial_stiffness) {
  const double length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  const double weight = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (lengths.size() == 1) return {from, to};
  // Added up from zero: far from the origin each sum would round.
  std::vector<Vector3> nodes{Vector3::Zero()};
  const Vector3 span = to - from;
  const bool is_rigid = std::none_of(axial_stiffness.begin(), axial_stiffness.end(),
                                     [](double stiffness) { return stiffness < std::numeric_limits<double>::infinity(); });
  if (span.norm() >= straight * length && is_rigid) {
    double along = 0;
    for (const double l : lengths) nodes.push_back((along += l) / length * span);
    for (Vector3& node : nodes) node += from;
    return nodes;
  }
  const Vector3 level = span - span.dot(down) * down;
  const bool is_upright = level.norm() < position_tolerance * length;
  const Vector3 side = is_upright ? Vector3(down.unitOrthogonal()) : Vector3(level.normalized());

  Chain chain;
  chain.mean_stiffness = mean_stiffness(lengths, axial_stiffness) / weight;
  double above = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    chain.lengths.push_back(lengths[i] / length);
    chain.axial_stiffness.push_back(axial_stiffness[axial_stiffness.size() == 1 ? 0 : i] / weight);
    chain.weights.push_back(above / weight);
    if (i < weights.size()) above += weights[i];
  }
  const Vector2d force = first_force(chain, Vector2d(is_upright ? 0 : level.norm(), -span.dot(down)) / length);
  for (int i = 0; i < chain.links(); ++i) {
    const Vector2d reach = length * chain.reach(force, i);
    nodes.push_back(nodes.back() + reach.x() * side - reach.y() * down);
  }
  for (Vector3& node : nodes) node += from;
  return nodes;
}

}  // namespace verlet_cable
