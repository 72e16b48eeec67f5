#include "verlet_cable/view/drawing.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <variant>

#include "error_lines.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable::view {
namespace {

constexpr std::size_t most_things = 65534;  // numbers of masks have 16 bits
constexpr double most_coordinate = 1e9;     // [m]

/// Told apart by eye, from the first ones on: Tableau's ten.
constexpr std::array<Color, 10> palette{{{0.12, 0.47, 0.71},
                                         {1.00, 0.50, 0.05},
                                         {0.17, 0.63, 0.17},
                                         {0.84, 0.15, 0.16},
                                         {0.58, 0.40, 0.74},
                                         {0.55, 0.34, 0.29},
                                         {0.89, 0.47, 0.76},
                                         {0.50, 0.50, 0.50},
                                         {0.74, 0.74, 0.13},
                                         {0.09, 0.75, 0.81}}};

Color mix(const Color& first, const Color& last, double part) {
  Color mixed;
  for (int k = 0; k < 3; ++k) mixed[k] = first[k] + part * (last[k] - first[k]);
  return mixed;
}

/// A tone that is seen beside a color.
Color beside(const Color& color) {
  const double brightness = 0.3 * color[0] + 0.6 * color[1] + 0.1 * color[2];
  return brightness < 0.6 ? mix(color, {1, 1, 1}, 0.65) : mix(color, {0, 0, 0}, 0.55);
}

Color color_of(const std::array<double, 4>& rgba) {
  return {rgba[0], rgba[1], rgba[2]};
}

Look plain(const Color& color) {
  Look look;
  look.color = color;
  return look;
}

bool are_sound(const std::vector<Vector3>& points) {
  return std::all_of(points.begin(), points.end(),
                     [](const Vector3& point) { return !point.hasNaN() && point.cwiseAbs().maxCoeff() <= most_coordinate; });
}

bool is_sound(const Tube& tube) {
  const std::size_t segments = tube.centers.size() - 1;
  const auto is_turn = [](const Quaternion& turn) { return std::abs(turn.norm() - 1) < 1e-3; };
  return tube.centers.size() > 1 && are_sound(tube.centers) && (tube.radii.size() == 1 || tube.radii.size() == segments) &&
         std::all_of(tube.radii.begin(), tube.radii.end(), [](double radius) { return positive.contains(radius); }) &&
         (tube.orientations.empty() || tube.orientations.size() == segments) &&
         std::all_of(tube.orientations.begin(), tube.orientations.end(), is_turn);
}

bool is_sound(const Color& color) {
  return std::all_of(color.begin(), color.end(), [](double part) { return unit_interval.contains(part); });
}

bool is_sound(const Look& look) {
  return is_sound(look.color) && is_sound(look.second_color) && look.stripes >= 0 && look.stripes <= 1000 &&
         not_negative.contains(look.stripe_width) && positive.contains(look.check_size) && unit_interval.contains(look.shininess);
}

struct IsSoundShape {
  bool operator()(const PlaneShape&) const { return true; }
  bool operator()(const SphereShape& sphere) const { return positive.contains(sphere.radius); }
  bool operator()(const CapsuleShape& capsule) const {
    return positive.contains(capsule.radius) && not_negative.contains(capsule.length);
  }
  bool operator()(const CylinderShape& cylinder) const {
    return positive.contains(cylinder.radius) && positive.contains(cylinder.length);
  }
  bool operator()(const BoxShape& box) const {
    return std::all_of(box.size.begin(), box.size.end(), [](double size) { return positive.contains(size); });
  }
  bool operator()(const MeshShape& mesh) const { return mesh.mesh != nullptr && are_sound(mesh.mesh->vertices()); }
};

/// Colors of cables and nets: those that they have, or, if some are the same and that is not wanted, those of the palette.
class Colors {
 public:
  Colors(const World& world, bool distinct) {
    for (const SimulatedCable& cable : world.cables()) colors_.push_back(color_of(cable.model->color));
    for (const SimulatedNet& net : world.nets()) colors_.push_back(color_of(net.model.color));
    if (!distinct || std::set<Color>(colors_.begin(), colors_.end()).size() == colors_.size()) return;
    for (std::size_t i = 0; i < colors_.size(); ++i) colors_[i] = palette[i % palette.size()];
  }

  const Color& of_cable(std::size_t cable) const { return colors_[cable]; }
  const Color& of_net(const World& world, std::size_t net) const { return colors_[world.cables().size() + net]; }

 private:
  std::vector<Color> colors_;
};

Tube tube_of(const SimulatedCable& cable, const DrawingOptions& options) {
  const CableMaterials materials(cable);
  const auto drawn = [&](double radius) { return std::max(radius, options.least_radius); };
  Tube tube{cable.state.positions, {}, {}};
  if (materials.vary())
    for (int segment = 0; segment < cable.state.segments(); ++segment) tube.radii.push_back(drawn(materials[segment].radius));
  else
    tube.radii.push_back(drawn(cable.model->material.radius));
  if (options.stripes && are_sound(tube.centers)) tube.orientations = segment_orientations(cable.state);
  return tube;
}

/// Only what is sound: a world that went wrong is still looked at.
Thing net_thing(const SimulatedNet& net, const Color& color, double radius) {
  Thing thing{net.model.name, Thing::Kind::net, plain(color)};
  for (const auto& [first, last] : net.model.links) {
    Tube cord{{net.state.positions[first], net.state.positions[last]}, {radius}, {}};
    if (is_sound(cord)) thing.tubes.push_back(std::move(cord));
  }
  return thing;
}

}  // namespace

