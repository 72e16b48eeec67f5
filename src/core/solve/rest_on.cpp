#include <algorithm>
#include <array>
#include <cmath>

#include "solve/resting_shape.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// Of the cable's weight, a unit of strain: stiffness of segments, in turns; the stiffer, the less an iteration can turn them.
constexpr std::array<double, 3> relative_stiffnesses{1e2, 1e3, 1e4};
/// Of a radius: what is pressed by the cable's weight yields by so much.
constexpr double relative_yield = 0.1;
/// [s] Of the inertia that bounds an iteration's way: at first, at most, and by how much it changes as iterations go well or not.
constexpr double first_step = 0.1, shortest_step = 1e-4, longest_step = 100, growth = 4, shrinkage = 0.5;
constexpr int most_iterations = 150;
constexpr int most_rounds = 6;  // in which an iteration finds what it comes to touch
/// Of a segment's weight: a load that is none, at last and until segments are as stiff as they get.
constexpr double last_tolerance = 1e-3, first_tolerance = 0.1;
constexpr double largest_turn = 1;  // [rad] of a segment in an iteration
constexpr double sufficient_decrease = 1e-4;
constexpr int most_halvings = 30;
/// Relative, of energies that are compared, and of the cable's weight times a metre.
constexpr double energy_rounding = 1e-13;

/// Symmetric and positive definite, of node places. Nodes are coupled with the next but one.
class Band {
 public:
  void reset(int nodes) {
    size_ = 3 * nodes;
    values_.assign(static_cast<std::size_t>(size_) * width, 0.0);
  }
  void add(int i, int j, double value) { values_[static_cast<std::size_t>(std::min(i, j)) * width + std::abs(i - j)] += value; }
  void add_block(int node, int other, const Eigen::Matrix3d& block) {
    for (int row = 0; row < 3; ++row)
      for (int column = node == other ? row : 0; column < 3; ++column)
        add(3 * node + row, 3 * other + column, block(row, column));
  }
  /// A node that stays where it is.
  void hold(int node) {
    for (int j = 3 * node; j < 3 * node + 3; ++j) {
      for (int s = 0; s < width; ++s) {
        values_[static_cast<std::size_t>(j) * width + s] = s == 0 ? 1 : 0;
        if (s > 0 && j - s >= 0) values_[static_cast<std::size_t>(j - s) * width + s] = 0;
      }
    }
  }
  void factor() {
    for (int j = 0; j < size_; ++j) {
      double* row = &values_[static_cast<std::size_t>(j) * width];
      const double inverse = 1 / row[0];
      const int end = std::min(width, size_ - j);
      for (int s = 1; s < end; ++s) {
        const double factor = row[s] * inverse;
        double* other = &values_[static_cast<std::size_t>(j + s) * width];
        for (int t = s; t < end; ++t) other[t - s] -= factor * row[t];
      }
      for (int s = 1; s < end; ++s) row[s] *= inverse;
    }
  }
  /// After `factor`.
  void solve(std::vector<Vector3>& x) const {
    const auto at = [&x](int j) -> double& { return x[j / 3][j % 3]; };
    for (int j = 0; j < size_; ++j)
      for (int s = 1; s < std::min(width, size_ - j); ++s) at(j + s) -= values_[static_cast<std::size_t>(j) * width + s] * at(j);
    for (int j = size_; j-- > 0;) {
      const double* row = &values_[static_cast<std::size_t>(j) * width];
      double value = at(j) / row[0];
      for (int s = 1; s < std::min(width, size_ - j); ++s) value -= row[s] * at(j + s);
      at(j) = value;
    }
  }

 private:
  static constexpr int width = 9;  // of a row, from the diagonal on
  int size_ = 0;
  std::vector<double> values_;
};

