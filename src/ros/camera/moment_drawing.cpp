#include "camera/moment_drawing.h"

#include <algorithm>
#include <map>
#include <utility>

#include "camera/from_messages.h"
#include "publish/color.h"
#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {
namespace {

using Kind = view::Thing::Kind;

constexpr double default_link_radius = 0.001;  // [m] of nets

view::Color color_of(const std_msgs::ColorRGBA& color) {
  return {std::clamp(color.r, 0.0f, 1.0f), std::clamp(color.g, 0.0f, 1.0f), std::clamp(color.b, 0.0f, 1.0f)};
}

/// How it looks of which only the place is known.
Appearance default_appearance(const CableArray& state) {
  Appearance appearance;
  const auto add = [&](const std::string& name, const std::array<double, 4>& color, double radius) {
    Look& look = appearance.looks.emplace_back();
    look.name = name;
    look.color = to_color(color);
    look.radii = {radius};
  };
  for (const Cable& cable : state.cables) add(cable.name, CableDesc{}.color, cable.radius);
  for (const Net& net : state.nets) add(net.name, NetDesc{}.color, default_link_radius);
  for (const Particle& particle : state.particles) add(particle.name, ParticleDesc{}.color, ParticleDesc{}.radius);
  for (const Body& body : state.bodies) appearance.bodies.push_back(body.name);
  return appearance;
}

view::Thing cable_thing(const Cable& cable, const Look& look) {
  view::Tube tube;
  tube.centers = vectors_of(cable.positions);
  const bool fits = look.radii.size() == 1 || look.radii.size() + 1 == tube.centers.size();
  tube.radii = fits ? look.radii : std::vector<double>{cable.radius};
  for (const geometry_msgs::Quaternion& orientation : cable.orientations) tube.orientations.push_back(quaternion_of(orientation));
  return view::cable(cable.name, std::move(tube), color_of(look.color));
}

view::Thing net_thing(const Net& net, const Look& look) {
  view::Thing thing;
  thing.name = net.name;
  thing.look.color = color_of(look.color);
  const double radius = look.radii.empty() ? default_link_radius : look.radii.front();
  const auto is_node = [&](std::uint32_t node) { return node < net.positions.size(); };
  for (std::size_t i = 0; i + 1 < net.links.size(); i += 2)
    if (is_node(net.links[i]) && is_node(net.links[i + 1]))
      thing.tubes.push_back({{vector_of(net.positions[net.links[i]]), vector_of(net.positions[net.links[i + 1]])}, {radius}});
  return thing;
}

view::Thing particle_thing(const Particle& particle, const Look& look) {
  view::Thing thing;
  thing.name = particle.name;
  thing.look.color = color_of(look.color);
  const double radius = look.radii.empty() ? ParticleDesc{}.radius : look.radii.front();
  thing.parts.push_back({Pose{vector_of(particle.position), Quaternion::Identity()}, SphereShape{radius}});
  return thing;
}

/// Messages by their names.
template <class Message>
class Named {
 public:
  explicit Named(const std::vector<Message>& messages) {
    for (const Message& message : messages) by_name_.emplace(message.name, &message);
  }
  const Message* find(const std::string& name) const {
    const auto found = by_name_.find(name);
    return found == by_name_.end() ? nullptr : found->second;
  }

 private:
  std::map<std::string, const Message*> by_name_;
};

std::optional<Shape> shape_of(const Solid& solid, MeshShelf& meshes) {
  switch (solid.type) {
    case Solid::PLANE:
      return PlaneShape{};
    case Solid::SPHERE:
      return SphereShape{solid.radius};
    case Solid::CAPSULE:
      return CapsuleShape{solid.radius, solid.length};
    case Solid::CYLINDER:
      return CylinderShape{solid.radius, solid.length};
    case Solid::BOX:
      return BoxShape{vector_of(solid.size)};
    default:
      if (auto mesh = meshes.read(solid.uri, vector_of(solid.size))) return MeshShape{std::move(mesh)};
      return std::nullopt;
  }
}

view::Look look_of(const Solid& solid) {
  if (solid.type == Solid::PLANE) return view::plane_look();
  view::Look look = solid.owner == Solid::BODY ? view::body_look() : view::obstacle_look();
  look.color = color_of(solid.color);
  return look;
}

/// Things with names, in the order in which they were first named.
class Things {
 public:
  explicit Things(Kind kind) : kind_(kind) {}

  view::Thing& operator[](const std::string& name) {
    const auto [place, is_new] = places_.emplace(name, things_.size());
    if (is_new) {
      view::Thing& thing = things_.emplace_back();
      thing.name = name;
      thing.kind = kind_;
    }
    return things_[place->second];
  }
  void append_to(view::Drawing& drawing) const { drawing.things.insert(drawing.things.end(), things_.begin(), things_.end()); }

 private:
  Kind kind_;
  std::vector<view::Thing> things_;
  std::map<std::string, std::size_t> places_;
};

/// In the order of their ids; what waits for its frames is not there, and keeps its number. The looks are those of cables, then
/// nets, then particles: what is not there is of the kind of what is before it.
void add_looks(const CableArray& state, const Appearance& appearance, view::Drawing& drawing) {
  const Named<Cable> cables(state.cables);
  const Named<Net> nets(state.nets);
  const Named<Particle> particles(state.particles);
  Kind kind = Kind::cable;
  for (const Look& look : appearance.looks) {
    view::Thing thing;
    if (const Cable* cable = cables.find(look.name)) {
      thing = cable_thing(*cable, look);
    } else if (const Net* net = nets.find(look.name)) {
      thing = net_thing(*net, look);
      kind = Kind::net;
    } else if (const Particle* particle = particles.find(look.name)) {
      thing = particle_thing(*particle, look);
      kind = Kind::particle;
    }
    thing.name = look.name;
    thing.kind = kind;
    drawing.things.push_back(std::move(thing));
  }
}

void add_solids(const Appearance& appearance, bool with_links, MeshShelf& meshes, Things& bodies, Things& others) {
  for (const Solid& solid : appearance.solids) {
    if (solid.owner == Solid::LINK && !with_links) continue;
    view::Thing& thing = (solid.owner == Solid::BODY ? bodies : others)[solid.name];
    if (auto shape = shape_of(solid, meshes)) thing.parts.push_back({pose_of(solid.pose), *shape, look_of(solid)});
  }
}

}  // namespace

view::Drawing drawing_of(const Moment& moment, const SeenRobot& robot, const std::vector<std::optional<Pose>>& link_poses,
                         const std::vector<std::string>& labels, MeshShelf& meshes) {
  const Appearance appearance = moment.appearance ? *moment.appearance : default_appearance(*moment.state);
  view::Drawing drawing;
  add_looks(*moment.state, appearance, drawing);
  Things bodies(Kind::body), others(Kind::other);
  for (const std::string& body : appearance.bodies) bodies[body];
  for (const std::string& label : labels) others[label];
  add_solids(appearance, robot.links().empty(), meshes, bodies, others);
  for (std::size_t link = 0; link < link_poses.size(); ++link)
    if (link_poses[link]) robot.add(link, *link_poses[link], others[robot.links()[link]]);
  bodies.append_to(drawing);
  others.append_to(drawing);
  return drawing;
}

}  // namespace verlet_cable
