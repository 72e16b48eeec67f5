#include "contact/contact_set.h"

#include <algorithm>

#include "chain/direction.h"
#include "chain/point_motion.h"
#include "contact/new_touch.h"
#include "contact/pressed_lengths.h"
#include "contact/smooth_cable.h"
#include "contact/touched_place.h"
#include "geometry/segment_geometry.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// Relative, of distances.
constexpr double distance_rounding = 1e-6;
/// From a node to the nodes next to it, by keys.
constexpr std::uint64_t neighbouring_places = places;
/// Deeper than this, in radii, nothing that touches a surface from outside gets: it is inside.
constexpr double deepest_touch = 0.5;

/// Whether a touch was this in the last substep. A cable that slides over an edge touches the obstacle with one element after the
/// other.
bool continues(const CachedContact& last, const Touch& touch) {
  if (last.key != touch.key) return false;
  const std::uint64_t reach = touch.other.cable < 0 ? neighbouring_places : 0;
  return std::max(last.other_key, touch.other_key) - std::min(last.other_key, touch.other_key) <= reach;
}

}  // namespace

void ContactSet::find(const std::vector<SimulatedCable>& cables, const std::vector<int>& island,
                      const std::vector<ContactMember>& members, const std::vector<MovingObstacle>& obstacles,
                      const std::vector<MovingObstacle>& bodies, const std::vector<Attachment>& attachments,
                      const ContactRules& rules, double h, SegmentPairs& pairs) {
  rules_ = rules;
  const ContactReach reach(rules.still, rules.time_step, h);
  touches_.clear();
  intrusions_.clear();
  touched_.assign(members.size(), 0);
  touches_body_.assign(members.size(), 0);
  recalled_.assign(members.size(), 0);
  const bool any_solids = !obstacles.empty() || !bodies.empty();
  if (!any_solids && !rules.pairs.self && !rules.pairs.between_cables) return;
  if (places_.size() < cables.size()) places_.resize(cables.size());
  for (std::size_t k = 0; k < island.size(); ++k) {
    const SimulatedCable& cable = cables[island[k]];
    places_[island[k]] = static_cast<int>(k);
    if (!any_solids) continue;
    on_obstacle_.begin(cable, island[k], members[k], attachments);
    const std::size_t first_of_cable = touches_.size();
    for (const MovingObstacle& obstacle : obstacles) find_obstacle(cable, members[k], obstacle, first_of_cable, reach);
    for (auto body = bodies.begin(); body != bodies.end();) {
      const auto next = std::find_if(body, bodies.end(), [&](const MovingObstacle& other) { return other.body != body->body; });
      on_obstacle_.enter_body(&*body, &*body + (next - body));
      for (; body != next; ++body) find_obstacle(cable, members[k], *body, first_of_cable, reach);
    }
  }
  if (!rules.pairs.self && !rules.pairs.between_cables) return;
  double radius = 0;
  thinnest_ = shortest_ = infinity;
  for (const int cable : island) {
    const CableMaterials materials(cables[cable]);
    const std::vector<double>& lengths = cables[cable].state.rest_lengths;
    radius = std::max(radius, materials.largest_radius());
    thinnest_ = std::min(thinnest_, materials.smallest([](const MaterialDesc& material) { return material.radius; }));
    shortest_ = std::min(shortest_, *std::min_element(lengths.begin(), lengths.end()));
  }
  find_joined(attachments, members);
  grid_.update(cables, island, rules.pairs, reach.at(0, radius) + (1 + 2 * largest_arc) * radius, h, pairs);
  find_pairs(cables, members, pairs, radius, reach);
}

void ContactSet::find_joined(const std::vector<Attachment>& attachments, const std::vector<ContactMember>& members) {
  joined_.clear();
  for (const ContactMember& member : members)
    for (const KinematicTarget& target : member.targets->nodes) {
      const Attachment& attachment = attachments[target.attachment];
      if (attachment.is_junction) joined_.push_back({attachment.body.index, attachment.node, attachment.holder});
    }
}

void ContactSet::find_obstacle(const SimulatedCable& cable, const ContactMember& member, const MovingObstacle& moving,
                               std::size_t first_of_cable, const ContactReach& reach) {
  const std::size_t first = touches_.size();
  on_obstacle_.find(moving, reach, touches_);
  if (touches_.size() == first) return;
  if (moving.body >= 0) touches_body_[places_[touches_.back().point.cable]] = 1;
  for (std::size_t k = first; k < touches_.size(); ++k) start(touches_[k], member, reach);
  on_obstacle_.share(first, touches_);
  keep_nearest_obstacles(first_of_cable, cable.state.nodes() + cable.state.segments(), touches_);
}