class Rest {
 public:
  Rest(const SimulatedCable& cable, const Boundary& boundary, const Vector3& gravity, const Surroundings& surroundings,
       std::vector<Vector3>& positions)
      : n_(cable.state.segments()),
        masses_(cable.state.masses),
        lengths_(cable.state.rest_lengths),
        gravity_(gravity),
        surroundings_(surroundings),
        x_(positions),
        joints_(n_ + 1, 0.0),
        held_(n_ + 1, 0),
        gradient_(n_ + 1),
        way_(n_ + 1) {
    for (const HeldNode& held : boundary.nodes) {
      held_[held.node] = 1;
      x_[held.node] = held.position;
    }
    // On a wheel, or between nodes that a clamp holds, a segment is as long as its place.
    for (int i = 0; i < n_; ++i)
      if (held_[i] != 0 && held_[i + 1] != 0) lengths_[i] = (x_[i + 1] - x_[i]).norm();
    const CableMaterials materials(cable);
    const auto bending = [](const MaterialDesc& material) { return material.bending_stiffness.largest(); };
    for (int i = 1; i < n_; ++i) {
      const double length = cable.state.bending_length(i, 0.5 * (lengths_[i - 1] + lengths_[i]));
      joints_[i] = materials.mean_at(i, bending) / length;
    }
    for (const HeldDirection& held : boundary.directions) {
      joints_[held.node] = 0;
      const Vector3 axis = held.end * Vector3::UnitX();
      for (const int i : {held.node - 1, held.node})
        if (i >= 0 && i < n_)
          clamps_.push_back({i, axis, bending(materials[i]) / cable.state.bending_length(held.node, 0.5 * lengths_[i])});
    }
    double mass = 0;
    for (const double m : masses_) mass += m;
    weight_ = mass * gravity.norm();
    const double radius = materials.smallest([](const MaterialDesc& material) { return material.radius; });
    surface_stiffness_ = weight_ / (relative_yield * radius);
  }

  bool find() {
    for (const double relative : relative_stiffnesses) {
      stiffness_ = relative * weight_;
      if (!descend((relative < relative_stiffnesses.back() ? first_tolerance : last_tolerance) * weight_ / n_)) return false;
    }
    return true;
  }

 private:
  struct Clamp {
    int segment = 0;
    Vector3 axis = Vector3::UnitX();
    double stiffness = 0;  ///< [N m]
  };
  /// A place of the cable and a surface: energy of the gap where that is closed, linear in the iteration's way.
  struct Pressed {
    int segment = 0;
    Clearance at;
    bool closed = true;
  };

  /// False if there is no way on, true if it got there or as near as its iterations lead.
  bool descend(double tolerance) {
    double h = first_step, from = energy();
    for (int i = 0; i < most_iterations; ++i) {
      find_gradient();
      if (largest_load() < tolerance) return true;
      find_way(h);
      double slope = 0, turn = 0, part = 1;
      for (int k = 0; k <= n_; ++k) slope += gradient_[k].dot(way_[k]);
      for (int k = 0; k < n_; ++k) turn = std::max(turn, (way_[k + 1] - way_[k]).norm() / lengths_[k]);
      if (!(slope < 0)) return false;
      part = std::min(part, largest_turn / turn);
      for (int k = 0; k < n_; ++k)
        part = std::min(part, surroundings_.free_part(k, x_[k], x_[k + 1], part * way_[k], part * way_[k + 1]) * part);
      const std::vector<Vector3> start = x_;
      if (!(part > 0) && h <= shortest_step) return false;
      const bool whole = part == 1;
      int halvings = 0;
      for (; halvings < most_halvings; ++halvings, part *= 0.5) {
        for (int k = 0; k <= n_; ++k) x_[k] = start[k] + part * way_[k];
        const double to = energy();
        if (to <= from + sufficient_decrease * part * slope + energy_rounding * (std::abs(from) + weight_)) {
          from = to;
          break;
        }
      }
      if (halvings == most_halvings) {
        x_ = start;
        return false;
      }
      h = whole && halvings == 0 ? std::min(growth * h, longest_step) : std::max(shrinkage * h, shortest_step);
    }
    return true;
  }

  Vector3 curvature(int joint) const {
    return (x_[joint + 1] - x_[joint]) / lengths_[joint] - (x_[joint] - x_[joint - 1]) / lengths_[joint - 1];
  }

