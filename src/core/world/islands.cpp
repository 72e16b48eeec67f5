#include "world/islands.h"

#include <algorithm>
#include <numeric>

#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// Contacts are looked for this far from a surface, in radii, besides what motion adds (see ContactSet::reach).
constexpr double still_reach = 1.2;
/// A cable's share, in steps at its speed, of the distance at which contacts are looked for, and of its own way.
constexpr double steps_of_motion = 4;
/// What a cable may be accelerated with besides its last acceleration [m/s^2].
constexpr double spare_acceleration = 100;

/// [m] So far from where it is a cable may touch something in the next step.
double margin_of(const SimulatedCable& cable, const KinematicTargets& targets, double time_step) {
  double speed = 0, acceleration = 0;
  for (std::size_t i = 0; i < cable.state.positions.size(); ++i) {
    speed = std::max(speed, cable.state.velocities[i].squaredNorm());
    acceleration = std::max(acceleration, cable.state.accelerations[i].squaredNorm());
  }
  for (const KinematicTarget& target : targets.nodes) {
    speed = std::max({speed, target.velocity.squaredNorm(), target.next_velocity.squaredNorm()});
  }
  const double motion = std::sqrt(speed) + time_step * (std::sqrt(acceleration) + spare_acceleration);
  return (1 + still_reach) * CableMaterials(cable).largest_radius() + steps_of_motion * time_step * motion;
}

Aabb widened(const Aabb& box, double margin) {
  return Aabb(box.min() - Vector3::Constant(margin), box.max() + Vector3::Constant(margin));
}

Aabb reach_of(const SimulatedCable& cable, const KinematicTargets& targets, double margin) {
  Aabb box;
  for (const Vector3& position : cable.state.positions) box.extend(position);
  for (const KinematicTarget& target : targets.nodes) box.extend(target.next_position);
  return widened(box, margin);
}

Aabb reach_of(const SimulatedBody& body, const BodyProgress& progress, double time_step) {
  Aabb box;
  for (const BodyShape& shape : body.shapes) box.extend(bounds(shape.shape, body.pose * shape.pose));
  const double size = box.diagonal().norm();
  const double speed = body.velocity.norm() + size * body.angular_velocity.norm();
  const double acceleration = progress.acceleration.norm() + size * progress.angular_acceleration.norm() + spare_acceleration;
  return widened(box, steps_of_motion * time_step * (speed + time_step * acceleration));
}

/// Whether leaves of two trees of boxes overlap, below their nodes `i` and `j`. The children of k are 2 k + 1 and 2 k + 2.
bool overlap(const std::vector<Aabb>& a, std::size_t i, const std::vector<Aabb>& b, std::size_t j) {
  if (!a[i].intersects(b[j])) return false;
  const bool is_first_leaf = 2 * i + 1 >= a.size(), is_second_leaf = 2 * j + 1 >= b.size();
  if (is_first_leaf && is_second_leaf) return true;
  if (is_second_leaf || (!is_first_leaf && i <= j)) return overlap(a, 2 * i + 1, b, j) || overlap(a, 2 * i + 2, b, j);
  return overlap(a, i, b, 2 * j + 1) || overlap(a, i, b, 2 * j + 2);
}

/// The axis along which boxes are spread furthest.
int longest_axis(const std::vector<Aabb>& boxes) {
  Aabb centers;
  for (const Aabb& box : boxes) centers.extend(Vector3(box.center()));
  int axis = 0;
  centers.sizes().maxCoeff(&axis);
  return axis;
}

}  // namespace

double mass_of(const Island& island, const State& state) {
  double mass = 0;
  for (const int cable : island.cables)
    for (const double of_node : state.cables[cable].state.masses) mass += of_node;
  for (const int index : island.bodies) {
    const SimulatedBody& body = state.bodies[index];
    mass += body.mass;
    mass += state.scene->fluid.density * body.fluid.volume + body.fluid.added_mass.maxCoeff();
  }
  return mass;
}

void Islands::build(const State& state) {
  labels_.resize(state.cables.size() + state.bodies.size());
  std::iota(labels_.begin(), labels_.end(), 0);
  if (are_islands_of_many(*state.scene)) find_reaches(state);
  if (cables_touch(*state.scene)) find_labels(state);
  if (!state.bodies.empty()) {
    if (are_islands_of_many(*state.scene)) join_touching_bodies(state);
    join_by_bodies(state);
  }
  if (islands_.empty() || labels_ != last_labels_) sort_into_islands(state);
  if (!state.bodies.empty()) find_held(state);
}

/// By their labels.
void Islands::sort_into_islands(const State& state) {
  const int cables = static_cast<int>(state.cables.size());
  std::vector<Island> before;
  before.swap(islands_);
  auto same = before.begin();
  place_.resize(labels_.size());
  for (int i = 0; i < static_cast<int>(labels_.size()); ++i) {
    if (labels_[i] == i) {
      place_[i] = static_cast<int>(islands_.size());
      islands_.emplace_back();
    }
    place_[i] = place_[labels_[i]];
    Island& island = islands_[place_[i]];
    if (i < cables)
      island.cables.push_back(i);
    else
      island.bodies.push_back(i - cables);
  }
  for (Island& island : islands_) {
    if (island.cables.empty()) break;
    while (same != before.end() && !same->cables.empty() && same->cables.front() < island.cables.front()) ++same;
    if (same != before.end() && same->cables == island.cables) island.pairs = std::move(same->pairs);
  }
  last_labels_ = labels_;
  segments_ = 0;
  for (const SimulatedCable& cable : state.cables) segments_ += cable.state.segments();
}

