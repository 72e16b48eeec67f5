#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

/// A discrete elastic rod (Bergou et al. 2008, 2010) of its own, to make recordings that the package's simulation has not made:
/// it shares no code with it, is stepped explicitly, and stretches (a little). Straight, isotropic, with rotary inertia about its
/// axis.
namespace explicit_rod {

struct Vector {
  double x = 0, y = 0, z = 0;
};
inline Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector operator*(double s, const Vector& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline double dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct Material {
  double linear_density = 0.1;          ///< [kg/m]
  double bending_stiffness = 2e-3;      ///< [N m^2]
  double bending_damping = 2e-5;        ///< [N m^2 s]
  double drag = 0.05;                   ///< [kg/(m s)]
  double torsional_stiffness = 1.5e-3;  ///< [N m^2]
};

constexpr double length = 1.0;         // [m] between the outer markers
constexpr double gravity = 9.81;       // [m/s^2], along -z
constexpr double held = 0.025;         // [m] in a hand, at each end
constexpr double stretching = 2e3;     // [N] axial stiffness: at some N the cable is longer by a thousandth
constexpr double axis_inertia = 2e-6;  // [kg m] about the rod's axis
constexpr double twist_time = 3e-3;    // [s] torsional damping over torsional stiffness

/// Where a hand holds the rod: its origin at the outer marker, its first axis along the rod, from start to end.
struct Hand {
  Vector position, along, across;
};

/// Hands that swing, each coordinate as a sum of two sines. `pace`: 1 is about 1 Hz.
class Motion {
 public:
  Motion(unsigned seed, double pace) {
    std::mt19937_64 random(seed);
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
    };
    for (auto& hand : sines_)
      for (std::size_t i = 0; i < hand.size(); ++i)
        for (Sine& sine : hand[i])
          sine = {i < 3 ? uniform(0.02, 0.06) : uniform(0.05, 0.2), 2 * M_PI * pace * uniform(0.5, 1.7), uniform(0, 2 * M_PI)};
    distance_ = uniform(0.6, 0.75);
  }

  /// `end`: 0 or 1. The hands come from where a straight rod has its ends, and rest until time 0.
  Hand at(int end, double time) const {
    const double come = smooth((time + coming + resting) / coming), swung = warmed_up(time);
    std::array<double, 5> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
      for (const Sine& sine : sines_[end][i]) values[i] += sine.size * std::sin(sine.pace * swung + sine.phase);
    const double side = end == 0 ? 1 : -1;
    const Vector straight{end == 0 ? 0 : length, 0, 0};
    const Vector there{(end == 0 ? 0 : distance_) + values[0], values[1], values[2]};
    const double pitch = come * (0.5 * side + values[3]), yaw = come * values[4];
    return {straight + come * (there - straight),
            {std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), -std::sin(pitch)},
            {-std::sin(yaw), std::cos(yaw), 0}};
  }
  /// [s] before time 0, one after the other
  static constexpr double coming = 1.0, resting = 0.6;

 private:
  struct Sine {
    double size, pace, phase;
  };
  static double smooth(double s) {
    s = std::min(std::max(s, 0.0), 1.0);
    return s * s * s * (10 - 15 * s + 6 * s * s);
  }
  /// [s] how far the motion has come: it begins gently.
  static double warmed_up(double time) {
    constexpr double gently = 0.5;
    return time < 0 ? 0 : time < gently ? time * time / (2 * gently) : time - gently / 2;
  }
  std::array<std::array<std::array<Sine, 2>, 5>, 2> sines_;
  double distance_;
};

class Rod {
 public:
  Rod(const Material& material, const Motion& motion, int segments)
      : material_(material), motion_(motion), n_(segments), l_(length / segments), held_(static_cast<int>(held / l_ + 0.5)) {
    for (int i = 0; i <= n_; ++i) position_.push_back({i * l_, 0, 0});
    velocity_.resize(n_ + 1);
    tangent_.assign(n_, {1, 0, 0});
    across_.assign(n_, {0, 1, 0});
    spin_.resize(n_);
    force_.resize(n_);
    torque_.resize(n_);
    strain_.resize(n_ + 1);
    // Of damping, the highest mode decides; bending, stretching and twisting waves allow longer steps.
    const double highest = 16 / (l_ * l_ * l_ * l_);
    step_ = 0.8 / (material.bending_damping / material.linear_density * highest +
                   std::sqrt(material.bending_stiffness / material.linear_density * highest) +
                   2 / l_ * std::sqrt(stretching / material.linear_density));
  }

  /// The rod at a time: it is stepped until there. Until time 0 it moves as in honey.
  void advance(double time) {
    while (time_ < time) step();
  }
  double time() const { return time_; }
  double step_length() const { return step_; }
  Vector point(double along) const {
    const int i = std::min(static_cast<int>(along / l_), n_ - 1);
    const double f = along / l_ - i;
    return (1 - f) * position_[i] + f * position_[i + 1];
  }

 private:
  struct Strain {
    double first = 0, second = 0, twist = 0;
  };

