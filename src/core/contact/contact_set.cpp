#include "contact/contact_set.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "chain/direction.h"
#include "chain/point_motion.h"
#include "contact/friction_bound.h"
#include "contact/pressed_lengths.h"
#include "contact/touched_place.h"
#include "geometry/part_over_face.h"
#include "geometry/segment_geometry.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// Contacts are looked for this far beyond where they are expected, in radii: velocities change during a substep.
constexpr double spare_reach = 0.1;
/// [radii] A smooth cable through the nodes bulges out over round obstacles, where straight segments cut in: at least so much,
/// of what is straight, is not counted as contact between nodes. What has edges always takes the most: nothing rolls on it.
constexpr double least_bulge = 2e-3;
/// So far from an attachment to what holds the cable it is not pushed by it [m]: the first few centimetres.
constexpr double anchored_length = 0.05;
/// A cable on a body that leans more has the friction of a smooth surface.
constexpr double smallest_lean = 0.05;
/// Relative, of distances.
constexpr double distance_rounding = 1e-6;
/// From a node to the nodes next to it, by keys.
constexpr std::uint64_t neighbouring_places = places;
/// Faces that are narrower than this, in radii, are part of what is round.
constexpr double narrowest_face = 0.25;
/// Deeper than this, in radii, nothing that touches a surface from outside gets: it is inside.
constexpr double deepest_touch = 0.5;

double stopping(const SimulatedCable& cable, int segment, double time_step) {
  return stopping_stiffness(cable.state.rest_lengths[segment] * CableMaterials(cable)[segment].linear_density, time_step);
}

/// Puts a point of the centre line where the cable touches: so far beside it [m], against the normal. Below 0 it stays; so it
/// does where the cable stands on its end.
void put_beside(const CableState& state, const Vector3& normal, double distance, CablePoint& point) {
  const int i = point.segment;
  const std::vector<Vector3>& x = state.positions;
  const bool on_joint = point.fraction == 0 && i > 0;
  const Vector3 direction = on_joint ? way_past(state, i).normalized() : segment_direction(state, i);
  const double steep = normal.dot(direction), steep_square = steep * steep;
  const Vector3 along = direction - steep * normal;
  if (!(distance > 0) || along.isZero(0)) return;
  const double beside = distance * (1 - steep_square * steep_square) * (on_joint ? 0.5 : 1);
  point.along = along.normalized();
  point.across = (normal - steep * direction).normalized();
  point.own = beside / (x[i + 1] - x[i]).norm();
  if (on_joint) point.before = beside / (x[i] - x[i - 1]).norm();
}

/// Of a place [m], in the axes of an obstacle's shape at the start.
Vector3 in_shape(const MovingObstacle& moving, const Vector3& place) {
  return moving.start.orientation.conjugate() * (place - moving.start.position);
}

/// Friction of a cable acts on its centre line, which obstacles carry along as if joined to it: that is in `motion`. One that
/// turns slides besides, at the point beside that line, under a cable that does not turn with it: adds that, along the surface.
void turn_under(const MovingObstacle& moving, const CableState& state, const CablePoint& beside, SurfaceMotion& motion) {
  if (beside.own == 0) return;
  const int first = beside.before == 0 ? beside.segment : beside.segment - 1;
  std::array<SurfaceMotion, 3> nodes;
  for (int i = first; i <= beside.segment + 1; ++i)
    nodes[i - first] = surface_motion(moving, in_shape(moving, state.positions[i]));
  const double rate = carried_along(beside, [&](int i) -> const Vector3& { return nodes[i - first].end_velocity; });
  if (rate == 0) return;
  const double own_rate = carried_along(beside, [&](int i) -> const Vector3& { return state.velocities[i]; });
  const Vector3 slips = (1 - std::clamp(own_rate / rate, 0.0, 1.0)) * beside.along;
  motion.displacement += carried_along(beside, [&](int i) -> const Vector3& { return nodes[i - first].displacement; }) * slips;
  motion.end_velocity += rate * slips;
}