void Islands::find_reaches(const State& state) {
  const std::size_t count = state.cables.size();
  reaches_.resize(count);
  margins_.resize(count);
  segment_reaches_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const KinematicTargets& targets = state.cable_progress[i].targets;
    margins_[i] = margin_of(state.cables[i], targets, state.scene->time_step);
    reaches_[i] = reach_of(state.cables[i], targets, margins_[i]);
    segment_reaches_[i].clear();
  }
}

/// Joins cables that come close to each other: a sweep along the axis on which they are spread furthest.
void Islands::find_labels(const State& state) {
  const std::size_t count = state.cables.size();
  const int axis = longest_axis(reaches_);
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(), [&](int a, int b) {
    const double first = reaches_[a].min()[axis], second = reaches_[b].min()[axis];
    return first < second || (first == second && a < b);
  });
  open_.clear();
  for (const int cable : order_) {
    const double start = reaches_[cable].min()[axis];
    open_.erase(std::remove_if(open_.begin(), open_.end(), [&](int other) { return reaches_[other].max()[axis] < start; }),
                open_.end());
    for (const int other : open_)
      if (reaches_[cable].intersects(reaches_[other]) && come_close(state, cable, other)) join(cable, other);
    open_.push_back(cable);
  }
  for (int cable = 0; cable < static_cast<int>(count); ++cable) labels_[cable] = root(cable);
}

void Islands::join_by_bodies(const State& state) {
  const int cables = static_cast<int>(state.cables.size());
  for (const Attachment& attachment : state.attachments) {
    const int holder = state.body_of_frame(attachment.frame);
    if (holder < 0 || attachment.body.is_net()) continue;
    join(attachment.body.is_cable() ? attachment.body.index : cables + attachment.body.index, cables + holder);
  }
  for (int i = 0; i < static_cast<int>(labels_.size()); ++i) labels_[i] = root(i);
}

/// Attachments may be others from step to step.
void Islands::find_held(const State& state) {
  for (Island& island : islands_) island.held.clear();
  for (int a = 0; a < static_cast<int>(state.attachments.size()); ++a) {
    const int held = held_body(state.attachments[a]);
    if (held >= 0) islands_[place_[state.cables.size() + held]].held.push_back(a);
  }
  for (Island& island : islands_)
    std::sort(island.held.begin(), island.held.end(), [&](int a, int b) {
      const int first = held_body(state.attachments[a]), second = held_body(state.attachments[b]);
      return first < second || (first == second && a < b);
    });
}

/// Joins bodies with the cables that they may touch.
void Islands::join_touching_bodies(const State& state) {
  const int cables = static_cast<int>(state.cables.size());
  for (int i = 0; i < static_cast<int>(state.bodies.size()); ++i) {
    if (state.bodies[i].shapes.empty() || !state.body_progress[i].is_placed) continue;
    body_reach_.assign(1, reach_of(state.bodies[i], state.body_progress[i], state.scene->time_step));
    for (int cable = 0; cable < cables; ++cable)
      if (body_reach_.front().intersects(reaches_[cable]) && root(cable) != root(cables + i) &&
          overlap(segment_reaches(state, cable), 0, body_reach_, 0))
        join(cable, cables + i);
  }
}

bool Islands::come_close(const State& state, int first, int second) {
  return root(first) != root(second) && overlap(segment_reaches(state, first), 0, segment_reaches(state, second), 0);
}

/// Boxes around segments and what their holders aim at, in a binary tree.
const std::vector<Aabb>& Islands::segment_reaches(const State& state, int cable) {
  std::vector<Aabb>& boxes = segment_reaches_[cable];
  if (!boxes.empty()) return boxes;
  const std::vector<Vector3>& positions = state.cables[cable].state.positions;
  const std::size_t segments = positions.size() - 1;
  std::size_t leaves = 1;
  while (leaves < segments) leaves *= 2;
  boxes.assign(2 * leaves - 1, Aabb());
  Aabb* const leaf = boxes.data() + leaves - 1;
  for (std::size_t i = 0; i < segments; ++i) leaf[i].extend(positions[i]).extend(positions[i + 1]);
  for (const KinematicTarget& target : state.cable_progress[cable].targets.nodes) {
    const auto node = static_cast<std::size_t>(target.node);
    if (node > 0) leaf[node - 1].extend(target.next_position);
    if (node < segments) leaf[node].extend(target.next_position);
  }
  for (std::size_t i = 0; i < segments; ++i) leaf[i] = widened(leaf[i], margins_[cable]);
  for (std::size_t k = leaves - 1; k-- > 0;) boxes[k] = boxes[2 * k + 1].merged(boxes[2 * k + 2]);
  return boxes;
}

int Islands::root(int cable) {
  while (labels_[cable] != cable) cable = labels_[cable] = labels_[labels_[cable]];
  return cable;
}

/// The lower one names both.
void Islands::join(int first, int second) {
  first = root(first);
  second = root(second);
  labels_[std::max(first, second)] = std::min(first, second);
}

}  // namespace verlet_cable
