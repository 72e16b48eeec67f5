#include "body/hanging_places.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "verlet_cable/core/rotation.h"

namespace verlet_cable {

namespace {

using Eigen::Matrix3d;
using Eigen::VectorXd;

/// [of all that pulls] What is tight yields by one part of its length at so much tension, first to last.
constexpr std::array<double, 4> tightness{10, 1e3, 1e5, 1e7};
constexpr int hanging_iterations = 300, maximum_force_iterations = 200, halvings = 40;
constexpr double force_tolerance = 1e-13;  // of a span's length
constexpr double rest_tolerance = 1e-10;   // of the size of all
/// [of a span's weight] Links that bear less are slack.
constexpr double slack = 1e-4;
/// [rad] Bodies begin turned by this, in no special direction: a start may be an equilibrium that does not last.
constexpr double seed = 1e-6;
/// [of a body's stiffness that its weight gives it] What nothing holds in a direction stays where it is.
constexpr double least_stiffness = 1e-9;
constexpr double largest_turn = 0.3;  // [rad] in an iteration
constexpr double shift_growth = 4;
constexpr double enough = 1e-4;  // of what a step promises
constexpr double rounding_of_pull = 1e-13;

/// A chain's complementary energy at the force at its end, and its derivatives: where the end is, and how it gives way.
struct Complementary {
  double energy = 0;
  Vector3 reach = Vector3::Zero();
  Matrix3d compliance = Matrix3d::Zero();
};

Vector3 in_space(const Pose& pose, const Vector3& point) {
  return pose.position + pose.orientation * point;
}

/// Each link lies along its tension, as long as it is at rest and strained.
Complementary complementary(const HangingSpan& span, const Vector3& down, const Vector3& force, double weight, double tight,
                            double threshold) {
  Complementary sum;
  double below = weight;
  for (std::size_t i = 0; i < span.lengths.size(); ++i) {
    const double length = span.lengths[i], compliance = span.compliances[i];
    const Vector3 tension = force + below * down;
    const double size = tension.norm(), rounded = std::hypot(size, threshold);
    const bool is_tight = !(compliance > 0) || compliance * size > largest_start_strain;
    const double limit = compliance > 0 ? largest_start_strain : 0;
    const double strain = (is_tight ? limit : compliance * size) + size / tight;
    const double slope = (is_tight ? 0 : compliance) + 1 / tight;
    const double own =
        is_tight ? limit * (size - (compliance > 0 ? 0.5 * limit / compliance : 0)) : 0.5 * compliance * size * size;
    sum.energy += length * (rounded + own + 0.5 * size * size / tight);
    const double per_force = size > 0 ? strain / size : slope;
    sum.reach += length * (1 / rounded + per_force) * tension;
    const Vector3 along = size > 0 ? Vector3(tension / size) : Vector3(Vector3::Zero());
    sum.compliance += length * ((1 / rounded + per_force) * Matrix3d::Identity() +
                                (slope - per_force - size * size / (rounded * rounded * rounded)) * along * along.transpose());
    if (i < span.weights.size()) below -= span.weights[i];
  }
  return sum;
}

/// A span on its way: the force at its second end [N], and what is about it that stays.
struct Pulled {
  Vector3 force = Vector3::Zero();
  double weight = 0, length = 0, threshold = 0;
};

struct SpanEnergy {
  double energy = 0;
  Vector3 force = Vector3::Zero();  ///< [N] at the second end: the gradient
  Matrix3d stiffness = Matrix3d::Zero();
};

/// Newton's method for the force with which a chain reaches along `way`: its complementary energy less its work is convex.
SpanEnergy energy_of(const HangingSpan& span, const Vector3& down, const Vector3& way, double tight, Pulled& pulled) {
  const auto at = [&](const Vector3& force) { return complementary(span, down, force, pulled.weight, tight, pulled.threshold); };
  Complementary now = at(pulled.force);
  for (int i = 0; i < maximum_force_iterations; ++i) {
    const Vector3 miss = way - now.reach;
    if (miss.norm() < force_tolerance * pulled.length) break;
    const Vector3 change = now.compliance.ldlt().solve(miss);
    const double value = now.energy - pulled.force.dot(way), gain = miss.dot(change);
    double part = 1;
    Complementary next;
    for (int k = 0; k < halvings; ++k, part *= 0.5) {
      next = at(pulled.force + part * change);
      const double next_value = next.energy - (pulled.force + part * change).dot(way);
      if (next_value <= value - enough * part * gain + rounding_of_pull * (std::abs(value) + std::abs(next.energy))) break;
    }
    pulled.force += part * change;
    now = next;
    if (part * change.norm() <= rounding_of_pull * pulled.force.norm()) break;
  }
  return {pulled.force.dot(way) - now.energy, pulled.force, now.compliance.ldlt().solve(Matrix3d::Identity())};
}

/// A symmetric matrix of which each row is kept from its first entry on, and its Cholesky factor in the same places.
class Envelope {
 public:
  explicit Envelope(std::vector<int> first) : first_(std::move(first)), begin_(first_.size() + 1, 0) {
    for (std::size_t i = 0; i < first_.size(); ++i) begin_[i + 1] = begin_[i] + static_cast<int>(i) - first_[i] + 1;
    values_.assign(begin_.back(), 0.0);
  }
  int size() const { return static_cast<int>(first_.size()); }
  void clear() { std::fill(values_.begin(), values_.end(), 0.0); }
  /// Below the diagonal, or on it.
  double& at(int row, int column) { return values_[begin_[row] + column - first_[row]]; }
  double at(int row, int column) const { return values_[begin_[row] + column - first_[row]]; }