void ContactSet::find_pairs(const std::vector<SimulatedCable>& cables, const std::vector<ContactMember>& members,
                            const SegmentPairs& found, double thickest, const ContactReach& reach) {
  const auto is_of = [](const SegmentId& segment, const SegmentPairs::Pair& pair) {
    return pair.first.cable == segment.cable && pair.first.segment == segment.segment;
  };
  for (auto pair = found.pairs.begin(); pair != found.pairs.end();) {
    const SegmentId segment = pair->first;
    near_.clear();
    for (; pair != found.pairs.end() && is_of(segment, *pair); ++pair) {
      const double speed = found.speeds[pair->first_node] + found.speeds[pair->second_node];
      const double moved = found.moved[pair->first_node] + found.moved[pair->second_node];
      const double far = 2 * (1 + largest_arc) * thickest + reach.at(speed, thickest);
      if (pair->distance - moved > far * (1 + distance_rounding)) continue;
      if (can_touch(cables, joined_, *pair)) look_at(cables, members, *pair, speed, reach);
    }
    const SimulatedCable& cable = cables[segment.cable];
    const double radius = CableMaterials(cable)[segment.segment].radius;
    keep_nearest_pairs(room_around(radius, cable.state.rest_lengths[segment.segment], thinnest_, shortest_), near_);
    for (const NearPair& near : near_) add_pair(cables, members, near, reach);
  }
}

/// Whether the segments of a pair may touch: then it is one of `near_`.
void ContactSet::look_at(const std::vector<SimulatedCable>& cables, const std::vector<ContactMember>& members,
                         const SegmentPairs::Pair& pair, double speed, const ContactReach& reach) {
  const SimulatedCable &a = cables[pair.first.cable], &b = cables[pair.second.cable];
  const int i = pair.first.segment, j = pair.second.segment;
  const double first_radius = CableMaterials(a)[i].radius, second_radius = CableMaterials(b)[j].radius;
  const double radius = std::min(first_radius, second_radius), surface = first_radius + second_radius;
  const double far = (1 + largest_arc) * surface + reach.at(speed, radius);
  const Vector3 &a0 = a.state.positions[i], &b0 = b.state.positions[j];
  const Vector3 along_a = a.state.positions[i + 1] - a0, along_b = b.state.positions[j + 1] - b0;
  const ClosestPoints closest = closest_points(a0, along_a, b0, along_b);
  const double distance = closest.between.norm();
  if (distance > far) return;
  const Vector3 normal = distance > 0 ? Vector3(closest.between / distance) : along_a.unitOrthogonal();
  const CablePoint first{pair.first.cable, i, closest.first}, second{pair.second.cable, j, closest.second};
  const Vector3 velocity = on_centre_line(first, a.state.velocities) - on_centre_line(second, b.state.velocities);
  const double gap = distance - surface + bulge_along(normal, a.state, i, closest.first, first_radius) -
                     bulge_along(normal, b.state, j, closest.second, second_radius);
  const std::uint64_t key = pair_key | i, other_key = key_of(members[places_[pair.second.cable]].id, j);
  if (!reach.closes(gap, normal, velocity, radius) && !bore(*members[places_[pair.first.cable]].cache, key, other_key)) return;
  near_.push_back({first, second, normal, gap, radius, key, other_key});
}