/// A node as a point of a segment.
CablePoint node_point(int cable, int node, int segments) {
  return node < segments ? CablePoint{cable, node, 0.0} : CablePoint{cable, node - 1, 1.0};
}

/// Whether a touch was this in the last substep. A cable that slides over an edge touches the obstacle with one element after the
/// other.
bool continues(const CachedContact& last, const Touch& touch) {
  if (last.key != touch.key) return false;
  const std::uint64_t reach = touch.other.cable < 0 ? neighbouring_places : 0;
  return std::max(last.other_key, touch.other_key) - std::min(last.other_key, touch.other_key) <= reach;
}

/// Whether what touches bore a force in the substep before. Without that it goes where the cable's own forces take it, which its
/// velocity does not tell.
bool bore(const ContactCache& cache, std::uint64_t key, std::uint64_t other_key) {
  const CachedContact* const last = find_cached(cache, key, other_key);
  return last != nullptr && last->mode != Touch::Mode::open;
}

/// [m] By how much a smooth cable through the nodes of a segment bulges out along a normal: twice the arc's height, so that nodes
/// bear what lies around a round obstacle.
double bulge_of(const CableState& state, int segment, const Vector3& normal) {
  const int before = std::max(segment - 1, 0), after = std::min(segment + 1, state.segments() - 1);
  const double turned =
      after > before ? (segment_direction(state, before) - segment_direction(state, after)).dot(normal) / (after - before) : 0;
  const double length = (state.positions[segment + 1] - state.positions[segment]).norm();
  return 0.25 * length * turned;
}

/// Tells a touch of a cable that may roll in which direction (of any length), and by which part of friction that is resisted.
void let_roll(double part, const Vector3& across, Touch& touch) {
  const double size = across.norm();
  if (part < 1 && size > 0) touch.rolling[touch.rolling_count++] = {across / size, part};
}

/// A cable with torsional stiffness rolls as its twist lets it.
double rolling_part(const MaterialDesc& material) {
  return material.torsional_stiffness > 0 ? 1 : material.rolling_friction;
}

bool apart(const Vector3& least, const Vector3& largest, const Aabb& box, double reach) {
  return (largest.array() + reach < box.min().array()).any() || (least.array() - reach > box.max().array()).any();
}

}  // namespace

bool is_anchored(const CableState& state, const KinematicTargets& targets, const CablePoint& point, const Obstacle& obstacle,
                 const std::vector<Attachment>& attachments) {
  if (obstacle.holders.empty()) return false;
  const double length = state.rest_lengths[point.segment];
  for (const KinematicTarget& target : targets.nodes) {
    const Attachment& attachment = attachments[target.attachment];
    if (attachment.node != target.node || !is_joined_to(obstacle, attachment.frame)) continue;
    const double distance = attachment.node <= point.segment
                                ? state.length(attachment.node, point.segment) + point.fraction * length
                                : state.length(point.segment, attachment.node) - point.fraction * length;
    if (distance <= anchored_length) return true;
  }
  return false;
}

void ContactSet::find(const std::vector<SimulatedCable>& cables, const std::vector<int>& island,
                      const std::vector<ContactMember>& members, const std::vector<MovingObstacle>& obstacles,
                      const std::vector<MovingObstacle>& bodies, const std::vector<Attachment>& attachments,
                      const ContactRules& rules, double h, SegmentPairs& pairs) {
  rules_ = rules;
  time_ = rules.still ? 0 : contact_time(rules.time_step);
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
    set_held(cable, *members[k].targets, attachments);
    stretches_.update(cable);
    first_of_cable_ = touches_.size();
    for (const MovingObstacle& obstacle : obstacles) find_obstacle(cable, island[k], members[k], obstacle, attachments, h);
    if (!bodies.empty()) find_bodies(cable, island[k], members[k], bodies, attachments, h);
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
  grid_.update(cables, island, rules.pairs, reach(0, radius, h) + radius, h, pairs);
  find_pairs(cables, members, pairs, radius, h);
}

