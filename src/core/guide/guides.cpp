#include "guide/guides.h"

#include <algorithm>
#include <cmath>

#include "chain/direction.h"
#include "guide/wheel.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// Adds the weight of so much of a segment's material to a node, or takes it.
void weigh(double length, int segment, int node, const CableModel& model, CableState& cable) {
  cable.masses[node] += 0.5 * CableMaterials(model, cable)[segment].linear_density * length;
}

/// Gives a node of a cable that has no shape yet another place of the material.
void move_node(int node, double shift, const CableModel& model, CableState& cable) {
  cable.rest_lengths[node - 1] += shift;
  cable.rest_lengths[node] -= shift;
  for (const int beside : {node - 1, node}) {
    weigh(shift, node - 1, beside, model, cable);
    weigh(-shift, node, beside + 1, model, cable);
  }
}

/// The inner node, `lowest` or above, that is nearest to a place of the material, moved there.
int put_node_at(double arc_length, int lowest, const CableModel& model, CableState& cable) {
  int node = 0;
  double place = 0;
  while (node < cable.segments() && place + 0.5 * cable.rest_lengths[node] < arc_length) place += cable.rest_lengths[node++];
  for (; node < lowest; ++node) place += cable.rest_lengths[node];
  for (; node >= cable.segments(); --node) place -= cable.rest_lengths[node - 1];
  move_node(node, arc_length - place, model, cable);
  return node;
}

/// Of a segment after a guide: where the first node after it is. What comes to a guide passes it without being moved then.
constexpr double first_node = 0.3;

/// A node more, at a part of a segment.
void split_segment(int segment, double part, const CableModel& model, CableState& cable) {
  const double whole = cable.rest_lengths[segment], first = part * whole;
  weigh(first - whole, segment, segment, model, cable);
  weigh(-first, segment, segment + 1, model, cable);
  cable.masses.insert(cable.masses.begin() + segment + 1, 0.0);
  cable.rest_lengths[segment] = whole - first;
  cable.rest_lengths.insert(cable.rest_lengths.begin() + segment, first);
  if (!cable.section_material.empty())
    cable.section_material.insert(cable.section_material.begin() + segment, cable.section_material[segment]);
  weigh(whole, segment, segment + 1, model, cable);
  cable.positions.insert(cable.positions.begin() + segment, Vector3::Zero());
  cable.velocities.insert(cable.velocities.begin() + segment, Vector3::Zero());
}

/// Beside a guide the cable is of one material: what flows through is.
void continue_material(int segment, const CableModel& model, CableState& cable) {
  if (cable.section_material.empty()) return;
  for (const int node : {segment, segment + 1}) weigh(-cable.rest_lengths[segment], segment, node, model, cable);
  cable.section_material[segment] = cable.section_material[segment - 1];
  for (const int node : {segment, segment + 1}) weigh(cable.rest_lengths[segment], segment, node, model, cable);
}

/// One segment instead of those between two nodes of a cable of one material.
void make_one_segment(int first, int last, const CableModel& model, CableState& cable) {
  for (int count = last - first - 1; count > 0; --count) {
    // Its mass is half of each segment beside it.
    weigh(cable.rest_lengths[first + 1], first, first, model, cable);
    weigh(cable.rest_lengths[first], first, first + 2, model, cable);
    cable.rest_lengths[first] += cable.rest_lengths[first + 1];
    cable.rest_lengths.erase(cable.rest_lengths.begin() + first + 1);
    cable.masses.erase(cable.masses.begin() + first + 1);
    cable.positions.erase(cable.positions.begin() + first + 1);
    cable.velocities.erase(cable.velocities.begin() + first + 1);
  }
}

double arc_length_of(const CableDesc& cable, const PlaceDesc& place) {
  return place.at == PlaceDesc::At::start ? 0 : place.at == PlaceDesc::At::end ? cable.length : place.arc_length;
}

/// Index into World::frames() of what holds an attachment or a guide.
template <class Desc>
int frame_of(const Desc& desc, const FrameIds& ids, const State& state) {
  return desc.body.empty() ? ids.at(desc.frame) : state.bodies[find(state.bodies, desc.body)].frame;
}

