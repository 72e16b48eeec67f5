#include "publish/color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "publish/conversions.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {
namespace {

constexpr double standard_gravity = 9.81;             // [m/s^2] where the scene has none to weigh its cables with
constexpr double full_strain_if_inextensible = 1e-3;  // nothing to see as long as the solver keeps its lengths
/// From blue over teal and ochre to red: none so pale or so dark that it is lost on a light or a dark background.
constexpr std::array<std::array<float, 3>, 9> stops{{{0.22f, 0.42f, 0.75f},
                                                     {0.20f, 0.56f, 0.80f},
                                                     {0.20f, 0.66f, 0.74f},
                                                     {0.35f, 0.72f, 0.58f},
                                                     {0.58f, 0.74f, 0.38f},
                                                     {0.82f, 0.70f, 0.24f},
                                                     {0.93f, 0.56f, 0.18f},
                                                     {0.93f, 0.38f, 0.20f},
                                                     {0.84f, 0.19f, 0.15f}}};

double mass(const SceneDesc& scene, const CableDesc& cable) {
  double mass = 0, own_length = cable.length;
  const auto add = [&](const std::string& name, double length) {
    if (const MaterialDesc* material = scene.find_material(name)) mass += material->linear_density * length;
  };
  for (const SectionDesc& section : cable.sections) {
    add(section.material, section.to - section.from);
    own_length -= section.to - section.from;
  }
  add(cable.material, own_length);
  for (const PointMassDesc& payload : cable.point_masses) mass += payload.mass;
  return mass;
}

double largest_weight(const SceneDesc& scene) {
  double largest = 0;
  for (const CableDesc& cable : scene.cables) largest = std::max(largest, mass(scene, cable));
  const double gravity = scene.gravity.type == GravityDesc::Type::uniform ? scene.gravity.acceleration.norm() : 0;
  return largest * (gravity > 0 ? gravity : standard_gravity);
}

double largest_strain(const SceneDesc& scene, double tension) {
  double largest = 0;
  const auto add = [&](const std::string& name) {
    if (const MaterialDesc* material = scene.find_material(name))
      largest = std::max(largest, tension / material->axial_stiffness);
  };
  for (const CableDesc& cable : scene.cables) {
    add(cable.material);
    for (const SectionDesc& section : cable.sections) add(section.material);
  }
  return largest > 0 ? largest : full_strain_if_inextensible;
}

constexpr double fading_time = 10;  // [s]
/// The range is left as it is until it is so many times too wide: a legend that changes all the time is not read.
constexpr double widest = 1.5;

/// Two digits at most, and no less than the value.
double rounded_up(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double digits : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (digits * power >= value) return digits * power;
  return 10 * power;
}

/// Of a radius that is as small as allowed, 1; 0 of one that is so many times as large.
constexpr double gentle_bend = 5;

/// Of how the cable bends at a node; at an end as at its neighbour.
double bend_load(const SimulatedCable& cable, int node) {
  const int last = cable.state.segments() - 1;
  if (last < 1) return 0;
  const CableMaterials materials(cable);
  const int inner = std::clamp(node, 1, last);
  const Vector3 before = cable.state.positions[inner] - cable.state.positions[inner - 1];
  const Vector3 after = cable.state.positions[inner + 1] - cable.state.positions[inner];
  const std::array<double, 2> curvature =
      curvature_beside(materials, cable.state, inner, std::atan2(before.cross(after).norm(), before.dot(after)));
  const double tightness =
      std::max(curvature[0] * materials[inner - 1].minimum_bend_radius, curvature[1] * materials[inner].minimum_bend_radius);
  return (gentle_bend - 1 / tightness) / (gentle_bend - 1);
}

}  // namespace

std_msgs::ColorRGBA color_of_load(double load) {
  const double place = std::clamp(load, 0.0, 1.0) * (stops.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  const float fraction = static_cast<float>(place - static_cast<double>(below));
  const auto channel = [&](int i) { return stops[below][i] + fraction * (stops[below + 1][i] - stops[below][i]); };
  std_msgs::ColorRGBA color;
  color.r = channel(0);
  color.g = channel(1);
  color.b = channel(2);
  color.a = 1;
  return color;
}

float packed_rgb(const std_msgs::ColorRGBA& color) {
  const auto byte = [](float channel) { return static_cast<std::uint32_t>(std::lround(255 * std::clamp(channel, 0.0f, 1.0f))); };
  const std::uint32_t bits = byte(color.r) << 16 | byte(color.g) << 8 | byte(color.b);
  float packed;
  std::memcpy(&packed, &bits, sizeof(packed));
  return packed;
}

std_msgs::ColorRGBA to_color(const std::array<double, 4>& rgba) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(rgba[0]);
  color.g = static_cast<float>(rgba[1]);
  color.b = static_cast<float>(rgba[2]);
  color.a = static_cast<float>(rgba[3]);
  return color;
}