  /// False unless it is positive definite.
  bool factor(const Envelope& matrix, const VectorXd& shift) {
    values_ = matrix.values_;
    for (int i = 0; i < size(); ++i) {
      at(i, i) += shift[i];
      for (int j = first_[i]; j <= i; ++j) {
        double sum = at(i, j);
        for (int k = std::max(first_[i], first_[j]); k < j; ++k) sum -= at(i, k) * at(j, k);
        if (j < i) {
          at(i, j) = sum / at(j, j);
          continue;
        }
        if (!(sum > 0.5 * shift[i])) return false;
        at(i, i) = std::sqrt(sum);
      }
    }
    return true;
  }
  VectorXd solve(VectorXd x) const {
    for (int i = 0; i < size(); ++i) {
      for (int k = first_[i]; k < i; ++k) x[i] -= at(i, k) * x[k];
      x[i] /= at(i, i);
    }
    for (int i = size(); i-- > 0;) {
      x[i] /= at(i, i);
      for (int k = first_[i]; k < i; ++k) x[k] -= at(i, k) * x[i];
    }
    return x;
  }

 private:
  std::vector<int> first_, begin_;
  std::vector<double> values_;
};

class Hanging {
 public:
  Hanging(const std::vector<HangingSpan>& spans, const Vector3& down, std::vector<HangingBody>& bodies)
      : spans_(spans), down_(down), bodies_(bodies), starts_(bodies.size()), pulled_(spans.size()), matrix_({}), factor_({}) {
    order_bodies();
    measure();
  }

  void find() {
    for (const double tight : tightness) {
      tight_ = tight * pull_;
      relax();
    }
  }