void ContactSet::find_joined(const std::vector<Attachment>& attachments, const std::vector<ContactMember>& members) {
  joined_.clear();
  for (const ContactMember& member : members)
    for (const KinematicTarget& target : member.targets->nodes) {
      const Attachment& attachment = attachments[target.attachment];
      if (attachment.is_junction) joined_.push_back({attachment.body.index, attachment.node, attachment.holder});
    }
}

/// Which nodes are attached: nothing but their holders moves them. What joins cables is moved by them.
void ContactSet::set_held(const SimulatedCable& cable, const KinematicTargets& targets,
                          const std::vector<Attachment>& attachments) {
  held_.assign(cable.state.nodes(), 0);
  for (const KinematicTarget& target : targets.nodes)
    if (attachments[target.attachment].node == target.node && !attachments[target.attachment].is_junction) held_[target.node] = 1;
}

/// `bodies`: the shapes of one after those of the other.
void ContactSet::find_bodies(const SimulatedCable& cable, int index, const ContactMember& member,
                             const std::vector<MovingObstacle>& bodies, const std::vector<Attachment>& attachments, double h) {
  const MovingObstacle *first = bodies.data(), *const end = first + bodies.size();
  while (first != end) {
    const MovingObstacle* const last =
        std::find_if(first, end, [&](const MovingObstacle& other) { return other.body != first->body; });
    set_inside(cable, *member.targets, first, last, attachments);
    for (; first != last; ++first) find_obstacle(cable, index, member, *first, attachments, h);
  }
}

/// A cable that a body holds inside of its shapes comes out of them as it likes.
void ContactSet::set_inside(const SimulatedCable& cable, const KinematicTargets& targets, const MovingObstacle* first,
                            const MovingObstacle* last, const std::vector<Attachment>& attachments) {
  const CableState& state = cable.state;
  const int elements = 2 * state.segments() + 1;
  inside_.assign(elements, 0);
  const auto is_inside = [&](int node) {
    return std::any_of(first, last, [&](const MovingObstacle& shape) {
      return closest_point(shape.obstacle->shape, in_shape(shape, state.positions[node]), 0).distance < 0;
    });
  };
  for (const KinematicTarget& target : targets.nodes) {
    if (attachments[target.attachment].frame != first->obstacle->holders.front() || !is_inside(target.node)) continue;
    for (const int way : {-1, 1})
      for (int element = 2 * target.node; element >= 0 && element < elements; element += way) {
        if (element % 2 == 0 && !is_inside(element / 2)) break;
        inside_[element] = 1;
      }
  }
}

