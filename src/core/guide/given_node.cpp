#include "guide/given_node.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "guide/side.h"
#include "rod/kirchhoff_rod.h"
#include "rod/rod_frames.h"
#include "target/kinematic_targets.h"
#include "verlet_cable/core/cable_materials.h"
#include "world/energy.h"

namespace verlet_cable {

namespace {

/// A node that has been given out on a cable that bends, whose place goes along an ellipse about the guide and the next node: the
/// lengths that were lost are there again, and the strain stays.
class GivenNode {
 public:
  GivenNode(int index, const Attachment& attachment, int side, const Vector3& bulge, State& state)
      : index_(index), state_(state), cable_(state.cables[index].state), guide_(side_of(attachment, side).node) {
    const int away = side_of(attachment, side).away;
    node_ = guide_ + away;
    next_ = node_ + away;
    near_segment_ = std::min(guide_, node_);
    far_segment_ = std::min(node_, next_);
    start_ = cable_.rest_lengths[near_segment_];
    const double whole = start_ + cable_.rest_lengths[far_segment_];
    const Vector3 chord = cable_.positions[next_] - cable_.positions[guide_];
    stretch_ = chord.norm() / whole;
    along_ = chord.normalized();
    across_ = (bulge - bulge.dot(along_) * along_).stableNormalized();
    double& lost = state.guides[attachment.guide].lost_length;
    if (across_.squaredNorm() > 0) lost_ = std::exchange(lost, 0.0);
    length_ = whole + lost_;
    start_masses_ = {cable_.masses[guide_], cable_.masses[next_]};
    regular_ = state.cables[index].model->segment_length;
    half_density_ = 0.5 * CableMaterials(state.cables[index])[near_segment_].linear_density;
    bending_memory_ = cable_.bending_memory;
  }

  /// Puts it at the place, next to where it is, at which the cable has an energy [J]; if there is none, where that differs least.
  void place_at(double energy) {
    const double lowest = std::max(lost_, start_ / widest);
    const double highest = std::max(lowest, std::min(widest * start_, most_ahead * length_));
    // Where the next segment is as long as the others, or about as near as the node that was taken in
    const double first = std::clamp(length_ - regular_, lowest, highest);
    const auto excess = [&](double near) {
      place(near);
      return energy_of_cable(state_, index_).potential() - energy;
    };
    Trial best{first, infinity};
    std::array<Trial, 2> last;
    const auto attempt = [&](double near) {
      const Trial trial{near, excess(near)};
      if (std::abs(trial.excess) < std::abs(best.excess)) best = trial;
      return trial;
    };
    last.fill(attempt(first));
    for (double factor = pace; best.excess != 0; factor *= pace) {
      bool goes_on = false;
      for (const int side : both_sides) {
        const double near = side == 0 ? first / factor : first * factor;
        if (near < lowest || near > highest) continue;
        goes_on = true;
        const Trial next = attempt(near);
        if ((next.excess < 0) != (last[side].excess < 0)) return place(between(last[side], next, excess));
        last[side] = next;
      }
      if (!goes_on) break;
    }
    place(best.near);
  }

 private:
  struct Trial {
    double near = 0, excess = 0;
  };

  /// Puts it at a rest length from the guide [m].
  void place(double near) {
    const double a = stretch_ * near, b = stretch_ * (length_ - near), c = stretch_ * (length_ - lost_);
    const double way = 0.5 * (c + (a - b) * (a + b) / c), height = std::sqrt(std::max(0.0, (a - way) * (a + way)));
    const Vector3 place = cable_.positions[guide_] + way * along_ + height * across_;
    if (!cable_.directors.empty())
      for (const int segment : {near_segment_, far_segment_}) {
        const int other = segment == near_segment_ ? guide_ : next_;
        const double sign = (other < node_) ? 1 : -1;
        cable_.directors[segment] = carried_director(cable_, segment, sign * (place - cable_.positions[other]), 0);
      }
    cable_.positions[node_] = place;
    cable_.rest_lengths[near_segment_] = near;
    cable_.rest_lengths[far_segment_] = length_ - near;
    cable_.masses[guide_] = start_masses_[0] + half_density_ * (near - start_);
    cable_.masses[next_] = start_masses_[1] - half_density_ * (near - start_);
    cable_.bending_memory = bending_memory_;
    yield_to_given_nodes(index_, state_);
  }

  /// Where it is none: regula falsi, where a side that stays counts half.
  template <class Excess>
  static double between(Trial a, Trial b, const Excess& excess) {
    for (int i = 0; i < most_halvings && a.excess != b.excess; ++i) {
      const Trial trial{b.near - b.excess * (b.near - a.near) / (b.excess - a.excess), 0};
      const double found = excess(trial.near);
      if ((found < 0) != (b.excess < 0))
        a = b;
      else
        a.excess *= 0.5;
      b = {trial.near, found};
      if (found == 0) break;
    }
    return b.near;
  }

  /// Of the distance from the guide: it is looked for so far away, and in such steps.
  static constexpr double widest = 1.5, pace = 1.06;
  static constexpr int most_halvings = 12;

  int index_;
  State& state_;
  CableState& cable_;
  int guide_ = 0, node_ = 0, next_ = 0;
  int near_segment_ = 0, far_segment_ = 0;
  double start_ = 0, length_ = 0, lost_ = 0, regular_ = 0;  // [m] at rest
  double stretch_ = 1;
  Vector3 along_ = Vector3::Zero(), across_ = Vector3::Zero();
  std::array<double, 2> start_masses_{0, 0};
  std::vector<std::array<HalfBend, 2>> bending_memory_;  // before it is bent there
  double half_density_ = 0;
};

}  // namespace

void yield_to_given_nodes(int cable, State& state) {
  SimulatedCable& c = state.cables[cable];
  if (c.state.bending_memory.empty()) return;
  const KinematicTargets& targets = state.cable_progress[cable].targets;
  std::vector<HeldDirection> directions;
  hold_directions_at(0, 0, targets, directions);
  hold_directions_on_bodies(state.attachments, state.bodies, targets, directions);
  std::vector<int> shaped;
  for (const Attachment& attachment : state.attachments)
    if (attachment.body == cable_id(cable) && is_wheel(attachment))
      shaped.insert(shaped.end(), {attachment.node, last_node(attachment)});
  yield_to_shape(*c.model, directions, shaped, c.state);
}

void place_given_node(int cable, const Attachment& guide, int side, const Vector3& bulge, double energy, State& state) {
  GivenNode(cable, guide, side, bulge, state).place_at(energy);
}

}  // namespace verlet_cable