SimulatedGuide make_guide(const GuideDesc& desc, int frame) {
  SimulatedGuide guide;
  guide.name = desc.name;
  guide.type = desc.type;
  guide.friction = desc.friction_coefficient();
  guide.radius = desc.radius;
  guide.inertia = desc.inertia;
  guide.bearing_friction = desc.bearing_friction;
  guide.retention = desc.retention;
  guide.capture = desc.capture;
  guide.cable = desc.cable;
  guide.frame = frame;
  guide.pose = {desc.offset, quaternion_from_rpy(desc.rotation)};
  return guide;
}

/// Where else along a cable something is that holds it [m], and where that is.
struct HeldPlace {
  double arc_length = 0;
  Vector3 position = Vector3::Zero();
};

/// What is next to a place of a cable on either side: what holds it there, else far down.
std::array<Vector3, 2> neighbours(double arc_length, const Vector3& center, const CableDesc& desc, const FrameIds& ids,
                                  const State& state) {
  constexpr double far = 1e6;
  std::vector<HeldPlace> places;
  const auto add = [&](const auto& holder, const PlaceDesc& place) {
    const int frame = frame_of(holder, ids, state);
    if (!state.frames.known[frame]) return;
    const Pose& pose = state.frames.poses[frame];
    places.push_back({arc_length_of(desc, place), pose.position + pose.orientation * holder.offset});
  };
  for (const AttachmentDesc& a : desc.attachments) add(a, a.place);
  for (const GuideDesc& g : state.scene->guides)
    if (g.cable == desc.name && g.place) add(g, *g.place);
  const Vector3 gravity = state.scene->gravity.at(center);
  const Vector3 down = gravity.norm() > 0 ? Vector3(gravity.normalized()) : Vector3(-Vector3::UnitZ());
  std::array<Vector3, 2> found{center + far * down, center + far * down};
  std::array<double, 2> distance{infinity, infinity};
  for (const HeldPlace& place : places) {
    const double way = place.arc_length - arc_length;
    const int side = way < 0 ? 0 : 1;
    if (way == 0 || std::abs(way) >= distance[side]) continue;
    distance[side] = std::abs(way);
    found[side] = place.position;
  }
  return found;
}

/// A polyline's point at a part of its length, 0 to 1.
Vector3 point_at(const std::vector<Vector3>& points, double part) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  double left = std::clamp(part, 0.0, 1.0) * length;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double way = (points[i] - points[i - 1]).norm();
    if (left <= way && way > 0) return points[i - 1] + left / way * (points[i] - points[i - 1]);
    left -= way;
  }
  return points.back();
}

/// [rad] More than that is on no wheel that a cable goes over.
constexpr double half_turn = M_PI + 1e-3;

/// How a cable lies on a sheave at first: as its shape says, else over the top; but under one that hangs in it.
void wind_on_wheel(double arc_length, const CableDesc& desc, const FrameIds& ids, const State& state, const Pose& wheel,
                   SimulatedGuide& guide, Attachment& attachment) {
  const Vector3 axis = wheel.orientation * Vector3::UnitZ();
  std::array<Vector3, 2> ends = neighbours(arc_length, wheel.position, desc, ids, state);
  Vector3 middle = -state.scene->gravity.at(wheel.position);
  Vector3 along = ends[1] - ends[0];
  using Type = InitialShapeDesc::Type;
  const bool is_given = desc.initial.type == Type::points || desc.initial.type == Type::straight;
  if (is_given) {
    const std::vector<Vector3> straight{desc.initial.from, desc.initial.to};
    const std::vector<Vector3>& shape = desc.initial.type == Type::points ? desc.initial.points : straight;
    const auto at = [&](double place) { return point_at(shape, place / desc.length); };
    const double aside = M_PI * guide.radius;
    ends = {at(arc_length - aside), at(arc_length + aside)};
    middle = at(arc_length) - wheel.position;
    along = at(arc_length + 0.1 * aside) - at(arc_length - 0.1 * aside);
  }
  middle -= middle.dot(axis) * axis;
  if (!(middle.norm() > 0)) middle = wheel.orientation * Vector3::UnitY();
  const auto wind = [&](double sense, const Vector3& near) {
    guide.sense = sense;
    for (const int side : {0, 1})
      attachment.tangent_points[side] = tangent_point(wheel, guide, side, ends[side], wheel.position + near);
    return arc_on_wheel(guide, attachment) / guide.radius;
  };
  const double sense = along.dot(axis.cross(middle)) < 0 ? -1 : 1, angle = wind(sense, middle);
  if (!is_given && angle > half_turn && wind(-sense, -middle) > angle) wind(sense, middle);
}

}  // namespace