 private:
  /// Neighbours after each other: what couples them is near the diagonal.
  void order_bodies() {
    std::vector<std::vector<int>> neighbours(bodies_.size());
    for (const HangingSpan& span : spans_) {
      const int a = span.ends[0].body, b = span.ends[1].body;
      if (a < 0 || b < 0 || a == b) continue;
      neighbours[a].push_back(b);
      neighbours[b].push_back(a);
    }
    std::vector<int> order;
    std::vector<char> is_ordered(bodies_.size(), 0);
    for (int from = 0; from < static_cast<int>(bodies_.size()); ++from) {
      if (is_ordered[from]) continue;
      is_ordered[from] = 1;
      order.push_back(from);
      for (std::size_t next = order.size() - 1; next < order.size(); ++next)
        for (const int other : neighbours[order[next]]) {
          if (is_ordered[other]) continue;
          is_ordered[other] = 1;
          order.push_back(other);
        }
    }
    int rows = 0;
    std::vector<int> first;
    for (const int body : order) {
      starts_[body] = rows;
      int lowest = rows;
      for (const int other : neighbours[body]) lowest = std::min(lowest, is_ordered[other] == 2 ? starts_[other] : rows);
      is_ordered[body] = 2;
      rows += unknowns(body);
      first.resize(rows, lowest);
    }
    matrix_ = factor_ = Envelope(first);
  }

  int unknowns(int body) const { return bodies_[body].turns ? 6 : 3; }

  /// Weights, sizes, and forces to begin with.
  void measure() {
    for (const HangingBody& body : bodies_) weight_ += body.weight;
    arms_.assign(bodies_.size(), 0.0);
    for (const HangingSpan& span : spans_) {
      for (const HangingEnd& end : span.ends)
        if (end.body >= 0) arms_[end.body] = std::max(arms_[end.body], (end.point - bodies_[end.body].center).norm());
      weight_ += std::accumulate(span.weights.begin(), span.weights.end(), 0.0);
    }
    for (std::size_t s = 0; s < spans_.size(); ++s) {
      Pulled& pulled = pulled_[s];
      pulled.weight = std::accumulate(spans_[s].weights.begin(), spans_[s].weights.end(), 0.0);
      pulled.length = std::accumulate(spans_[s].lengths.begin(), spans_[s].lengths.end(), 0.0);
      pulled.threshold = slack * std::abs(pulled.weight) + slack * slack * weight_;
      pulled.force = -0.5 * pulled.weight * down_ + 0.1 * pulled.weight * down_.unitOrthogonal();
      size_ = std::max(size_, pulled.length);
    }
    pull_ = weight_;
    for (std::size_t s = 0; s < spans_.size(); ++s)
      for (const HangingEnd& end : spans_[s].ends) pull_ += end.stiffness / pulled_[s].length;
    scale_.resize(matrix_.size());
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const double arm = std::max(arms_[b], least_arm * size_);
      for (int k = 0; k < unknowns(static_cast<int>(b)); ++k) scale_[starts_[b] + k] = weight_ / size_ * (k < 3 ? 1 : arm * arm);
      const double part = 1 + static_cast<double>(b);
      if (bodies_[b].turns)
        turn(seed * Vector3(std::sin(1 + 7 * part), std::sin(2 + 5 * part), std::sin(3 + 4 * part)), bodies_[b]);
    }
  }

  static void turn(const Vector3& rotation, HangingBody& body) {
    const Vector3 center = in_space(body.pose, body.center);
    const double angle = rotation.norm();
    if (angle > 0)
      body.pose.orientation = (Quaternion(Eigen::AngleAxisd(angle, rotation / angle)) * body.pose.orientation).normalized();
    body.pose.position = center - body.pose.orientation * body.center;
  }

  /// Energy [J] where the bodies are; on demand with its gradient and Hessian.
  double evaluate(bool with_slope) {
    double energy = 0;
    if (with_slope) {
      matrix_.clear();
      gradient_ = VectorXd::Zero(matrix_.size());
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      energy -= bodies_[b].weight * down_.dot(in_space(bodies_[b].pose, bodies_[b].center));
      if (with_slope) gradient_.segment<3>(starts_[b]) -= bodies_[b].weight * down_;
    }
    for (std::size_t s = 0; s < spans_.size(); ++s) energy += add_span(s, with_slope);
    return energy;
  }

