#include "rod/bow.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// A half wave is shown by at least so many segments.
constexpr int segments_of_half_wave = 4;
/// Of a guess, until a bow is found.
constexpr double growth = 1.02, largest_growth = 4;
constexpr int bisections = 60;

/// Deflection of a mode of buckling of about so many half waves, at a part of the span, its ends clamped or hinged.
class Mode {
 public:
  Mode(const StraightSpan& span, double waves) : first_(span.clamped_at_first), last_(span.clamped_at_last) {
    if (first_ && last_) {
      number_ = 2 * M_PI * std::max(1.0, std::round(0.5 * waves));
    } else if (first_ || last_) {
      // A root of tan x = x.
      const double near = (std::max(1.0, std::round(waves)) + 0.5) * M_PI;
      number_ = near - 1 / near - 2 / (3 * near * near * near);
    } else {
      number_ = M_PI * std::max(1.0, std::round(waves));
    }
  }
  double operator()(double part) const {
    if (first_ && last_) return 1 - std::cos(number_ * part);
    if (!first_ && !last_) return std::sin(number_ * part);
    const double x = number_ * (first_ ? part : 1 - part);
    return std::sin(x) - x + number_ * (1 - std::cos(x));
  }

 private:
  bool first_, last_;
  double number_;
};

/// Adds the mode, with a slack of `share`, in small deflections of unit size.
void add_mode(const CableState& state, const StraightSpan& span, const Mode& mode, double share, std::vector<double>& shape) {
  const double length = state.length(span.first, span.last);
  std::vector<double> values{0};
  double along = 0, slack = 0;
  for (int i = span.first; i < span.last; ++i) {
    along += state.rest_lengths[i];
    values.push_back(i + 1 < span.last ? mode(along / length) : 0);
    const double change = values.back() - values[values.size() - 2];
    slack += 0.5 * change * change / state.rest_lengths[i];
  }
  for (std::size_t i = 0; i < shape.size(); ++i) shape[i] += std::sqrt(share / slack) * values[i];
}

/// Segments of their lengths, turned by `size` times the slopes of the shape; returns the distance of the ends [m].
double lay_out(const CableState& state, const StraightSpan& span, const std::vector<double>& shape, double size, Bow& bow) {
  for (int i = 0; i < span.segments(); ++i) {
    const double length = state.rest_lengths[span.first + i], angle = size * (shape[i + 1] - shape[i]) / length;
    bow.along[i + 1] = bow.along[i] + length * std::cos(angle);
    bow.across[i + 1] = bow.across[i] + length * std::sin(angle);
  }
  return std::hypot(bow.along.back(), bow.across.back());
}

/// Turns it so that its ends are on the line.
void align(Bow& bow) {
  const double distance = std::hypot(bow.along.back(), bow.across.back());
  if (!(distance > 0)) return;
  const double cosine = bow.along.back() / distance, sine = bow.across.back() / distance;
  for (std::size_t i = 0; i < bow.along.size(); ++i) {
    const double along = bow.along[i], across = bow.across[i];
    bow.along[i] = cosine * along + sine * across;
    bow.across[i] = cosine * across - sine * along;
  }
}

}  // namespace

double waves_of_sudden_bow(const CableModel& model, const CableState& state, const StraightSpan& span, double time) {
  const double most = std::max(1, span.segments() / segments_of_half_wave);
  const double stiffness = CableMaterials(model, state).largest_bending_stiffness();
  if (!(stiffness > 0)) return most;
  const double length = state.length(span.first, span.last);
  const double mass = std::accumulate(state.masses.begin() + span.first, state.masses.begin() + span.last, 0.0);
  const double fourth_power = mass * length * length * length / (4 * std::pow(M_PI, 4) * stiffness * time * time);
  return std::clamp(std::pow(fourth_power, 0.25), 1.0, most);
}

Bow find_bow(const CableState& state, const StraightSpan& span, double distance, double waves) {
  std::vector<double> shape(span.segments() + 1, 0.0);
  add_mode(state, span, Mode(span, 1), 0.5, shape);
  add_mode(state, span, Mode(span, waves), 0.5, shape);
  Bow bow;
  bow.along.assign(shape.size(), 0.0);
  bow.across.assign(shape.size(), 0.0);
  // The slack is a^2 of small deflections of different modes, 2 a^2 of one, and less of larger ones.
  double from = 0.5 * std::sqrt(state.length(span.first, span.last) - distance), to = from;
  const double most = largest_growth * from;
  while (to < most && lay_out(state, span, shape, to, bow) > distance) {
    from = to;
    to *= growth;
  }
  for (int i = 0; i < bisections; ++i) {
    const double middle = 0.5 * (from + to);
    (lay_out(state, span, shape, middle, bow) > distance ? from : to) = middle;
  }
  lay_out(state, span, shape, to, bow);
  align(bow);
  return bow;
}

}  // namespace verlet_cable
