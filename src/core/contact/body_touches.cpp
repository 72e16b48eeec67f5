#include "contact/body_touches.h"

#include <algorithm>

#include "contact/body_surfaces.h"

namespace verlet_cable {

namespace {

/// [m/s] What starts inside an obstacle is pushed out at about this.
constexpr double gentle_velocity = 0.2;
/// What has come further into an obstacle than these many substeps at its speed, and roundings, was there from the start.
constexpr double arrival_substeps = 2, arrival_roundings = 4;
/// [m/s^2] That bodies may be accelerated with besides their last acceleration.
constexpr double spare_acceleration = 100;
constexpr std::uint64_t obstacle_feature = std::uint64_t{1} << 31;
/// The middle of a shape: the last of all features.
constexpr std::uint64_t middle_feature = (std::uint64_t{1} << 32) - 1;

Vector3 at(const Pose& pose, const Vector3& point) {
  return pose.position + pose.orientation * point;
}

bool is_held_by(int body, const Obstacle& obstacle, const std::vector<int>& held, const std::vector<Attachment>& attachments) {
  return std::any_of(held.begin(), held.end(), [&](int a) {
    return attachments[a].body == rigid_body_id(body) && is_joined_to(obstacle, attachments[a].frame);
  });
}

/// The velocities that a body's points have over a substep of h [s], seen from an obstacle.
PointMotion relative_to(const MovingObstacle& moving, const PointMotion& velocity, double h) {
  const Vector3 turning = 2 / h * rotation_vector(moving.half_turn);
  const PointMotion obstacle{moving.start.position, (moving.end.position - moving.start.position) / h, turning};
  return {velocity.center, velocity.linear - obstacle.at(velocity.center), velocity.angular - turning};
}

/// What moves with such velocities for some time [s], in the axes of a pose.
PointMotion seen_from(const Pose& pose, const PointMotion& velocity, double time) {
  const Pose inside = pose.inverse();
  return {at(inside, velocity.center), inside.orientation * (time * velocity.linear),
          inside.orientation * (time * velocity.angular)};
}

}  // namespace

void BodyTouches::find(const TouchingBody& body, const std::vector<int>& held, const std::vector<Attachment>& attachments,
                       const std::vector<MovingObstacle>& obstacles, const ContactRules& rules, double h,
                       std::vector<Touch>& touches) {
  if (body.body->shapes.empty()) return;
  for (const MovingObstacle& moving : obstacles) {
    if (is_held_by(body.index, *moving.obstacle, held, attachments)) continue;
    for (std::size_t shape = 0; shape < body.body->shapes.size(); ++shape)
      find_shape(body, static_cast<int>(shape), moving, rules, h, touches);
  }
}

void BodyTouches::find_shape(const TouchingBody& touching, int index, const MovingObstacle& moving, const ContactRules& rules,
                             double h, std::vector<Touch>& touches) {
  const SimulatedBody& body = *touching.body;
  const Shape &shape = body.shapes[index].shape, &solid = moving.obstacle->shape;
  const Pose pose = body.pose * body.shapes[index].pose;
  const Aabb box = bounds(shape, pose);
  const PointMotion velocity = velocity_of(body), accelerating = acceleration_of(body, *touching.progress);
  const double size = largest_distance(box, velocity.center);
  const double time = rules.still ? 0 : contact_time(rules.time_step), rounding = rounding_of(shape);
  const double speed = rules.still ? 0 : body.velocity.norm() + size * body.angular_velocity.norm() + moving.speed;
  const double acceleration =
      touching.progress->acceleration.norm() + size * touching.progress->angular_acceleration.norm() + spare_acceleration;
  const auto reach_at = [&](double approach) {
    if (rules.still) return rounding;
    return std::min((h + time) * approach, rounding + h * approach) + rounding + rules.time_step * h * acceleration;
  };
  const double padding = moving.obstacle->padding, reach = reach_at(speed) + padding;
  const double radius = 0.5 * box.diagonal().norm();
  const Vector3 far(reach, reach, reach);
  if (!Aabb(box.min() - far, box.max() + far).intersects(moving.box)) return;
  const Pose in_obstacle = moving.start.inverse() * pose;
  const Vector3 middle = at(moving.start.inverse(), box.center());
  if (closest_point(solid, middle, radius + reach).distance >= radius + reach) return;

  const PointMotion past = relative_to(moving, velocity, h);
  const double ahead = rules.still ? 0 : h + time;

  const std::uint64_t key = moving.obstacle->id, first_key = static_cast<std::uint64_t>(index) << 32;
  const ContactCache& cache = touching.progress->contacts;
  // `surface` [m]: of the obstacle, in its axes.
  const auto add = [&](const Vector3& position, const Vector3& normal, const Vector3& surface, double gap, std::uint64_t feature,
                       bool inside) {
    SurfaceMotion motion;
    if (moving.speed > 0) motion = touching_motion(moving, surface, normal, h);
    Touch touch;
    touch.velocity = rules.still ? Vector3::Zero() : velocity.at(position);
    const double approach = std::max(0.0, normal.dot(motion.displacement / h - touch.velocity));
    if (!(gap < reach_at(approach))) return;
    touch.key = key;
    touch.other_key = first_key | feature;
    touch.obstacle = moving.index;
    touch.body = touching.index;
    touch.position = position;
    touch.normal = normal;
    touch.gap = gap;
    touch.friction = moving.obstacle->friction.value_or(body.friction);
    touch.radius = rounding;
    touch.base_stiffness = stopping_stiffness(mass_at(body, position, normal), rules.time_step);
    touch.body_acceleration = accelerating.at(position);
    touch.other_motion = motion;
    touch.half_turn = moving.half_turn;
    if (const CachedContact* last = find_cached(cache, key, touch.other_key)) go_on_from(*last, touch);
    touch.inside = inside;
    anticipate(Scheme::conserving, h, time, Vector3::Zero(), touch);
    start_touch(touch);
    if (rules.still) hold_bound(touch.last_force, touch);
    touches.push_back(touch);
  };

  const Eigen::Matrix3d axes = moving.start.orientation.toRotationMatrix();
  const bool is_sphere = std::holds_alternative<SphereShape>(shape), on_sphere = std::holds_alternative<SphereShape>(solid);
  found_.clear();
  if (is_sphere || !on_sphere) {
    const FeatureSearch search{reach, padding, seen_from(moving.start, past, ahead)};
    find_feature_contacts(shape, rounding, in_obstacle, solid, 0, search, found_);
  }
  found_on_obstacle_.clear();
  if (!is_sphere) {
    const FeatureSearch search{reach, padding, seen_from(pose, past, -ahead)};
    find_feature_contacts(solid, 0, in_obstacle.inverse(), shape, rounding, search, found_on_obstacle_);
  }

  // What is inside has one way out, that of its middle: its features' own ways may be opposite ones.
  const double gentle = -gentle_velocity * contact_time(rules.time_step);
  const double arrived = -(arrival_roundings * rounding + arrival_substeps * h * (speed + h * acceleration));
  const bool was_inside = find_cached(cache, key, first_key | middle_feature) != nullptr;
  const auto is_inside = [&](const FeatureContact& found, std::uint64_t feature) {
    const double gap = found.distance - padding;
    return gap < gentle && (was_inside || (gap < arrived && find_cached(cache, key, first_key | feature) == nullptr));
  };
  const bool inside =
      std::any_of(found_.begin(), found_.end(), [&](const FeatureContact& f) { return is_inside(f, f.feature); }) ||
      std::any_of(found_on_obstacle_.begin(), found_on_obstacle_.end(),
                  [&](const FeatureContact& f) { return is_inside(f, obstacle_feature | f.feature); });
  SurfacePoint out;
  if (inside) out = closest_point(solid, middle, infinity);
  const Vector3 way_out = axes * out.normal;
  const auto add_feature = [&](const Vector3& position, const Vector3& normal, const Vector3& surface, double gap,
                               std::uint64_t feature) {
    if (!inside || (gap >= gentle && normal.dot(way_out) > 0)) add(position, normal, surface, gap, feature, false);
  };
  for (const FeatureContact& found : found_)
    add_feature(at(moving.start, found.point), axes * found.normal, found.foot + padding * found.normal, found.distance - padding,
                found.feature);
  for (const FeatureContact& found : found_on_obstacle_) {
    const Vector3 position = at(pose, found.foot), normal = pose.orientation * -found.normal;
    add_feature(position, normal, at(moving.start.inverse(), position - found.distance * normal), found.distance - padding,
                obstacle_feature | found.feature);
  }
  if (!inside) return;
  const std::size_t before = touches.size();
  add(box.center(), way_out, out.point + padding * out.normal, gentle, middle_feature, true);
  if (touches.size() == before) return;
  double deepest = 0;
  for (const std::vector<FeatureContact>* all : {&found_, &found_on_obstacle_})
    for (const FeatureContact& found : *all) deepest = std::max(deepest, padding - found.distance);
  touches.back().inside_depth = deepest;
}

void BodyTouches::follow_scheme(Scheme scheme, const ContactRules& rules, double h, std::vector<Touch>& touches) {
  for (Touch& touch : touches) anticipate(scheme, h, contact_time(rules.time_step), touch.body_acceleration, touch);
}

void BodyTouches::keep(int body, const std::vector<Touch>& touches, ContactCache& cache) {
  cache.clear();
  for (const Touch& touch : touches)
    if (touch.body == body) cache.push_back(kept(touch));
}

}  // namespace verlet_cable