  double add_span(std::size_t s, bool with_slope) {
    const HangingSpan& span = spans_[s];
    const Vector3 way = chord(span, bodies_);
    const SpanEnergy found = energy_of(span, down_, way, tight_, pulled_[s]);
    // It hangs from its first end.
    double energy = found.energy - pulled_[s].weight * down_.dot(place(span.ends[0]));
    if (with_slope) {
      add_force(span.ends[0], -found.force - pulled_[s].weight * down_);
      add_force(span.ends[1], found.force);
      for (const int row : {0, 1})
        for (const int column : {0, 1})
          couple(span.ends[row], span.ends[column], row == column ? found.stiffness : Matrix3d(-found.stiffness));
    }
    for (const int side : {0, 1}) energy += add_clamp(span, side, way, with_slope);
    return energy;
  }

  /// A clamp turns its span, and is turned by it: half its stiffness times the squared distance of the tips of the two
  /// directions.
  double add_clamp(const HangingSpan& span, int side, const Vector3& way, bool with_slope) {
    const HangingEnd& end = span.ends[side];
    const double distance = way.norm();
    if (!(end.stiffness > 0) || !(distance > 0)) return 0;
    const Vector3 chord = (side == 0 ? 1 : -1) / distance * way;
    const Vector3 axis = end.body < 0 ? end.axis : Vector3(bodies_[end.body].pose.orientation * end.axis);
    const Vector3 gap = axis - chord;
    if (with_slope) {
      // Gauss and Newton's matrix of the gap. Its rows: this end, the other, the turn.
      const Matrix3d across = (Matrix3d::Identity() - chord * chord.transpose()) / distance;
      const HangingEnd* ends[2] = {&end, &span.ends[1 - side]};
      for (const int i : {0, 1}) {
        const Matrix3d own = i == 0 ? across : Matrix3d(-across);
        add_force(*ends[i], end.stiffness * own * gap);
        for (const int j : {0, 1}) couple(*ends[i], *ends[j], (i == j ? end.stiffness : -end.stiffness) * across * across);
        if (turns(end)) couple_turn(*ends[i], end.body, end.stiffness * own * skew(axis).transpose());
      }
      if (turns(end)) {
        gradient_.segment<3>(starts_[end.body] + 3) += end.stiffness * axis.cross(gap);
        add(starts_[end.body] + 3, starts_[end.body] + 3, end.stiffness * skew(axis) * skew(axis).transpose());
      }
    }
    return 0.5 * end.stiffness * gap.squaredNorm();
  }

  static Matrix3d skew(const Vector3& v) {
    Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
  }

  bool turns(const HangingEnd& end) const { return end.body >= 0 && bodies_[end.body].turns; }
  Vector3 place(const HangingEnd& end) const { return end.body < 0 ? end.point : in_space(bodies_[end.body].pose, end.point); }
  /// From the center of its body, about which that turns.
  Vector3 arm(const HangingEnd& end) const { return bodies_[end.body].pose.orientation * (end.point - bodies_[end.body].center); }

  /// The gradient at a point, and how it turns with the body.
  void add_force(const HangingEnd& end, const Vector3& force) {
    if (end.body < 0) return;
    const int row = starts_[end.body];
    gradient_.segment<3>(row) += force;
    if (!turns(end)) return;
    const Vector3 r = arm(end);
    gradient_.segment<3>(row + 3) += r.cross(force);
    add(row + 3, row + 3, 0.5 * (force * r.transpose() + r * force.transpose()) - force.dot(r) * Matrix3d::Identity());
  }

  /// A stiffness between two points.
  void couple(const HangingEnd& first, const HangingEnd& second, const Matrix3d& stiffness) {
    if (first.body < 0 || second.body < 0) return;
    const int row = starts_[first.body], column = starts_[second.body];
    add(row, column, stiffness);
    if (turns(second)) add(row, column + 3, stiffness * skew(arm(second)).transpose());
    if (turns(first)) add(row + 3, column, skew(arm(first)) * stiffness);
    if (turns(first) && turns(second)) add(row + 3, column + 3, skew(arm(first)) * stiffness * skew(arm(second)).transpose());
  }

