#include "contact/obstacle_touches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "chain/direction.h"
#include "chain/point_motion.h"
#include "contact/friction_bound.h"
#include "contact/new_touch.h"
#include "contact/smooth_cable.h"
#include "geometry/segment_geometry.h"

namespace verlet_cable {

namespace {

/// [radii] A smooth cable through the nodes bulges out over round obstacles, where straight segments cut in: at least so much,
/// of what is straight, is not counted as contact between nodes. What has edges always takes the most: nothing rolls on it.
constexpr double least_bulge = 2e-3;
/// So far from an attachment to what holds the cable it is not pushed by it [m]: the first few centimetres.
constexpr double anchored_length = 0.05;
/// A cable on a body that leans more has the friction of a smooth surface.
constexpr double smallest_lean = 0.05;
/// Faces that are narrower than this, in radii, are part of what is round.
constexpr double narrowest_face = 0.25;

/// Of a place [m], in the axes of an obstacle's shape at the start.
Vector3 in_shape(const MovingObstacle& moving, const Vector3& place) {
  return moving.start.orientation.conjugate() * (place - moving.start.position);
}

/// Which part of an obstacle's turn a cable turns with it, where it touches beside its centre line. `joined`: how nodes from
/// `first` on would move if they were joined to it. Where a cable comes to lie on a drum, the segment that lies on it turns with
/// it, and the next one does not yet: that is not touched. What turns by half as much or more is on its way to lie on it, and
/// does not slide: else each node that a stiff rope lays down would drag the rope by all the friction it has.
double turned_along(const CablePoint& beside, const std::array<SurfaceMotion, 3>& joined, int first, const CableState& state) {
  double most = 0;
  for (int segment = first; segment <= beside.segment; ++segment) {
    const double of_obstacle = beside.across.dot(joined[segment + 1 - first].end_velocity - joined[segment - first].end_velocity);
    if (of_obstacle != 0)
      most = std::max(most, beside.across.dot(state.velocities[segment + 1] - state.velocities[segment]) / of_obstacle);
  }
  return std::min(2 * most, 1.0);
}

/// Friction of a cable acts on its centre line, which obstacles carry along as if joined to it: that is in `motion`. One that
/// turns slides besides, at the point beside that line, under a cable that does not turn with it: adds that, along the surface.
void turn_under(const MovingObstacle& moving, const CableState& state, const CablePoint& beside, SurfaceMotion& motion) {
  if (beside.own == 0) return;
  const int first = beside.before == 0 ? beside.segment : beside.segment - 1;
  std::array<SurfaceMotion, 3> nodes;
  for (int i = first; i <= beside.segment + 1; ++i)
    nodes[i - first] = surface_motion(moving, in_shape(moving, state.positions[i]));
  const Vector3 slips = (1 - turned_along(beside, nodes, first, state)) * beside.along;
  motion.displacement += carried_along(beside, [&](int i) -> const Vector3& { return nodes[i - first].displacement; }) * slips;
  motion.end_velocity += carried_along(beside, [&](int i) -> const Vector3& { return nodes[i - first].end_velocity; }) * slips;
}

/// A node as a point of a segment.
CablePoint node_point(int cable, int node, int segments) {
  return node < segments ? CablePoint{cable, node, 0.0} : CablePoint{cable, node - 1, 1.0};
}

bool apart(const Vector3& least, const Vector3& largest, const Aabb& box, double reach) {
  return (largest.array() + reach < box.min().array()).any() || (least.array() - reach > box.max().array()).any();
}

bool is_flat(const MovingObstacle& moving) {
  return std::holds_alternative<PlaneShape>(moving.obstacle->shape);
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

void ObstacleTouches::begin(const SimulatedCable& cable, int index, const ContactMember& member,
                            const std::vector<Attachment>& attachments) {
  cable_ = &cable;
  index_ = index;
  member_ = &member;
  attachments_ = &attachments;
  // Nothing but their holders moves nodes that are attached. What joins cables is moved by them.
  held_.assign(cable.state.nodes(), 0);
  for (const KinematicTarget& target : member.targets->nodes)
    if (attachments[target.attachment].node == target.node && !attachments[target.attachment].is_junction) held_[target.node] = 1;
  stretches_.update(cable);
  has_sections_ = CableMaterials(cable).any(has_section);
}

void ObstacleTouches::enter_body(const MovingObstacle* first, const MovingObstacle* last) {
  const CableState& state = cable_->state;
  const int elements = 2 * state.segments() + 1;
  inside_.assign(elements, 0);
  const auto is_inside = [&](int node) {
    return std::any_of(first, last, [&](const MovingObstacle& shape) {
      return closest_point(shape.obstacle->shape, in_shape(shape, state.positions[node]), 0).distance < 0;
    });
  };
  for (const KinematicTarget& target : member_->targets->nodes) {
    if ((*attachments_)[target.attachment].frame != first->obstacle->holders.front() || !is_inside(target.node)) continue;
    for (const int way : {-1, 1})
      for (int element = 2 * target.node; element >= 0 && element < elements; element += way) {
        if (element % 2 == 0 && !is_inside(element / 2)) break;
        inside_[element] = 1;
      }
  }
}

void ObstacleTouches::meet(const MovingObstacle& moving, const ContactReach& reach) {
  moving_ = &moving;
  reach_ = &reach;
  orientation_ = moving.start.orientation.toRotationMatrix();
  const Shape& shape = moving.obstacle->shape;
  has_edges_ = std::holds_alternative<BoxShape>(shape) || std::holds_alternative<MeshShape>(shape);
  cuts_ = false;
  const int nodes = cable_->state.nodes();
  local_.resize(nodes);
  nearest_.resize(nodes);
  feet_.clear();
  parts_.clear();
  if (has_sections_) node_touches_.assign(nodes, -1);
}

/// [m] From the centre line, at a speed of the cable [m/s].
double ObstacleTouches::reach_of(double radius, double speed) const {
  return radius + moving_->obstacle->padding + reach_->at(speed + moving_->speed, radius);
}

bool ObstacleTouches::is_far(const Stretch& stretch) const {
  return apart(stretch.box.min(), stretch.box.max(), moving_->box, reach_of(stretch.radius, stretch.speed));
}

void ObstacleTouches::find(const MovingObstacle& moving, const ContactReach& reach, std::vector<Touch>& touches) {
  meet(moving, reach);
  const CableState& state = cable_->state;
  bool last = false;  // whether the segment before is close: its nodes have been visited
  for (const Stretch& stretch : stretches_.all()) {
    if (is_far(stretch)) {
      if (last) add_node(stretch.first, touches);
      last = false;
      continue;
    }
    double next_reach = reach_of(stretches_.radius(stretch.first), stretches_.speed(stretch.first));
    for (int i = stretch.first; i < stretch.end; ++i) {
      const double own_reach = next_reach;
      next_reach = reach_of(stretches_.radius(i + 1), stretches_.speed(i + 1));
      const double far = std::max(own_reach, next_reach);
      const Vector3 &start = state.positions[i], &end = state.positions[i + 1];
      const bool close = !apart(start.cwiseMin(end), start.cwiseMax(end), moving.box, far);
      const double length = close ? (end - start).norm() : 0;
      if (close && !last) visit(i, far + length);
      if (close) visit(i + 1, far + length);
      if (close || last) add_node(i, touches);
      last = close;
      if (close && held_[i] == 0 && held_[i + 1] == 0) add_segment(i, length, far, touches);
    }
  }
  if (last) add_node(state.segments(), touches);
}

void ObstacleTouches::visit(int node, double far) {
  local_[node] = orientation_.transpose() * (cable_->state.positions[node] - moving_->start.position);
  nearest_[node] = closest_point(moving_->obstacle->shape, local_[node], far);
}

void ObstacleTouches::add_node(int node, std::vector<Touch>& touches) {
  if (held_[node] != 0) return;
  const CablePoint point = node_point(index_, node, cable_->state.segments());
  const int touch = add(point, node, Place::node, nearest_[node], {}, touches);
  if (has_sections_) node_touches_[node] = touch;
}

/// What is between the nodes of a segment, of that length, where it is no further than `far` from the surface [m].
void ObstacleTouches::add_segment(int segment, double length, double far, std::vector<Touch>& touches) {
  const int i = segment;
  const Shape& shape = moving_->obstacle->shape;
  const double first = nearest_[i].distance, second = nearest_[i + 1].distance;
  if (has_sections_) parts_.push_back(pressed_at(i, first < second ? 0 : 1));
  if (is_flat(*moving_)) return;
  if (0.5 * (first + second - length) > far) return;
  // Where it is nowhere deeper than this, nodes bear it.
  const double radius = CableMaterials(*cable_)[i].radius;
  const double least = has_edges_ ? largest_bulge : least_bulge;
  const double shallow = std::max(first, second) - (has_edges_ ? 0 : least * radius);
  SegmentSurfacePoint deepest = deepest_point(shape, local_[i], local_[i + 1], std::min(far, shallow));
  if (deepest.surface.distance >= std::min(far, shallow)) return;
  // A face presses on what it covers of the cable, and on one segment's length more: on the nodes over it, and where it
  // begins and ends, with the part of the segment there that goes on inside. So the sum is the same wherever nodes are, and a
  // place that passes a node passes its force on.
  std::optional<PartOverFace> part;
  if (nearest_[i].normal.dot(nearest_[i + 1].normal) < same_normal)
    part = part_over_face(shape, local_[i], local_[i + 1], deepest, narrowest_face * radius);
  const bool begins = part && part->begin.fraction > 0 && part->begin.surface.distance > 0;
  const bool ends = part && part->end.fraction < 1 && part->end.surface.distance > 0;
  // Twice the arc's height, so that nodes bear what lies around a round obstacle.
  const double arc = 2 * arc_height(cable_->state, i).dot(orientation_ * deepest.surface.normal);
  const double bulge = std::clamp(arc, least * radius, (has_edges_ ? largest_bulge : largest_arc) * radius);
  // The more it is bent over an edge, deeper there than where the face ends or bulging out, the more it is pushed out where
  // it is deepest instead, by the edge.
  double flat = 0;
  if (begins || ends) {
    const double lowest = std::min(part->begin.surface.distance, part->end.surface.distance);
    flat = std::clamp(1 - (lowest - deepest.surface.distance + arc) / (largest_bulge * radius), 0.0, 1.0);
  }
  // Less by what the node behind the edge presses with.
  const auto add_end = [&](const SegmentSurfacePoint& end, Place where, double inside, double node_distance) {
    return add({index_, i, end.fraction}, i, where, end.surface, {flat * inside, node_distance}, touches);
  };
  const int at_begin = begins ? add_end(part->begin, Place::face_begins, 1 - part->begin.fraction, first) : -1;
  const double cut = first + deepest.fraction * (second - first) - deepest.surface.distance;
  int at_deepest = -1;
  if (cut > bulge && flat < 1) {
    deepest.surface.distance += bulge;
    at_deepest = add({index_, i, deepest.fraction}, i, Place::deepest, deepest.surface, {1 - flat}, touches);
  }
  const int at_end = ends ? add_end(part->end, Place::face_ends, part->end.fraction, second) : -1;
  if (!has_sections_) return;
  PressedPart& pressed = parts_.back() = pressed_at(i, deepest.fraction);
  pressed.flat = flat;
  pressed.is_over_face = pressed.is_over_face || part.has_value();
  pressed.begins = at_begin;
  pressed.deepest = at_deepest;
  pressed.ends = at_end;
  if (begins) pressed.from = std::max(pressed.from, part->begin.fraction);
  if (ends) pressed.to = std::min(pressed.to, part->end.fraction);
}

PressedPart ObstacleTouches::pressed_at(int segment, double fraction) const {
  const int i = segment;
  const double reach = CableMaterials(*cable_)[i].radius + moving_->obstacle->padding;
  PressedPart part = part_within(moving_->obstacle->shape, local_[i], local_[i + 1], fraction, reach);
  part.segment = i;
  part.first = nearest_[i].distance;
  part.second = nearest_[i + 1].distance;
  part.is_straight = has_edges_;
  part.is_over_face = nearest_[i].normal.dot(nearest_[i + 1].normal) >= same_normal;
  return part;
}

/// The index of the touch; -1: none, it is far, or leaves, or is let through. `place`: the node or the segment.
int ObstacleTouches::add(const CablePoint& point, int place, Place where, const SurfacePoint& nearest, const Sharing& sharing,
                         std::vector<Touch>& touches) {
  const MovingObstacle& moving = *moving_;
  const Obstacle& obstacle = *moving.obstacle;
  const CableMaterials materials(*cable_);
  const CableState& state = cable_->state;
  const bool on_node = where == Place::node, is_body = moving.body >= 0, moves = !is_body && moving.speed > 0;
  const double radius = on_node ? stretches_.radius(place) : materials[place].radius;
  const double gap = nearest.distance - (radius + obstacle.padding);
  const Vector3 normal = orientation_ * nearest.normal;
  const Vector3 position = on_centre_line(point, state.positions), velocity = on_centre_line(point, state.velocities);
  SurfaceMotion motion;
  if (moves) motion = touching_motion(moving, in_shape(moving, position), normal, reach_->h());
  const Vector3 other_velocity = is_body ? moving.body_velocity.at(position) : Vector3(motion.displacement / reach_->h());
  const std::uint64_t key = is_body ? body_key | key_of(moving.body, obstacle.id) : obstacle.id;
  const std::uint64_t other_key = place_key(place, where);
  if (!reach_->closes(gap, normal, velocity - other_velocity, radius) && !bore(*member_->cache, key, other_key)) return -1;
  if (is_body && inside_[2 * place + (on_node ? 0 : 1)] != 0) return -1;
  if (is_anchored(state, *member_->targets, point, obstacle, *attachments_)) return -1;
  // What turns carries a point beside the centre line along the surface, too.
  CablePoint beside = point;
  if (is_body || moving.half_turn.w() != 1)
    put_beside(state, normal, std::min(radius, nearest.distance - obstacle.padding), beside);
  if (moves) turn_under(moving, state, beside, motion);
  Touch touch;
  touch.key = key;
  touch.other_key = other_key;
  touch.point = is_body ? beside : point;
  touch.obstacle = moving.index;
  touch.body = moving.body;
  touch.normal = normal;
  touch.gap = gap;
  const auto friction_of = [](const MaterialDesc& material) { return material.friction; };
  const auto of_material = [&](const auto& property) {
    return on_node ? materials.mean_at(place, property) : property(materials[place]);
  };
  touch.friction = obstacle.friction ? *obstacle.friction : of_material(friction_of);
  let_roll(of_material(rolling_part), normal.cross(on_node ? way_past(state, place) : segment_direction(state, place)), touch);
  touch.radius = radius;
  touch.base_stiffness = stopping_stiffness_of(*cable_, point.segment, reach_->time_step());
  touch.velocity = velocity;
  touch.other_motion = motion;
  touch.half_turn = moving.half_turn;
  touch.position = position;
  if (is_body) set_motion_of_body(beside, touch);
  double share = sharing.share;
  if (gap < 0)
    share *= 1 - force_of_depth(radius + obstacle.padding - sharing.node_distance, touch) / force_of_depth(-gap, touch);
  if (!(share > 0)) return -1;
  touch.share = share;
  cuts_ = cuts_ || !on_node;
  feet_.push_back(nearest.point);
  touches.push_back(touch);
  return static_cast<int>(touches.size()) - 1;
}

void ObstacleTouches::set_motion_of_body(const CablePoint& beside, Touch& touch) const {
  const CableState& state = cable_->state;
  touch.base_stiffness = std::min(touch.base_stiffness, stopping_stiffness(moving_->body_mass, reach_->time_step()));
  touch.velocity =
      at_point(beside, [&](int i) -> Vector3 { return state.velocities[i] - moving_->body_velocity.at(state.positions[i]); });
  touch.body_acceleration = at_point(beside, [&](int i) { return moving_->body_acceleration.at(state.positions[i]); });
}

void ObstacleTouches::share(std::size_t first, std::vector<Touch>& touches) {
  const CableState& state = cable_->state;
  if (has_sections_) set_pressed_lengths(CableMaterials(*cable_), state, parts_, node_touches_, first, feet_, touches);
  if (cuts_)
    bound_friction_at_corners(state, first, feet_, touches, pressed_);
  else
    bound_friction_of_nodes(state, first, is_flat(*moving_), touches);
  if (moving_->body < 0) return;
  // What leans may do work on what gives way.
  const double friction = *moving_->obstacle->friction;
  for (std::size_t k = first; k < touches.size(); ++k) {
    touches[k].friction = touches[k].lean.norm() > smallest_lean ? friction : std::min(friction, touches[k].friction);
    touches[k].lean.setZero();
  }
}

}  // namespace verlet_cable