void add_guides(const CableDesc& desc, int cable, const FrameIds& ids, const CableModel& model, CableState& cable_state,
                State& state, std::vector<int>& own, std::vector<Attachment>& later) {
  const auto visit_attachments = [&](const auto& visitor) {
    for (const int a : own) visitor(state.attachments[a]);
    for (Attachment& attachment : later) visitor(attachment);
  };
  for (const GuideDesc& g : state.scene->guides) {
    if (g.cable != desc.name) continue;
    SimulatedGuide guide = make_guide(g, frame_of(g, ids, state));
    if (g.place) {
      const int holder = g.body.empty() ? -1 : find(state.bodies, g.body);
      Attachment attachment = hold_by(guide, static_cast<int>(state.guides.size()), cable, holder);
      const double place = arc_length_of(desc, *g.place);
      if (g.type == GuideDesc::Type::sheave) {
        wind_on_wheel(place, desc, ids, state, state.frames.poses[guide.frame] * guide.pose, guide, attachment);
        const double arc = arc_on_wheel(guide, attachment);
        attachment.node = put_node_at(place - 0.5 * arc, 1, model, cable_state);
        const int last = put_node_at(place + 0.5 * arc, attachment.node + 1, model, cable_state);
        make_one_segment(attachment.node, last, model, cable_state);
        visit_attachments([&](Attachment& a) {
          if (a.node >= last) a.node -= last - attachment.node - 1;
        });
      } else {
        attachment.node = put_node_at(place, 1, model, cable_state);
        split_segment(attachment.node, first_node, model, cable_state);
        continue_material(attachment.node, model, cable_state);
        visit_attachments([&](Attachment& a) {
          if (a.node > attachment.node) ++a.node;
        });
      }
      own.push_back(static_cast<int>(state.attachments.size()));
      state.attachments.push_back(attachment);
    }
    state.guides.push_back(guide);
  }
}

Attachment hold_by(const SimulatedGuide& guide, int index, int cable, int holder) {
  Attachment attachment;
  attachment.name = guide.name;
  attachment.body = cable_id(cable);
  attachment.frame = guide.frame;
  attachment.holder = holder;
  attachment.pose = guide.pose;
  attachment.guide = index;
  return attachment;
}

void stop_flow(SimulatedGuide& guide) {
  guide.flow = guide.flow_acceleration = guide.held_energy = guide.held_way = guide.last_way = 0;
}

void stop_flows(int cable, State& state) {
  if (state.guides.empty()) return;
  for (const Attachment& attachment : state.attachments) {
    if (attachment.guide < 0 || attachment.body != cable_id(cable)) continue;
    stop_flow(state.guides[attachment.guide]);
  }
}

bool lies_on_wheel(const State& state, int index, int segment) {
  if (state.guides.empty()) return false;
  return std::any_of(state.attachments.begin(), state.attachments.end(),
                     [&](const Attachment& a) { return a.body == cable_id(index) && is_wheel(a) && a.node == segment; });
}

double flow_energy(const State& state, int index) {
  double energy = 0;
  for (const Attachment& attachment : state.attachments) {
    if (attachment.guide < 0 || attachment.body != cable_id(index)) continue;
    const SimulatedGuide& guide = state.guides[attachment.guide];
    const SimulatedCable& cable = state.cables[attachment.body.index];
    const CableState& c = cable.state;
    const int first = attachment.node, last = last_node(attachment);
    const auto along = [&](int i) -> Vector3 { return c.rest_lengths[i] * segment_direction(c, i); };
    Vector3 way = 0.5 * (along(first - 1) + along(last));
    for (int i = first; i < last; ++i) way += c.positions[i + 1] - c.positions[i];
    const double density = CableMaterials(cable)[first].linear_density;
    double mass = density * flowing_length(c.rest_lengths, first, last);
    if (is_wheel(attachment)) mass += mass_on_rim(guide);
    energy += 0.5 * mass * guide.flow * guide.flow + density * guide.flow * way.dot(c.velocities[first]);
  }
  return energy;
}

}  // namespace verlet_cable
