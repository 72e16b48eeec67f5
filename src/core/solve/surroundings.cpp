#include "solve/surroundings.h"

#include <algorithm>

#include "contact/obstacle_touches.h"
#include "contact/smooth_cable.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// [radii] A centre line that has come this near to a surface has gone through.
constexpr double through = 0.1;
/// [radii] A way is looked at in pieces no shorter than this.
constexpr double least_advance = 0.05;

}  // namespace

Surroundings::Surroundings(const SimulatedCable& cable, const KinematicTargets& targets,
                           const std::vector<Attachment>& attachments, const std::vector<MovingObstacle>& obstacles) {
  const CableMaterials materials(cable);
  const int n = cable.state.segments();
  for (int i = 0; i < n; ++i) {
    radii_.push_back(std::max(materials[std::max(i - 1, 0)].radius, materials[i].radius));
    radii_.push_back(materials[i].radius);
  }
  radii_.push_back(materials[n - 1].radius);
  for (const MovingObstacle& moving : obstacles) {
    Solid& solid = solids_.emplace_back();
    solid.moving = &moving;
    solid.axes = moving.end.orientation.toRotationMatrix();
    solid.ignored.assign(2 * n + 1, 0);
    for (int i = 0; i < n; ++i) {
      solid.ignored[2 * i] = is_anchored(cable.state, targets, {0, i, 0.0}, *moving.obstacle, attachments);
      solid.ignored[2 * i + 1] = is_anchored(cable.state, targets, {0, i, 0.5}, *moving.obstacle, attachments);
    }
    solid.ignored[2 * n] = is_anchored(cable.state, targets, {0, n - 1, 1.0}, *moving.obstacle, attachments);
    const bool flat = std::holds_alternative<PlaneShape>(moving.obstacle->shape);
    for (int i = 0; i < n && flat; ++i) solid.ignored[2 * i + 1] = 1;
    for (const KinematicTarget& target : targets.nodes)
      for (int k = std::max(2 * target.node - 1, 0); k <= std::min(2 * target.node + 1, 2 * n); ++k) solid.ignored[k] = 1;
  }
}

Clearance Surroundings::of_node(const Solid& solid, int node, const Vector3& place) const {
  if (solid.ignored[2 * node] != 0) return {};
  const double surface = radii_[2 * node] + solid.moving->obstacle->padding;
  if (solid.moving->box.exteriorDistance(place) >= surface) return {};
  const SurfacePoint nearest =
      closest_point(solid.moving->obstacle->shape, solid.axes.transpose() * (place - solid.moving->end.position), surface);
  return {nearest.distance - surface, solid.axes * nearest.normal, 0};
}

Clearance Surroundings::of_segment(const Solid& solid, int segment, const Vector3& start, const Vector3& end) const {
  if (solid.ignored[2 * segment + 1] != 0) return {};
  const double surface = (1 - largest_bulge) * radii_[2 * segment + 1] + solid.moving->obstacle->padding;
  const Aabb box(start.cwiseMin(end), start.cwiseMax(end));
  if (solid.moving->box.exteriorDistance(box) >= surface) return {};
  const Vector3& origin = solid.moving->end.position;
  const SegmentSurfacePoint deepest = deepest_point(solid.moving->obstacle->shape, solid.axes.transpose() * (start - origin),
                                                    solid.axes.transpose() * (end - origin), surface);
  return {deepest.surface.distance - surface, solid.axes * deepest.surface.normal, deepest.fraction};
}

bool Surroundings::touches(const std::vector<Vector3>& positions) const {
  bool any = false;
  const auto note = [&](const Clearance&) { any = true; };
  for (std::size_t i = 0; i < positions.size() && !any; ++i) {
    touch_node(static_cast<int>(i), positions[i], note);
    if (i + 1 < positions.size()) touch_segment(static_cast<int>(i), positions[i], positions[i + 1], note);
  }
  return any;
}

double Surroundings::free_part(int segment, const Vector3& start, const Vector3& end, const Vector3& start_way,
                               const Vector3& end_way) const {
  double part = 1;
  for (const Solid& solid : solids_)
    if (solid.ignored[2 * segment] == 0 && solid.ignored[2 * segment + 2] == 0)
      part = free_part_of(solid, radii_[2 * segment + 1], start, end, start_way, end_way, part);
  return part;
}

double Surroundings::free_part(int node, const Vector3& start, const Vector3& way) const {
  double part = 1;
  for (const Solid& solid : solids_)
    if (solid.ignored[2 * node] == 0) part = free_part_of(solid, radii_[2 * node], start, start, way, way, part);
  return part;
}

/// No more than `part`.
double Surroundings::free_part_of(const Solid& solid, double radius, const Vector3& start, const Vector3& end,
                                  const Vector3& start_way, const Vector3& end_way, double part) {
  const double way = std::max(start_way.norm(), end_way.norm()), center = through * radius + solid.moving->obstacle->padding;
  const auto distance = [&](double at) {
    const Vector3 from = start + at * start_way, to = end + at * end_way, origin = solid.moving->end.position;
    const double far = solid.moving->box.exteriorDistance(Aabb(from.cwiseMin(to), from.cwiseMax(to)));
    if (far > center + way) return far;
    return deepest_point(solid.moving->obstacle->shape, solid.axes.transpose() * (from - origin),
                         solid.axes.transpose() * (to - origin), center + way)
        .surface.distance;
  };
  // No point gets nearer by more than it moves (Mirtich, Impulse-based dynamic simulation, 1996).
  double gone = 0, left = distance(0) - center;
  while (gone < part) {
    const double next = std::min(gone + std::max(left, least_advance * radius) / way, part);
    const double then = distance(next) - center;
    if (then < std::min(left, 0.0)) break;
    gone = next;
    left = then;
  }
  return gone;
}

}  // namespace verlet_cable