void ContactSet::find_obstacle(const SimulatedCable& cable, int index, const ContactMember& member, const MovingObstacle& moving,
                               const std::vector<Attachment>& attachments, double h) {
  const auto reach_at = [&](double radius, double speed) {
    return radius + moving.obstacle->padding + reach(speed + moving.speed, radius, h);
  };
  const auto is_far = [&](const Stretch& stretch) {
    return apart(stretch.box.min(), stretch.box.max(), moving.box, reach_at(stretch.radius, stretch.speed));
  };
  const std::vector<Stretch>& stretches = stretches_.all();
  if (std::all_of(stretches.begin(), stretches.end(), is_far)) return;
  const CableMaterials materials(cable);
  const CableState& state = cable.state;
  const int n = state.segments();
  const Eigen::Matrix3d orientation = moving.start.orientation.toRotationMatrix();
  const Shape& shape = moving.obstacle->shape;
  const bool flat = std::holds_alternative<PlaneShape>(shape);
  const bool has_edges = std::holds_alternative<BoxShape>(shape) || std::holds_alternative<MeshShape>(shape);
  const double least = has_edges ? largest_bulge : least_bulge;

  const auto visit = [&](int i, double far) {
    local_[i] = orientation.transpose() * (state.positions[i] - moving.start.position);
    nearest_[i] = closest_point(shape, local_[i], far);
  };
  bool cuts = false;  // whether segments touch, not only nodes
  const auto node_friction = [&](int i) {
    return materials.mean_at(i, [](const MaterialDesc& material) { return material.friction; });
  };
  const bool is_body = moving.body >= 0, moves = !is_body && moving.speed > 0, turns = moving.half_turn.w() != 1;
  // `share` of the force, where the node beside it, at its distance, has the rest.
  const auto touch_at = [&](const CablePoint& point, int place, Place where, const SurfacePoint& nearest, double share = 1,
                            double node_distance = infinity) {
    const bool on_node = where == Place::node;
    const double radius = on_node ? stretches_.radius(place) : materials[place].radius;
    const double gap = nearest.distance - (radius + moving.obstacle->padding);
    const Vector3 normal = orientation * nearest.normal;
    const Vector3 position = on_centre_line(point, state.positions), velocity = on_centre_line(point, state.velocities);
    SurfaceMotion motion;
    if (moves) motion = touching_motion(moving, in_shape(moving, position), normal, h);
    const Vector3 other_velocity = is_body ? moving.body_velocity.at(position) : Vector3(motion.displacement / h);
    const std::uint64_t key = is_body ? body_key | key_of(moving.body, moving.obstacle->id) : moving.obstacle->id;
    const std::uint64_t other_key = place_key(place, where);
    if (!may_close(gap, normal, velocity - other_velocity, radius, h) && !bore(*member.cache, key, other_key)) return;
    if (is_body && inside_[2 * place + (on_node ? 0 : 1)] != 0) return;
    if (is_anchored(state, *member.targets, point, *moving.obstacle, attachments)) return;
    // What turns carries a point beside the centre line along the surface, too.
    CablePoint beside = point;
    if (is_body || turns) put_beside(state, normal, std::min(radius, nearest.distance - moving.obstacle->padding), beside);
    if (moves) turn_under(moving, state, beside, motion);
    Touch touch;
    touch.key = key;
    touch.other_key = other_key;
    touch.point = is_body ? beside : point;
    touch.obstacle = moving.index;
    touch.body = moving.body;
    touch.normal = normal;
    touch.gap = gap;
    const double friction = moving.obstacle->friction.value_or(on_node ? node_friction(place) : materials[place].friction);
    touch.friction = friction;
    const double rolling = on_node ? materials.mean_at(place, rolling_part) : rolling_part(materials[place]);
    let_roll(rolling, normal.cross(on_node ? way_past(state, place) : segment_direction(state, place)), touch);
    touch.radius = radius;
    touch.base_stiffness = stopping(cable, point.segment, rules_.time_step);
    touch.velocity = velocity;
    touch.other_motion = motion;
    touch.half_turn = moving.half_turn;
    touch.position = position;
    if (is_body) {
      touch.base_stiffness = std::min(touch.base_stiffness, stopping_stiffness(moving.body_mass, rules_.time_step));
      touch.velocity =
          at_point(beside, [&](int i) -> Vector3 { return state.velocities[i] - moving.body_velocity.at(state.positions[i]); });
      touch.body_acceleration = at_point(beside, [&](int i) { return moving.body_acceleration.at(state.positions[i]); });
    }
    if (gap < 0)
      share *= 1 - force_of_depth(radius + moving.obstacle->padding - node_distance, touch) / force_of_depth(-gap, touch);
    if (!(share > 0)) return;
    touch.share = share;
    if (is_body) touches_body_[places_[index]] = 1;
    cuts = cuts || !on_node;
    feet_.push_back(nearest.point);
    touches_.push_back(touch);
    add(touches_.back(), member, h);
  };

  const std::size_t first_touch = touches_.size();
  feet_.clear();
  local_.resize(n + 1);
  nearest_.resize(n + 1);
  const bool has_sections = materials.any(has_section);
  parts_.clear();
  if (has_sections) node_touches_.assign(n + 1, -1);
  // The index of what is added meanwhile, if it is one.
  const auto added = [&](const auto& add) {
    const std::size_t before = touches_.size();
    add();
    return touches_.size() > before ? static_cast<int>(before) : -1;
  };
  const auto touch_node = [&](int i) {
    if (held_[i] != 0) return;
    const int touch = added([&] { touch_at(node_point(index, i, n), i, Place::node, nearest_[i]); });
    if (has_sections) node_touches_[i] = touch;
  };
  const auto pressed_at = [&](int i, double fraction) {
    PressedPart part = part_within(shape, local_[i], local_[i + 1], fraction, materials[i].radius + moving.obstacle->padding);
    part.segment = i;
    part.first = nearest_[i].distance;
    part.second = nearest_[i + 1].distance;
    part.is_straight = has_edges;
    part.is_over_face = nearest_[i].normal.dot(nearest_[i + 1].normal) >= same_normal;
    return part;
  };
  bool last = false;  // whether the segment before is close: its nodes have been visited
  for (const Stretch& stretch : stretches) {
    if (is_far(stretch)) {
      if (last) touch_node(stretch.first);
      last = false;
      continue;
    }
    double next_reach = reach_at(stretches_.radius(stretch.first), stretches_.speed(stretch.first));
    for (int i = stretch.first; i < stretch.end; ++i) {
      const double own_reach = next_reach;
      next_reach = reach_at(stretches_.radius(i + 1), stretches_.speed(i + 1));
      const double far = std::max(own_reach, next_reach);
      const Vector3 &start = state.positions[i], &end = state.positions[i + 1];
      const bool close = !apart(start.cwiseMin(end), start.cwiseMax(end), moving.box, far);
      const double length = close ? (end - start).norm() : 0;
      if (close && !last) visit(i, far + length);
      if (close) visit(i + 1, far + length);
      if (close || last) touch_node(i);
      last = close;
      if (!close || held_[i] != 0 || held_[i + 1] != 0) continue;
      const double first = nearest_[i].distance, second = nearest_[i + 1].distance;
      if (has_sections) parts_.push_back(pressed_at(i, first < second ? 0 : 1));
      if (flat) continue;
      if (0.5 * (first + second - length) > far) continue;
      // Where it is nowhere deeper than this, nodes bear it.
      const double radius = materials[i].radius, shallow = std::max(first, second) - (has_edges ? 0 : least * radius);
      SegmentSurfacePoint deepest = deepest_point(shape, local_[i], local_[i + 1], std::min(far, shallow));
      if (deepest.surface.distance >= std::min(far, shallow)) continue;
      // A face presses on what it covers of the cable, and on one segment's length more: on the nodes over it, and where it
      // begins and ends, with the part of the segment there that goes on inside. So the sum is the same wherever nodes are, and a
      // place that passes a node passes its force on.
      std::optional<PartOverFace> part;
      if (nearest_[i].normal.dot(nearest_[i + 1].normal) < same_normal)
        part = part_over_face(shape, local_[i], local_[i + 1], deepest, narrowest_face * radius);
      const bool begins = part && part->begin.fraction > 0 && part->begin.surface.distance > 0;
      const bool ends = part && part->end.fraction < 1 && part->end.surface.distance > 0;
      const double arc = bulge_of(state, i, orientation * deepest.surface.normal);
      const double bulge = std::clamp(arc, least * radius, largest_bulge * radius);
      // The more it is bent over an edge, deeper there than where the face ends or bulging out, the more it is pushed out where
      // it is deepest instead, by the edge.
      double flat = 0;
      if (begins || ends) {
        const double lowest = std::min(part->begin.surface.distance, part->end.surface.distance);
        flat = std::clamp(1 - (lowest - deepest.surface.distance + arc) / (largest_bulge * radius), 0.0, 1.0);
      }
      // Less by what the node behind the edge presses with.
      const auto touch_end = [&](const SegmentSurfacePoint& end, Place where, double inside, double node_distance) {
        return added([&] { touch_at({index, i, end.fraction}, i, where, end.surface, flat * inside, node_distance); });
      };
      const int at_begin = begins ? touch_end(part->begin, Place::face_begins, 1 - part->begin.fraction, first) : -1;
      const double cut = first + deepest.fraction * (second - first) - deepest.surface.distance;
      int at_deepest = -1;
      if (cut > bulge && flat < 1) {
        deepest.surface.distance += bulge;
        at_deepest = added([&] { touch_at({index, i, deepest.fraction}, i, Place::deepest, deepest.surface, 1 - flat); });
      }
      const int at_end = ends ? touch_end(part->end, Place::face_ends, part->end.fraction, second) : -1;
      if (!has_sections) continue;
      PressedPart& pressed = parts_.back() = pressed_at(i, deepest.fraction);
      pressed.flat = flat;
      pressed.is_over_face = pressed.is_over_face || part.has_value();
      pressed.begins = at_begin;
      pressed.deepest = at_deepest;
      pressed.ends = at_end;
      if (begins) pressed.from = std::max(pressed.from, part->begin.fraction);
      if (ends) pressed.to = std::min(pressed.to, part->end.fraction);
    }
  }
  if (last) touch_node(n);
  if (has_sections) set_pressed_lengths(materials, state, parts_, node_touches_, first_touch, feet_, touches_);
  if (cuts)
    bound_friction_at_corners(state, first_touch, feet_, touches_, pressed_);
  else
    bound_friction_of_nodes(state, first_touch, flat, touches_);
  if (is_body) {
    // What leans may do work on what gives way.
    const double friction = *moving.obstacle->friction;
    for (std::size_t k = first_touch; k < touches_.size(); ++k) {
      touches_[k].friction = touches_[k].lean.norm() > smallest_lean ? friction : std::min(friction, touches_[k].friction);
      touches_[k].lean.setZero();
    }
  }
  keep_nearest_obstacles(first_of_cable_, 2 * n + 1, touches_);
}