  void step() {
    const double drag = time_ < 0 ? 1.0 : material_.drag;
    std::fill(force_.begin(), force_.end(), Vector{});
    std::fill(torque_.begin(), torque_.end(), 0.0);
    for (int i = held_; i < n_ - held_; ++i) {
      const Vector edge = position_[i + 1] - position_[i];
      force_[i] = stretching * (std::sqrt(dot(edge, edge)) / l_ - 1) * tangent_[i];
    }
    for (int i = held_; i <= n_ - held_; ++i) bend_and_twist(i);
    const double mass = material_.linear_density * l_;
    for (int i = held_ + 1; i < n_ - held_; ++i) {
      const Vector force = (force_[i] - force_[i - 1]) + (-drag * l_) * velocity_[i] + Vector{0, 0, -gravity * mass};
      velocity_[i] = velocity_[i] + (step_ / mass) * force;
      position_[i] = position_[i] + step_ * velocity_[i];
    }
    for (int i = held_; i < n_ - held_; ++i) spin_[i] += step_ / (axis_inertia * l_) * torque_[i];
    time_ += step_;
    hold();
    for (int i = held_; i < n_ - held_; ++i) turn(i);
    started_ = true;
  }

  /// The moments at a node, as gradients by the edges beside it; where a hand ends, the node has half a segment that bends.
  void bend_and_twist(int i) {
    const double share = i == held_ || i == n_ - held_ ? 0.5 * l_ : l_;
    const Vector &t = tangent_[i - 1], &u = tangent_[i], &a = across_[i - 1], &b = across_[i];
    const Vector a2 = cross(t, a), b2 = cross(u, b);
    const double chi = 1 + dot(t, u);
    const Vector bend = (2 / chi) * cross(t, u), middle = (1 / chi) * (t + u);
    const Vector one = (1 / chi) * (a + b), two = (1 / chi) * (a2 + b2);
    Strain now;
    now.first = 0.5 * chi * dot(bend, two);
    now.second = -0.5 * chi * dot(bend, one);
    const Vector carried = a - (dot(a, u) / chi) * (t + u);
    const double sine = dot(cross(carried, b), u);
    now.twist = sine * (1 + sine * sine / 6);
    const Strain before = started_ ? strain_[i] : now;
    strain_[i] = now;
    const double stiffness = material_.bending_stiffness / share, damping = material_.bending_damping / (share * step_);
    const double first = stiffness * now.first + damping * (now.first - before.first);
    const double second = stiffness * now.second + damping * (now.second - before.second);
    const double twist = material_.torsional_stiffness / share * (now.twist + twist_time / step_ * (now.twist - before.twist));
    const double inverse = 1 / l_;
    const Vector along = (first * now.first + second * now.second) * middle;
    const Vector across = first * two - second * one;
    force_[i - 1] = force_[i - 1] + inverse * (cross(u, across) - along + (0.5 * twist) * bend);
    force_[i] = force_[i] + inverse * (cross(across, t) - along + (0.5 * twist) * bend);
    torque_[i - 1] += 0.5 * (first * dot(bend, a) + second * dot(bend, a2)) + twist;
    torque_[i] += 0.5 * (first * dot(bend, b) + second * dot(bend, b2)) - twist;
  }

  void hold() {
    const Hand start = motion_.at(0, time_), end = motion_.at(1, time_);
    for (int k = 0; k <= held_; ++k) {
      position_[k] = start.position + (k * l_) * start.along;
      position_[n_ - k] = end.position - (k * l_) * end.along;
      if (k == held_) break;
      tangent_[k] = start.along;
      across_[k] = start.across;
      tangent_[n_ - 1 - k] = end.along;
      across_[n_ - 1 - k] = end.across;
    }
  }

  /// The material of a free edge: along with it, by the smallest rotation, and about it as it spins.
  void turn(int i) {
    const Vector edge = position_[i + 1] - position_[i], before = tangent_[i];
    const Vector now = (1 / std::sqrt(dot(edge, edge))) * edge;
    Vector across = across_[i] - (dot(across_[i], now) / (1 + dot(before, now))) * (before + now);
    across = across + (step_ * spin_[i]) * cross(now, across);
    across_[i] = (1.5 - 0.5 * dot(across, across)) * across;
    tangent_[i] = now;
  }

  Material material_;
  const Motion& motion_;
  int n_;
  double l_;
  int held_;
  double step_, time_ = -Motion::coming - Motion::resting;
  bool started_ = false;
  std::vector<Vector> position_, velocity_, tangent_, across_, force_;
  std::vector<double> spin_, torque_;
  std::vector<Strain> strain_;
};

/// [m] along the rod: two markers on each hand, and those between.
constexpr double marker_places[] = {0, held, 0.12, 0.22, 0.32, 0.41, 0.5, 0.59, 0.68, 0.78, 0.88, length - held, length};

/// Rows at 100 Hz, from `begin` [s] after the hands began to move; without noise.
inline std::vector<std::vector<Vector>> record(const Material& material, const Motion& motion, double duration, int segments = 80,
                                               double begin = 0.7) {
  Rod rod(material, motion, segments);
  std::vector<std::vector<Vector>> rows;
  for (int row = 0; row <= static_cast<int>(std::lround(100 * duration)); ++row) {
    rod.advance(begin + 0.01 * row);
    std::vector<Vector>& markers = rows.emplace_back();
    for (const double place : marker_places) markers.push_back(rod.point(place));
  }
  return rows;
}

}  // namespace explicit_rod