std::vector<std::string> labels(const Drawing& drawing) {
  std::vector<std::string> names;
  names.reserve(drawing.things.size());
  for (const Thing& thing : drawing.things) names.push_back(thing.name);
  return names;
}

std::vector<std::string> validate(const Drawing& drawing) {
  ErrorLines errors;
  errors.require(drawing.things.size() <= most_things, "things", std::to_string(drawing.things.size()),
                 "at most " + std::to_string(most_things));
  for (std::size_t i = 0; i < drawing.things.size(); ++i) {
    const Thing& thing = drawing.things[i];
    const std::string name = "things[" + std::to_string(i) + "]";
    errors.require(i == 0 || drawing.things[i - 1].kind <= thing.kind, name, "out of order",
                   "cables, nets, particles, bodies and the others, in this order");
    errors.require(is_sound(thing.look), name + ".look", "out of range", "colors and shininess from 0 to 1, sizes above 0");
    errors.require(verlet_cable::is_sound(thing.pose), name + ".pose", "not a pose", "finite numbers, and a unit quaternion");
    for (std::size_t k = 0; k < thing.tubes.size(); ++k)
      errors.require(
          is_sound(thing.tubes[k]), name + ".tubes[" + std::to_string(k) + "]", "out of range",
          "two finite centers or more, a radius above 0 for all or for each segment, and none or as many orientations");
    for (std::size_t k = 0; k < thing.parts.size(); ++k) {
      const std::string part = name + ".parts[" + std::to_string(k) + "]";
      errors.require(std::visit(IsSoundShape{}, thing.parts[k].shape), part + ".shape", "out of range",
                     "sizes above 0, and a mesh that is there");
      errors.require(verlet_cable::is_sound(thing.parts[k].pose), part + ".pose", "not a pose",
                     "finite numbers, and a unit quaternion");
      errors.require(!thing.parts[k].look || is_sound(*thing.parts[k].look), part + ".look", "out of range",
                     "colors and shininess from 0 to 1, sizes above 0");
    }
  }
  const Vector3& direction = drawing.light.direction;
  errors.require(are_sound({direction}) && direction.norm() > 1e-9, "light.direction", list_text(direction),
                 "finite numbers that are not all 0");
  errors.require(unit_interval.contains(drawing.light.ambient), "light.ambient", number_text(drawing.light.ambient),
                 unit_interval.text());
  errors.require(is_sound(drawing.background), "background", list_text(drawing.background), unit_interval.text());
  return errors.lines();
}

Look body_look() {
  return plain({0.75, 0.55, 0.25});
}

Look obstacle_look() {
  return plain({0.8, 0.83, 0.87});
}

Look plane_look(bool checks) {
  Look look = plain({0.74, 0.76, 0.79});
  look.second_color = {0.80, 0.82, 0.84};
  look.shininess = 0;
  if (checks) look.pattern = Look::Pattern::checks;
  return look;
}

Thing cable(const std::string& name, Tube tube, const Color& color, bool stripes) {
  Thing thing{name, Thing::Kind::cable, plain(color)};
  thing.look.second_color = beside(color);
  thing.look.shininess = 0.3;
  if (stripes) thing.look.pattern = Look::Pattern::stripes;
  thing.tubes.push_back(std::move(tube));
  return thing;
}

Drawing drawing_of(const World& world, const DrawingOptions& options) {
  Drawing drawing;
  const Colors colors(world, options.distinct_colors);
  for (std::size_t i = 0; i < world.cables().size(); ++i) {
    const SimulatedCable& simulated = world.cables()[i];
    drawing.things.push_back(cable(simulated.model->name, tube_of(simulated, options), colors.of_cable(i), options.stripes));
    if (!is_sound(drawing.things.back().tubes.front())) drawing.things.back().tubes.clear();
  }
  for (std::size_t i = 0; i < world.nets().size(); ++i)
    drawing.things.push_back(
        net_thing(world.nets()[i], colors.of_net(world, i), std::max(options.net_link_radius, options.least_radius)));
  for (const SimulatedParticle& particle : world.particles()) {
    Thing thing{particle.desc.name, Thing::Kind::particle, plain(color_of(particle.desc.color))};
    if (are_sound({particle.position})) {
      thing.pose.position = particle.position;
      thing.parts.push_back({{}, SphereShape{particle.desc.radius}, {}});
    }
    drawing.things.push_back(std::move(thing));
  }
  for (const SimulatedBody& body : world.bodies()) {
    if (body.is_junction) continue;
    Thing thing{body.name, Thing::Kind::body, body_look()};
    if (verlet_cable::is_sound(body.pose)) {
      thing.pose = body.pose;
      for (const BodyShape& shape : body.shapes) thing.parts.push_back({shape.pose, shape.shape, {}});
    }
    drawing.things.push_back(std::move(thing));
  }
  for (const Obstacle& obstacle : world.obstacles()) {
    const bool is_plane = std::holds_alternative<PlaneShape>(obstacle.shape);
    Thing thing{obstacle.name, Thing::Kind::other, is_plane ? plane_look(options.checks) : obstacle_look()};
    if (obstacle.present) {
      thing.pose = world.frame_pose(obstacle.frame);
      thing.parts.push_back({obstacle.pose, obstacle.shape, {}});
    }
    drawing.things.push_back(std::move(thing));
  }
  return drawing;
}

}  // namespace verlet_cable::view