void ContactSet::find_pairs(const std::vector<SimulatedCable>& cables, const std::vector<ContactMember>& members,
                            const SegmentPairs& found, double thickest, double h) {
  const auto is_of = [](const SegmentId& segment, const SegmentPairs::Pair& pair) {
    return pair.first.cable == segment.cable && pair.first.segment == segment.segment;
  };
  for (auto pair = found.pairs.begin(); pair != found.pairs.end();) {
    const SegmentId segment = pair->first;
    near_.clear();
    for (; pair != found.pairs.end() && is_of(segment, *pair); ++pair) {
      const double speed = found.speeds[pair->first_node] + found.speeds[pair->second_node];
      const double moved = found.moved[pair->first_node] + found.moved[pair->second_node];
      if (pair->distance - moved > (2 * thickest + reach(speed, thickest, h)) * (1 + distance_rounding)) continue;
      if (can_touch(cables, joined_, *pair)) look_at(cables, members, *pair, speed, h);
    }
    const SimulatedCable& cable = cables[segment.cable];
    const double radius = CableMaterials(cable)[segment.segment].radius;
    keep_nearest_pairs(room_around(radius, cable.state.rest_lengths[segment.segment], thinnest_, shortest_), near_);
    for (const NearPair& near : near_) add_pair(cables, members, near, h);
  }
}

