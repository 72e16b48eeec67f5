#include "contact/pressed_lengths.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace verlet_cable {

namespace {

/// Each halves the part of a segment in which a place is looked for.
constexpr int halvings = 30;
/// Relative.
constexpr double distance_rounding = 1e-9;

struct PressedPlace {
  double fraction = 0;
  int touch = -1;
};

/// Adds to the touches, by the trapezoidal rule, `weight` times what is pressed of a segment. `outside`: of what is beyond the
/// first and the last place.
template <class Add>
void share_part(const PressedPlace* first, const PressedPlace* last, double from, double to, double outside, const Add& add) {
  if (first == last) return;
  add(first->touch, outside * (first->fraction - from));
  for (const PressedPlace* place = first; place + 1 != last; ++place)
    for (const PressedPlace* end : {place, place + 1}) add(end->touch, 0.5 * (place[1].fraction - place->fraction));
  add((last - 1)->touch, outside * (to - (last - 1)->fraction));
}

/// [m] Of a segment along `way` that another one covers: where that lies beside it and what its diameter is wide.
double covered_length(const Vector3& from, const Vector3& way, const Vector3& other_from, const Vector3& other_way,
                      double other_diameter) {
  const double length = way.norm(), other_length = other_way.norm();
  if (!(length > 0) || !(other_length > 0)) return 0;
  const Vector3 along = way / length;
  const double sine = along.cross(other_way).norm() / other_length;
  const double begin = along.dot(other_from - from), end = begin + along.dot(other_way);
  const double beside = std::max(0.0, std::min(length, std::max(begin, end)) - std::max(0.0, std::min(begin, end)));
  const double wide = beside + sine * other_diameter;
  return std::min(length, sine * wide > other_diameter ? other_diameter / sine : wide);
}

/// Whether a segment runs out beside a face that the one before or behind it, `other`, is over, or comes closer to.
bool is_beside(const PressedPart& part, const PressedPart& other) {
  if (!part.is_straight || part.is_over_face || std::abs(part.segment - other.segment) != 1) return false;
  const bool before = other.segment < part.segment;
  const double near = before ? part.first : part.second, far = before ? part.second : part.first;
  return near < far && (other.is_over_face || (before ? other.first : other.second) <= near * (1 + distance_rounding));
}

}  // namespace

PressedPart part_within(const Shape& shape, const Vector3& start, const Vector3& end, double fraction, double reach) {
  const auto is_within = [&](double at) { return closest_point(shape, start + at * (end - start), reach).distance < reach; };
  const auto border = [&](double limit) {
    if (is_within(limit)) return limit;
    double inside = fraction, outside = limit;
    for (int i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (inside + outside);
      (is_within(middle) ? inside : outside) = middle;
    }
    return inside;
  };
  PressedPart part;
  part.from = part.to = part.deepest_fraction = fraction;
  if (!is_within(fraction)) return part;
  part.from = border(0);
  part.to = border(1);
  return part;
}

void set_pressed_lengths(const CableMaterials& materials, const CableState& state, const std::vector<PressedPart>& parts,
                         const std::vector<int>& nodes, std::size_t first, std::vector<Vector3>& feet,
                         std::vector<Touch>& touches) {
  for (std::size_t k = first; k < touches.size(); ++k) touches[k].soft_stiffness = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const PressedPart& part = parts[k];
    const bool is_outside = (k > 0 && is_beside(part, parts[k - 1])) || (k + 1 < parts.size() && is_beside(part, parts[k + 1]));
    if (is_outside) continue;
    const int i = part.segment;
    const double length = state.rest_lengths[i], stiffness = side_stiffness(materials[i]);
    const auto share = [&](double weight, const std::array<PressedPlace, 4>& places) {
      if (!(weight > 0)) return;
      std::array<PressedPlace, 4> pressed;
      std::size_t count = 0;
      for (const PressedPlace& place : places)
        if (place.touch >= 0 && place.fraction >= part.from && place.fraction <= part.to) pressed[count++] = place;
      share_part(pressed.data(), pressed.data() + count, part.from, part.to, part.is_straight ? 1 : 0.5,
                 [&](int touch, double of_segment) {
                   const double pressed_length = weight * of_segment * length;
                   if (!(pressed_length > 0)) return;
                   touches[touch].length += pressed_length;
                   touches[touch].soft_stiffness += stiffness * pressed_length;
                 });
    };
    share(part.flat, {{{0, nodes[i]}, {part.from, part.begins}, {part.to, part.ends}, {1, nodes[i + 1]}}});
    share(1 - part.flat, {{{0, nodes[i]}, {part.deepest_fraction, part.deepest}, {1, nodes[i + 1]}, {}}});
  }
  std::size_t kept = first;
  for (std::size_t k = first; k < touches.size(); ++k) {
    Touch& touch = touches[k];
    const bool is_stiff = std::isinf(side_stiffness(materials[touch.point.segment]));
    if (is_stiff && touch.length == 0) touch.soft_stiffness = infinity;
    if (touch.soft_stiffness == 0) continue;
    soften(touch.soft_stiffness, touch);
    start_touch(touch);
    if (kept != k) {
      touches[kept] = touch;
      feet[kept - first] = feet[k - first];
    }
    ++kept;
  }
  touches.resize(kept);
  feet.resize(kept - first);
}

void set_crossed_lengths(const MaterialDesc& material, const Vector3& from, const Vector3& way,
                         const MaterialDesc& other_material, const Vector3& other_from, const Vector3& other_way, Touch& touch) {
  touch.length = covered_length(from, way, other_from, other_way, 2 * other_material.radius);
  touch.other_length = covered_length(other_from, other_way, from, way, 2 * material.radius);
  if (!(touch.length > 0) || !(touch.other_length > 0)) return;
  const double give = 1 / (side_stiffness(material) * touch.length) + 1 / (side_stiffness(other_material) * touch.other_length);
  if (give > 0) soften(1 / give, touch);
}

}  // namespace verlet_cable
