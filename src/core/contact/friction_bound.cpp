#include "contact/friction_bound.h"

#include <algorithm>
#include <cmath>

#include "chain/direction.h"
#include "contact/touched_place.h"

namespace verlet_cable {

namespace {

/// What touches an obstacle in places that are nearer to each other than this, in radii, is at one corner of it.
constexpr double corner_size = 0.25;
/// On a blade the force may lean so far that it hardly presses any more: its cosine, relative to that without friction.
constexpr double flattest = 0.1;
/// Of the sine of an angle for which series do.
constexpr double small_square = 0.01;

/// How Coulomb's friction is bounded at a contact that stands for an arc of the cable: relative to the normal force it is within
/// `friction` of `lean`.
struct FrictionBound {
  double friction = 0;
  Vector3 lean = Vector3::Zero();
};

/// tanh(friction angle / 2) / tan(angle / 2), by the sine of angle / 2.
double friction_of_turn(double friction, double sine) {
  const double square = sine * sine;
  if (square < small_square && friction * friction * square < small_square) {
    // In series of asin, tan and tanh, to a part in 10^9.
    const double arc = 1 + square * (1.0 / 6 + square * (3.0 / 40 + square * (5.0 / 112)));
    const double turned = friction * friction * square * arc * arc;
    const double tanh = 1 - turned * (1.0 / 3 - turned * (2.0 / 15 - turned * (17.0 / 315)));
    return friction * arc * tanh * std::sqrt(1 - square);
  }
  const double half_angle = std::asin(sine);
  return std::tanh(friction * half_angle) / std::tan(half_angle);
}

/// Turned around an obstacle by an angle, tension grows by up to exp(friction * angle) along the arc (Euler): between T and T'
/// along directions t and t' the obstacle's force on the cable is T t - T' t'. Without friction it halves the angle, to where it
/// may lean from the normal: a node or segment at a sharp edge stands for all directions that the edge can push in. What is
/// `flat` pushes along its normal alone; it would work without end on a cable that is drawn through it.
FrictionBound bound_of_arc(double friction, const Vector3& before, const Vector3& after, const Vector3& normal, bool flat) {
  const double rise = normal.dot(before), fall = -normal.dot(after);
  if (!(rise > 0) && !(fall > 0)) return {friction};
  const double before_length = before.norm(), after_length = after.norm();
  const double sine = 0.5 * (rise / before_length + fall / after_length);
  if (!(sine > 0)) return {friction};
  if (sine * sine < small_square) return {friction_of_turn(friction, sine)};
  if (flat) return {friction};
  const Vector3 sum = before / before_length + after / after_length;
  const double across = normal.dot(sum);
  const Vector3 along = sum - across * normal;
  const double length = along.norm();
  if (!(length > 0)) return {friction_of_turn(friction, std::min(sine, 1.0))};
  const double lean = -across / length;
  const double bound = friction_of_turn(friction, std::min(sine * std::sqrt(1 + lean * lean), 1.0));
  const double most = (lean + bound) / std::max(1 - lean * bound, flattest);
  const double least = (lean - bound) / std::max(1 + lean * bound, flattest);
  return {0.5 * (most - least), 0.5 * (most + least) / length * along};
}

void bound(const FrictionBound& bound, Touch& touch) {
  touch.friction = bound.friction;
  touch.lean = bound.lean;
}

}  // namespace

void bound_friction_of_nodes(const CableState& state, std::size_t first, bool flat, std::vector<Touch>& touches) {
  const std::vector<Vector3>& x = state.positions;
  for (std::size_t k = first; k < touches.size(); ++k) {
    const auto node = static_cast<std::size_t>(first_node_of(touches[k].other_key));
    if (node == 0 || node + 1 == x.size()) continue;
    bound(bound_of_arc(touches[k].friction, x[node] - x[node - 1], x[node + 1] - x[node], touches[k].normal, flat), touches[k]);
  }
}

void bound_friction_at_corners(const CableState& state, std::size_t first, const std::vector<Vector3>& feet,
                               std::vector<Touch>& touches, std::vector<std::size_t>& pressed) {
  const auto first_node = [&](std::size_t k) { return first_node_of(touches[k].other_key); };
  const auto last_node = [&](std::size_t k) { return last_node_of(touches[k].other_key); };
  const auto direction = [&](int i) { return segment_direction(state, i); };
  const auto bound_turn = [&](Touch& touch, const Vector3& before, const Vector3& behind) {
    bound(bound_of_arc(touch.friction, before, behind, touch.normal, false), touch);
  };
  const auto meet = [&](std::size_t k, std::size_t next) { return first_node(next) <= last_node(k); };
  const auto are_one_corner = [&](std::size_t k, std::size_t next) {
    return meet(k, next) && (feet[next - first] - feet[k - first]).norm() < corner_size * touches[k].radius;
  };
  const auto force_at = [&](std::size_t k, int node) {
    const CablePoint& point = touches[k].point;
    return touches[k].last_force * (point.segment == node ? 1 - point.fraction : point.fraction);
  };
  // The cable's direction between two that meet.
  const auto direction_between = [&](std::size_t k, std::size_t next) -> Vector3 {
    const int node = last_node(k);
    if (first_node(next) < node) return direction(first_node(next));
    const double before = force_at(k, node), behind = force_at(next, node), sum = before + behind;
    const double part = sum > 0 ? before / sum : 0.5;
    return ((1 - part) * direction(node - 1) + part * direction(node)).normalized();
  };
  pressed.clear();
  for (std::size_t k = first; k < touches.size(); ++k) {
    const bool inner = first_node(k) > 0 && last_node(k) < state.segments();
    if (!inner) continue;
    if (touches[k].mode == Touch::Mode::open)
      bound_turn(touches[k], direction(first_node(k) - 1), direction(last_node(k)));
    else
      pressed.push_back(k);
  }
  for (std::size_t begin = 0, end = 0; begin < pressed.size(); begin = end) {
    while (++end < pressed.size() && are_one_corner(pressed[end - 1], pressed[end])) {
    }
    const std::size_t front = pressed[begin], back = pressed[end - 1];
    const bool meets_last = begin > 0 && meet(pressed[begin - 1], front);
    const bool meets_next = end < pressed.size() && meet(back, pressed[end]);
    const Vector3 before = meets_last ? direction_between(pressed[begin - 1], front) : direction(first_node(front) - 1);
    const Vector3 behind = meets_next ? direction_between(back, pressed[end]) : direction(last_node(back));
    for (std::size_t i = begin; i < end; ++i) bound_turn(touches[pressed[i]], before, behind);
  }
}

}  // namespace verlet_cable