ColorScale::ColorScale(const SceneDesc& scene)
    : color_by_(scene.color_by),
      has_cables_(!scene.cables.empty()),
      full_tension_(scene.cables.empty() ? 1 : largest_weight(scene)),
      full_strain_(largest_strain(scene, full_tension_)),
      least_(color_by_ == ColorBy::strain ? full_strain_ : full_tension_) {}

double ColorScale::largest(const World& world) const {
  double largest = 0;
  const std::vector<std::vector<double>> forces = contact_forces(world);
  for (std::size_t i = 0; i < world.cables().size(); ++i) {
    const SimulatedCable& cable = world.cables()[i];
    if (!is_finite(cable)) continue;
    for (const double force : forces[i]) largest = std::max(largest, force);
    for (int segment = 0; color_by_ != ColorBy::contact && segment < cable.state.segments(); ++segment)
      largest = std::max(largest, color_by_ == ColorBy::strain ? strain(cable.state, segment) : cable.state.tension[segment]);
  }
  return largest;
}

bool ColorScale::follow(const World& world, double elapsed) {
  if (color_by_ == ColorBy::cable || color_by_ == ColorBy::bend) return false;
  recent_ = std::max(largest(world), recent_ * std::exp(-std::max(elapsed, 0.0) / fading_time));
  double& full = color_by_ == ColorBy::strain ? full_strain_ : full_tension_;
  const double wanted = recent_ > least_ ? rounded_up(recent_) : least_;
  if (recent_ <= full && widest * wanted > full && wanted > least_) return false;
  return std::exchange(full, wanted) != wanted;
}

double ColorScale::load(const SimulatedCable& cable, int segment, const std::vector<double>& contact_forces) const {
  if (color_by_ == ColorBy::contact) return contact_forces.empty() ? 0 : std::cbrt(contact_forces[segment] / full_tension_);
  return color_by_ == ColorBy::strain ? strain(cable.state, segment) / full_strain_
                                      : cable.state.tension[segment] / full_tension_;
}

Legend ColorScale::legend() const {
  Legend legend;
  if (color_by_ == ColorBy::cable || !has_cables_) return legend;
  legend.quantity = color_by_ == ColorBy::contact  ? "contact force, by its cube root"
                    : color_by_ == ColorBy::strain ? "strain"
                                                   : "tension";
  legend.unit = color_by_ == ColorBy::strain ? "%" : "N";
  if (color_by_ == ColorBy::bend) {
    legend.quantity = "bend radius / smallest allowed";
    legend.unit = "1";
    for (std::size_t i = 0; i < stops.size(); ++i) {
      const double load = 1 - static_cast<double>(i) / (stops.size() - 1);
      legend.colors.push_back(color_of_load(load));
      legend.values.push_back(gentle_bend - load * (gentle_bend - 1));
    }
    return legend;
  }
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const double load = static_cast<double>(i) / (stops.size() - 1);
    legend.colors.push_back(color_of_load(load));
    legend.values.push_back(color_by_ == ColorBy::contact  ? load * load * load * full_tension_
                            : color_by_ == ColorBy::strain ? 100 * load * full_strain_
                                                           : load * full_tension_);
  }
  return legend;
}

std::vector<std::vector<double>> ColorScale::contact_forces(const World& world) const {
  std::vector<std::vector<double>> forces(world.cables().size());
  if (color_by_ != ColorBy::contact) return forces;
  for (const SimulatedContact& contact : contacts_of_both(world)) {
    std::vector<double>& of_cable = forces[contact.cable];
    of_cable.resize(world.cables()[contact.cable].state.segments());
    of_cable[contact.segment] += contact.force.norm();
  }
  return forces;
}

std::vector<std_msgs::ColorRGBA> ColorScale::node_colors(const SimulatedCable& cable,
                                                         const std::vector<double>& contact_forces) const {
  const int segments = cable.state.segments();
  std::vector<std_msgs::ColorRGBA> colors(cable.state.nodes());
  if (color_by_ == ColorBy::bend) {
    for (int node = 0; node <= segments; ++node) colors[node] = color_of_load(bend_load(cable, node));
  } else if (color_by_ != ColorBy::cable) {
    for (int node = 0; node <= segments; ++node) {
      const double before = load(cable, std::max(node - 1, 0), contact_forces);
      const double after = load(cable, std::min(node, segments - 1), contact_forces);
      colors[node] = color_of_load((before + after) / 2);
    }
  } else {
    std::fill(colors.begin(), colors.end(), to_color(cable.model->color));
  }
  return colors;
}

}  // namespace verlet_cable