  template <class F>
  void touch(const std::vector<Vector3>& places, const F& f) const {
    for (int i = 0; i <= n_; ++i)
      surroundings_.touch_node(i, places[i], [&](Clearance c) {
        c.fraction = i < n_ ? 0 : 1;
        f(2 * i, std::min(i, n_ - 1), c);
      });
    for (int i = 0; i < n_; ++i)
      surroundings_.touch_segment(i, places[i], places[i + 1], [&](const Clearance& c) { f(2 * i + 1, i, c); });
  }

  /// Bending is quadratic in places, where segments are as long as they are (Bergou et al., A quadratic bending model, 2006).
  double energy() const {
    double sum = 0;
    for (int i = 0; i <= n_; ++i) sum -= masses_[i] * gravity_.dot(x_[i]);
    for (int i = 0; i < n_; ++i) {
      const double longer = (x_[i + 1] - x_[i]).norm() - lengths_[i];
      sum += 0.5 * stiffness_ / lengths_[i] * longer * longer;
      if (joints_[i] > 0) sum += 0.5 * joints_[i] * curvature(i).squaredNorm();
    }
    for (const Clamp& c : clamps_)
      sum += 0.5 * c.stiffness * ((x_[c.segment + 1] - x_[c.segment]) / lengths_[c.segment] - c.axis).squaredNorm();
    touch(x_, [&](int, int, const Clearance& c) { sum += 0.5 * surface_stiffness_ * c.gap * c.gap; });
    return sum;
  }

  void find_gradient() {
    for (int i = 0; i <= n_; ++i) gradient_[i] = -masses_[i] * gravity_;
    for (int i = 0; i < n_; ++i) {
      const Vector3 segment = x_[i + 1] - x_[i];
      const Vector3 pull = stiffness_ * (1 / lengths_[i] - 1 / segment.norm()) * segment;
      gradient_[i] -= pull;
      gradient_[i + 1] += pull;
      if (!(joints_[i] > 0)) continue;
      const Vector3 moment = joints_[i] * curvature(i);
      gradient_[i - 1] += moment / lengths_[i - 1];
      gradient_[i] -= moment * (1 / lengths_[i - 1] + 1 / lengths_[i]);
      gradient_[i + 1] += moment / lengths_[i];
    }
    for (const Clamp& c : clamps_) {
      const double length = lengths_[c.segment];
      const Vector3 moment = c.stiffness / length * ((x_[c.segment + 1] - x_[c.segment]) / length - c.axis);
      gradient_[c.segment] -= moment;
      gradient_[c.segment + 1] += moment;
    }
    pressed_.clear();
    is_pressed_.assign((2 * n_ + 1) * surroundings_.size(), 0);
    touch(x_, [&](int place, int segment, const Clearance& c) {
      is_pressed_[place * surroundings_.size() + c.solid] = 1;
      pressed_.push_back({segment, c, true});
      press(pressed_.back(), surface_stiffness_ * c.gap, gradient_);
    });
    for (int i = 0; i <= n_; ++i)
      if (held_[i] != 0) gradient_[i].setZero();
  }

  static void press(const Pressed& pressed, double force, std::vector<Vector3>& forces) {
    forces[pressed.segment] += (1 - pressed.at.fraction) * force * pressed.at.normal;
    forces[pressed.segment + 1] += pressed.at.fraction * force * pressed.at.normal;
  }

  double largest_load() const {
    double largest = 0;
    for (const Vector3& load : gradient_) largest = std::max(largest, load.norm());
    return largest;
  }

  /// To the minimum of a convex model of the energy: geometric stiffness of what is compressed left out, surfaces that are
  /// touched or come to be, flat.
  void find_way(double h) {
    assemble(h);
    bool changed = true;
    for (int round = 0; round < most_rounds && changed; ++round) {
      band_ = smooth_;
      for (int i = 0; i <= n_; ++i) way_[i] = -gradient_[i];
      for (const Pressed& p : pressed_) {
        const bool touched = p.at.gap < 0;
        if (touched && !p.closed) press(p, surface_stiffness_ * p.at.gap, way_);
        if (!touched && p.closed) press(p, -surface_stiffness_ * p.at.gap, way_);
        if (!p.closed) continue;
        const std::array<double, 2> part{1 - p.at.fraction, p.at.fraction};
        for (int a = 0; a < 2; ++a)
          for (int b = a; b < 2; ++b)
            if (part[a] * part[b] != 0)
              band_.add_block(p.segment + a, p.segment + b,
                              surface_stiffness_ * part[a] * part[b] * p.at.normal * p.at.normal.transpose());
      }
      for (int i = 0; i <= n_; ++i) {
        if (held_[i] == 0) continue;
        band_.hold(i);
        way_[i].setZero();
      }
      band_.factor();
      band_.solve(way_);
      changed = meet_surfaces();
    }
  }

