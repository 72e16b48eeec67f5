#include <algorithm>
#include <cmath>

#include "solve/resting_shape.h"

namespace verlet_cable {

namespace {

/// Of a segment: what of a direction goes on as before where nothing else tells it.
constexpr double bias = 1e-3;
/// With which a place for a node is looked for between the surfaces.
constexpr int most_pushes = 24;
/// Of a segment: less is no push.
constexpr double small_push = 1e-6;

Vector3 level_part(const Vector3& v, const Vector3& down) {
  return v - v.dot(down) * down;
}

/// Lays nodes one after the other, in one direction along the cable.
class Laying {
 public:
  Laying(const CableState& state, const Vector3& down, const Surroundings& surroundings, std::vector<Vector3>& nodes)
      : state_(state), down_(down), surroundings_(surroundings), nodes_(nodes) {}

  /// From node `first` on (excluded) to `last` (included); `goal`: where the last one is to come, if it is held.
  void lay(int first, int last, Vector3 heading, const Vector3* goal) {
    const int way = last > first ? 1 : -1;
    double left = state_.length(std::min(first, last), std::max(first, last));
    bool lies = false;
    for (int i = first; i != last; i += way) {
      const int segment = way > 0 ? i : i - 1;
      left -= state_.rest_lengths[segment];
      const Vector3 direction = next(i, way, segment, heading, left, goal, lies);
      nodes_[i + way] = nodes_[i] + state_.rest_lengths[segment] * direction;
    }
  }

 private:
  Vector3 next(int i, int way, int segment, Vector3& heading, double left, const Vector3* goal, bool& lies) const {
    const double length = state_.rest_lengths[segment];
    const Vector3& from = nodes_[i];
    Vector3 direction = (down_ + bias * heading).normalized();
    bool pushed = false;
    for (int k = 0; k < most_pushes; ++k) {
      Vector3 to = from + length * direction, push = Vector3::Zero();
      if (goal != nullptr && (to - *goal).norm() > left) push = *goal + left * (to - *goal).normalized() - to;
      const bool turns = push.norm() > small_push * length;
      push_out(i + way, segment, from, to, push);
      if (push.norm() <= small_push * length) break;
      if (!turns && !lies && !pushed) set_out(from, left + length, goal, heading);
      pushed = pushed || !turns;
      to += push + (pushed && !turns ? bias * length * heading : Vector3(Vector3::Zero()));
      const Vector3 arm = to - from;
      direction = arm.norm() > small_push * length ? Vector3(arm.normalized()) : heading;
    }
    if (pushed) {
      lies = true;
      const Vector3 level = level_part(direction, down_);
      if (level.norm() > 0.1) heading = level.normalized();
    }
    return direction;
  }

  /// Adds to a `push` [m] of a segment's end `to`, a node, what takes it out of what stands there, not through it: what is met first
  /// is in the way, however thin it is.
  void push_out(int node, int segment, const Vector3& from, const Vector3& to, Vector3& push) const {
    const Vector3 way = to - from;
    const double free = surroundings_.free_part(node, from, way);
    bool stopped = false;
    const auto out_of = [&](const Clearance& c, double fraction) {
      if (free < 1 && c.normal.dot(way) > 0) return;  // at the far side
      stopped = true;
      const Vector3 out = -c.gap / std::max(fraction, 0.1) * c.normal;
      push += std::max(0.0, out.norm() - push.dot(out) / out.norm()) * out.normalized();
    };
    surroundings_.touch_node(node, to, [&](const Clearance& c) { out_of(c, 1); });
    surroundings_.touch_segment(segment, from, to, [&](const Clearance& c) { out_of(c, c.fraction); });
    if (stopped || free == 1) return;
    surroundings_.touch_node(node, from + free * way, [&](const Clearance& c) {
      push -= std::min(0.0, (push + (1 - free) * way).dot(c.normal) + c.gap) * c.normal;
    });
  }

  /// Where it comes to lie it sets out so that what is too long for the way to the goal is half a detour.
  void set_out(const Vector3& from, double left, const Vector3* goal, Vector3& heading) const {
    if (goal == nullptr) return;
    const Vector3 way = *goal - from, level = level_part(way, down_);
    const double lying = left - std::abs(way.dot(down_)), distance = level.norm();
    if (!(distance > 0) || !(lying > 0)) return;
    const double angle = std::acos(std::min(1.0, distance / lying));
    heading = Eigen::AngleAxisd(angle, down_) * (level / distance);
  }

  const CableState& state_;
  const Vector3& down_;
  const Surroundings& surroundings_;
  std::vector<Vector3>& nodes_;
};

}  // namespace

std::vector<Vector3> laid_shape(const CableState& state, const std::vector<HeldNode>& held, const Vector3& down,
                                const Surroundings& surroundings) {
  std::vector<Vector3> nodes(state.nodes());
  Laying laying(state, down, surroundings, nodes);
  const Vector3 across = level_part(held.back().position - held.front().position, down);
  const Vector3 heading = across.norm() > 0 ? Vector3(across.normalized()) : down.unitOrthogonal();
  for (const HeldNode& h : held) nodes[h.node] = h.position;
  laying.lay(held.front().node, 0, -heading, nullptr);
  for (std::size_t k = 0; k + 1 < held.size(); ++k) {
    laying.lay(held[k].node, held[k + 1].node, heading, &held[k + 1].position);
    nodes[held[k + 1].node] = held[k + 1].position;
  }
  laying.lay(held.back().node, state.segments(), heading, nullptr);
  return nodes;
}

}  // namespace verlet_cable