void ContactSet::add_pair(const std::vector<SimulatedCable>& cables, const std::vector<ContactMember>& members,
                          const NearPair& near, const ContactReach& reach) {
  const SimulatedCable &a = cables[near.first.cable], &b = cables[near.second.cable];
  const int i = near.first.segment, j = near.second.segment;
  Touch& touch = touches_.emplace_back();
  touch.key = near.key;
  touch.other_key = near.other_key;
  touch.point = near.first;
  touch.other = near.second;
  touch.normal = near.normal;
  touch.gap = near.gap;
  touch.friction = rules_.cable_friction;
  let_roll(rolling_part(CableMaterials(a)[i]), near.normal.cross(segment_direction(a.state, i)), touch);
  let_roll(rolling_part(CableMaterials(b)[j]), near.normal.cross(segment_direction(b.state, j)), touch);
  touch.radius = near.radius;
  touch.base_stiffness = std::min(stopping_stiffness_of(a, i, reach.time_step()), stopping_stiffness_of(b, j, reach.time_step()));
  // Both sides meet in the middle of what they are in each other.
  const double overlap = std::max(0.0, -near.gap);
  put_beside(a.state, near.normal, CableMaterials(a)[i].radius - 0.5 * overlap, touch.point);
  put_beside(b.state, -near.normal, CableMaterials(b)[j].radius - 0.5 * overlap, touch.other);
  touch.velocity = at_point(touch.point, a.state.velocities) - at_point(touch.other, b.state.velocities);
  touch.position = on_centre_line(near.first, a.state.positions);
  const MaterialDesc &first_material = CableMaterials(a)[i], &second_material = CableMaterials(b)[j];
  if (has_section(first_material) || has_section(second_material)) {
    const auto way = [](const SimulatedCable& cable, int k) -> Vector3 {
      return cable.state.positions[k + 1] - cable.state.positions[k];
    };
    set_crossed_lengths(first_material, a.state.positions[i], way(a, i), second_material, b.state.positions[j], way(b, j), touch);
  }
  start(touch, members[places_[near.first.cable]], reach);
}

/// Sets what it takes over from the substep before, and its law.
void ContactSet::start(Touch& touch, const ContactMember& member, const ContactReach& reach) {
  const double gentle = gentle_gap(touch.radius, contact_time(reach.time_step()));
  const bool known = recall(member, touch);
  if (touch.obstacle >= 0 && touch.gap < -deepest_touch * touch.radius)
    note({touch.point.cable, touch.point.segment, touch.obstacle, -touch.gap});
  touch.inside = (!known || touch.inside) && touch.gap < gentle;
  touch.inside_for = touch.inside ? touch.inside_for + reach.h() : 0;
  if (touch.inside) touch.gap = gentle;
  touch.yields = touch.inside && touch.other.cable >= 0;
  anticipate(Scheme::conserving, reach.h(), reach.time(), Vector3::Zero(), touch);
  start_touch(touch);
  if (rules_.still) hold_bound(touch.last_force, touch);
  touched_[places_[touch.point.cable]] = 1;
  if (touch.other.cable >= 0) touched_[places_[touch.other.cable]] = 1;
}

/// The deepest of a cable in an obstacle; all of them come one after the other.
void ContactSet::note(const Intrusion& found) {
  if (intrusions_.empty() || intrusions_.back().cable != found.cable || intrusions_.back().obstacle != found.obstacle)
    intrusions_.push_back(found);
  else if (intrusions_.back().depth < found.depth)
    intrusions_.back() = found;
}

/// What a touch was in the last substep; false if it was none. A member's touches are asked for in ascending order.
bool ContactSet::recall(const ContactMember& member, Touch& touch) {
  const ContactCache& cache = *member.cache;
  std::size_t& recalled = recalled_[places_[touch.point.cable]];
  while (recalled < cache.size() && keys(cache[recalled]) < keys(touch)) ++recalled;
  const CachedContact* last = nullptr;
  if (recalled < cache.size() && continues(cache[recalled], touch))
    last = &cache[recalled];
  else if (recalled > 0 && continues(cache[recalled - 1], touch))
    last = &cache[recalled - 1];
  if (last == nullptr) return false;
  go_on_from(*last, touch);
  return true;
}

void ContactSet::follow_scheme(Scheme scheme, const std::vector<SimulatedCable>& cables, double h) {
  const ContactReach reach(rules_.still, rules_.time_step, h);
  const auto acceleration_at = [&](const CablePoint& point) -> Vector3 {
    if (point.cable < 0) return Vector3::Zero();
    return at_point(point, cables[point.cable].state.accelerations);
  };
  for (Touch& touch : touches_)
    anticipate(scheme, reach.h(), reach.time(),
               acceleration_at(touch.point) - acceleration_at(touch.other) - touch.body_acceleration, touch);
}

bool ContactSet::is_stuck() const {
  return std::any_of(touches_.begin(), touches_.end(), is_pushed_out);
}

void ContactSet::keep(const std::vector<ContactMember>& members) const {
  for (const ContactMember& member : members) member.cache->clear();
  for (const Touch& touch : touches_) members[places_[touch.point.cable]].cache->push_back(kept(touch));
}

}  // namespace verlet_cable