  /// What the way closes or opens. Whether that is other than what it was found with.
  bool meet_surfaces() {
    bool changed = false;
    for (Pressed& p : pressed_) {
      const bool closed = p.at.gap + closing(p) < 0;
      changed = changed || closed != p.closed;
      p.closed = closed;
    }
    places_.resize(n_ + 1);
    for (int i = 0; i <= n_; ++i) places_[i] = x_[i] + way_[i];
    touch(places_, [&](int place, int segment, const Clearance& c) {
      char& known = is_pressed_[place * surroundings_.size() + c.solid];
      if (known != 0) return;
      known = 1;
      Pressed pressed{segment, c, true};
      pressed.at.gap = std::max(0.0, c.gap - closing(pressed));
      pressed_.push_back(pressed);
      changed = true;
    });
    return changed;
  }

  double closing(const Pressed& p) const {
    return p.at.normal.dot((1 - p.at.fraction) * way_[p.segment] + p.at.fraction * way_[p.segment + 1]);
  }

  void assemble(double h) {
    smooth_.reset(n_ + 1);
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    for (int i = 0; i <= n_; ++i) smooth_.add_block(i, i, masses_[i] / (h * h) * one);
    for (int i = 0; i < n_; ++i) {
      const Vector3 segment = x_[i + 1] - x_[i];
      const Vector3 d = segment.normalized();
      const double across = stiffness_ * std::max(0.0, 1 / lengths_[i] - 1 / segment.norm());
      add_pair(i, across * one + (stiffness_ / lengths_[i] - across) * d * d.transpose());
      if (!(joints_[i] > 0)) continue;
      const std::array<double, 3> part{1 / lengths_[i - 1], -1 / lengths_[i - 1] - 1 / lengths_[i], 1 / lengths_[i]};
      for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b) smooth_.add_block(i - 1 + a, i - 1 + b, joints_[i] * part[a] * part[b] * one);
    }
    for (const Clamp& c : clamps_) add_pair(c.segment, c.stiffness / (lengths_[c.segment] * lengths_[c.segment]) * one);
  }

  void add_pair(int i, const Eigen::Matrix3d& block) {
    smooth_.add_block(i, i, block);
    smooth_.add_block(i + 1, i + 1, block);
    smooth_.add_block(i, i + 1, -block);
  }

  int n_;
  const std::vector<double>& masses_;  // [kg] nodes
  std::vector<double> lengths_;        // [m] segments
  Vector3 gravity_;
  const Surroundings& surroundings_;
  std::vector<Vector3>& x_;        // [m] nodes
  std::vector<double> joints_;     // [N m] nodes: bending stiffness over the length that bends
  std::vector<char> held_;         // nodes
  std::vector<Vector3> gradient_;  // [N] nodes
  std::vector<Vector3> way_;       // [m] nodes
  std::vector<Vector3> places_;    // [m] nodes
  std::vector<Clamp> clamps_;
  std::vector<Pressed> pressed_;
  std::vector<char> is_pressed_;  // nodes and segments in turns, by surfaces
  Band smooth_, band_;
  double weight_ = 0, stiffness_ = 0;  // [N]
  double surface_stiffness_ = 0;       // [N/m]
};

}  // namespace

bool rest_on(const SimulatedCable& cable, const Boundary& boundary, const Vector3& gravity, const Surroundings& surroundings,
             std::vector<Vector3>& positions) {
  return Rest(cable, boundary, gravity, surroundings, positions).find();
}

}  // namespace verlet_cable