  /// A stiffness between a point and a body's turn, both ways.
  void couple_turn(const HangingEnd& end, int body, const Matrix3d& stiffness) {
    if (end.body < 0) return;
    const int row = starts_[end.body], column = starts_[body] + 3;
    add(row, column, stiffness);
    add(column, row, stiffness.transpose());
    if (!turns(end)) return;
    const Matrix3d turned = skew(arm(end)) * stiffness;
    add(row + 3, column, turned);
    add(column, row + 3, turned.transpose());
  }

  /// Of a matrix that is symmetric in all, what is below the diagonal.
  void add(int row, int column, const Matrix3d& block) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (row + i >= column + j) matrix_.at(row + i, column + j) += block(i, j);
  }

  void relax() {
    double shift = least_stiffness;
    double energy = evaluate(true);
    for (int i = 0; i < hanging_iterations; ++i) {
      shift = std::max(shift / shift_growth, least_stiffness);
      while (std::isfinite(shift) && !factor_.factor(matrix_, shift * scale_)) shift *= shift_growth;
      if (!std::isfinite(shift)) return;  // sizes beyond what numbers can tell apart
      VectorXd step = -factor_.solve(gradient_);
      double turns = 0, moves = 0;
      for (std::size_t b = 0; b < bodies_.size(); ++b) {
        moves = std::max(moves, step.segment<3>(starts_[b]).norm());
        if (bodies_[b].turns) turns = std::max(turns, step.segment<3>(starts_[b] + 3).norm());
      }
      if (turns > largest_turn) step *= largest_turn / turns;
      const double slope = gradient_.dot(step);
      const std::vector<HangingBody> before = bodies_;
      double part = 1, next = energy;
      for (int k = 0; k < halvings; ++k, part *= 0.5) {
        bodies_ = before;
        move(part * step);
        next = evaluate(false);
        if (next <= energy + enough * part * slope + rounding_of_pull * pull_ * size_) break;
      }
      if (part < 1) shift *= shift_growth * shift_growth;
      energy = evaluate(true);
      if (part == 1 && moves < rest_tolerance * size_ && turns < rest_tolerance) return;
    }
  }

  void move(const VectorXd& step) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      bodies_[b].pose.position += step.segment<3>(starts_[b]);
      if (bodies_[b].turns) turn(step.segment<3>(starts_[b] + 3), bodies_[b]);
    }
  }

  /// [of the size of all] Bodies turn as if they had an arm of this.
  static constexpr double least_arm = 1e-3;

  const std::vector<HangingSpan>& spans_;
  Vector3 down_;
  std::vector<HangingBody>& bodies_;
  std::vector<int> starts_;   ///< of each body's unknowns: three of its place, three of its turn
  std::vector<double> arms_;  ///< [m] one a body: of what holds it
  std::vector<Pulled> pulled_;
  double weight_ = 0, size_ = 0, tight_ = 0;
  double pull_ = 0;  ///< [N] weights, and with which clamps turn spans
  VectorXd scale_, gradient_;
  Envelope matrix_, factor_;
};

}  // namespace

Vector3 chord(const HangingSpan& span, const std::vector<HangingBody>& bodies) {
  const auto place = [&](const HangingEnd& end) { return end.body < 0 ? end.point : in_space(bodies[end.body].pose, end.point); };
  return place(span.ends[1]) - place(span.ends[0]);
}

void find_hanging_places(const std::vector<HangingSpan>& spans, const Vector3& down, std::vector<HangingBody>& bodies) {
  if (!bodies.empty() && !spans.empty()) Hanging(spans, down, bodies).find();
}

}  // namespace verlet_cable