/// Whether the segments of a pair may touch: then it is one of `near_`.
void ContactSet::look_at(const std::vector<SimulatedCable>& cables, const std::vector<ContactMember>& members,
                         const SegmentPairs::Pair& pair, double speed, double h) {
  const SimulatedCable &a = cables[pair.first.cable], &b = cables[pair.second.cable];
  const int i = pair.first.segment, j = pair.second.segment;
  const double first_radius = CableMaterials(a)[i].radius, second_radius = CableMaterials(b)[j].radius;
  const double radius = std::min(first_radius, second_radius), surface = first_radius + second_radius;
  const double far = surface + reach(speed, radius, h);
  const Vector3 &a0 = a.state.positions[i], &b0 = b.state.positions[j];
  const Vector3 along_a = a.state.positions[i + 1] - a0, along_b = b.state.positions[j + 1] - b0;
  const ClosestPoints closest = closest_points(a0, along_a, b0, along_b);
  const double distance = closest.between.norm();
  if (distance > far) return;
  const Vector3 normal = distance > 0 ? Vector3(closest.between / distance) : along_a.unitOrthogonal();
  const CablePoint first{pair.first.cable, i, closest.first}, second{pair.second.cable, j, closest.second};
  const Vector3 velocity = on_centre_line(first, a.state.velocities) - on_centre_line(second, b.state.velocities);
  const std::uint64_t key = pair_key | i, other_key = key_of(members[places_[pair.second.cable]].id, j);
  if (!may_close(distance - surface, normal, velocity, radius, h) &&
      !bore(*members[places_[pair.first.cable]].cache, key, other_key))
    return;
  near_.push_back({first, second, normal, distance - surface, radius, key, other_key});
}

void ContactSet::add_pair(const std::vector<SimulatedCable>& cables, const std::vector<ContactMember>& members,
                          const NearPair& near, double h) {
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
  touch.base_stiffness = std::min(stopping(a, i, rules_.time_step), stopping(b, j, rules_.time_step));
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
  add(touch, members[places_[near.first.cable]], h);
}

void ContactSet::add(Touch& touch, const ContactMember& member, double h) {
  const double gentle = gentle_gap(touch.radius, contact_time(rules_.time_step));
  const bool known = recall(member, touch);
  if (touch.obstacle >= 0 && touch.gap < -deepest_touch * touch.radius)
    note({touch.point.cable, touch.point.segment, touch.obstacle, -touch.gap});
  touch.inside = (!known || touch.inside) && touch.gap < gentle;
  touch.inside_for = touch.inside ? touch.inside_for + h : 0;
  if (touch.inside) touch.gap = gentle;
  touch.yields = touch.inside && touch.other.cable >= 0;
  anticipate(Scheme::conserving, h, time_, Vector3::Zero(), touch);
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

/// Whether a gap [m] may close, at a `velocity` [m/s] relative to what is touched.
bool ContactSet::may_close(double gap, const Vector3& normal, const Vector3& velocity, double radius, double h) const {
  return gap < reach(std::max(0.0, -normal.dot(velocity)), radius, h);
}

/// How far [m] from a surface contact may matter in a substep, at a velocity of approach [m/s].
double ContactSet::reach(double speed, double radius, double h) const {
  if (rules_.still) return (1 + spare_reach) * radius;
  return std::min((h + time_) * speed, radius + h * speed) + spare_reach * radius;
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
  const auto acceleration_at = [&](const CablePoint& point) -> Vector3 {
    if (point.cable < 0) return Vector3::Zero();
    return at_point(point, cables[point.cable].state.accelerations);
  };
  for (Touch& touch : touches_)
    anticipate(scheme, h, time_, acceleration_at(touch.point) - acceleration_at(touch.other) - touch.body_acceleration, touch);
}

bool ContactSet::is_stuck() const {
  return std::any_of(touches_.begin(), touches_.end(), is_pushed_out);
}

void ContactSet::keep(const std::vector<ContactMember>& members) const {
  for (const ContactMember& member : members) member.cache->clear();
  for (const Touch& touch : touches_) members[places_[touch.point.cable]].cache->push_back(kept(touch));
}

}  // namespace verlet_cable
