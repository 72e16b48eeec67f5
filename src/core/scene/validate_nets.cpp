#include "scene/validate_nets.h"

#include <algorithm>
#include <map>

namespace verlet_cable {
namespace {

/// Of the sine between the axes of a grid.
constexpr double parallel_axes = 1e-6;
/// [m] A link between nodes that are closer has no direction.
constexpr double shortest_link = 1e-9;

void check_grid(const std::string& prefix, const GridDesc& grid, Errors& errors) {
  check_fields(prefix, grid_fields, grid, errors);
  check_fields(prefix, grid_integer_fields, grid, errors);
  check_vector(prefix + "origin", grid.origin, "m", errors);
  check_vector(prefix + "x_axis", grid.x_axis, "", errors);
  check_vector(prefix + "y_axis", grid.y_axis, "", errors);
  if (grid.x_axis.norm() == 0) errors.add(prefix + "x_axis", list_text(grid.x_axis), "a direction, of any length above 0");
  if (grid.y_axis.norm() == 0) errors.add(prefix + "y_axis", list_text(grid.y_axis), "a direction, of any length above 0");
  if (grid.x_axis.norm() > 0 && grid.y_axis.norm() > 0 &&
      !(grid.x_axis.normalized().cross(grid.y_axis.normalized()).norm() > parallel_axes))
    errors.add(prefix + "y_axis", list_text(grid.y_axis), "a direction that is not parallel to x_axis " + list_text(grid.x_axis));
}

bool is_pair(const std::array<int, 2>& nodes, std::size_t count) {
  const auto is_node = [&](int node) { return node >= 0 && static_cast<std::size_t>(node) < count; };
  return nodes[0] != nodes[1] && is_node(nodes[0]) && is_node(nodes[1]);
}

std::string pair_text(const std::array<int, 2>& nodes) {
  return "[" + std::to_string(nodes[0]) + ", " + std::to_string(nodes[1]) + "]";
}

std::string pair_words(std::size_t nodes) {
  return nodes < 2 ? "none, there are " + std::to_string(nodes) + " nodes"
                   : "two different nodes from 0 to " + std::to_string(nodes - 1);
}

void check_links(const std::string& prefix, const NetDesc& net, Errors& errors) {
  for (std::size_t i = 0; i < net.nodes.size(); ++i) check_vector(indexed(prefix + "nodes", i), net.nodes[i], "m", errors);
  std::map<std::array<int, 2>, std::size_t> first_use;
  for (std::size_t i = 0; i < net.links.size(); ++i) {
    const std::array<int, 2>& link = net.links[i];
    const std::string key = indexed(prefix + "links", i);
    if (!is_pair(link, net.nodes.size())) {
      errors.add(key, pair_text(link), pair_words(net.nodes.size()));
      continue;
    }
    const auto [first, is_new] = first_use.emplace(std::array<int, 2>{std::min(link[0], link[1]), std::max(link[0], link[1])}, i);
    if (!is_new)
      errors.add(key, pair_text(link), "nodes that no other link joins; " + indexed(prefix + "links", first->second) + " does");
    const double length = (net.nodes[link[1]] - net.nodes[link[0]]).norm();
    if (length < shortest_link)
      errors.add(key, "nodes that are " + rounded_text(length) + " m apart", "at least " + number_text(shortest_link) + " m");
  }
}

void check_masses(const std::string& prefix, const NetDesc& net, Errors& errors) {
  if (net.masses.empty()) {
    if (!positive.contains(net.mass)) errors.add(prefix + "mass", number_text(net.mass), positive.text("kg"));
    return;
  }
  if (net.mass != 0) errors.add(prefix + "mass", number_text(net.mass), "either mass, of all nodes together, or masses");
  if (net.masses.size() != net.node_count())
    errors.add(prefix + "masses", std::to_string(net.masses.size()) + " numbers",
               "one for each node: " + std::to_string(net.node_count()));
  for (std::size_t i = 0; i < net.masses.size(); ++i)
    if (!positive.contains(net.masses[i]))
      errors.add(indexed(prefix + "masses", i), number_text(net.masses[i]), positive.text("kg"));
}

void check_minimum_distances(const std::string& prefix, const NetDesc& net, Errors& errors) {
  const std::string key = prefix + "minimum_distances";
  if (!net.minimum_distances.empty() && net.link_type == LinkType::spring)
    errors.add(key, "given for links that are springs", "only with limited or rigid links");
  for (std::size_t i = 0; i < net.minimum_distances.size(); ++i) {
    const MinimumDistanceDesc& minimum = net.minimum_distances[i];
    if (!is_pair(minimum.nodes, net.node_count()))
      errors.add(indexed(key, i), pair_text(minimum.nodes), pair_words(net.node_count()));
    if (!positive.contains(minimum.distance)) errors.add(indexed(key, i), number_text(minimum.distance), positive.text("m"));
  }
}

void check_attachments(const std::string& prefix, const NetDesc& net, UniqueNames& names, Errors& errors) {
  std::map<int, std::string> targets;
  for (std::size_t i = 0; i < net.attachments.size(); ++i) {
    const NetAttachmentDesc& attachment = net.attachments[i];
    const std::string key = indexed(prefix + "attachments", i);
    names.check(key + ".name", attachment.name, errors);
    if (!attachment.frame.empty() && !is_frame_name(attachment.frame))
      errors.add(key + ".frame", in_quotes(attachment.frame), frame_words);
    check_vector(key + ".offset", attachment.offset, "m", errors);
    if (attachment.initial_pose) check_numbers(key + ".initial_pose", *attachment.initial_pose, coordinate, "m, rad", errors);
    if (net.node_count() == 0) continue;
    if (attachment.node < 0 || static_cast<std::size_t>(attachment.node) >= net.node_count()) {
      errors.add(key + ".node", std::to_string(attachment.node),
                 "a node of the net, from 0 to " + std::to_string(net.node_count() - 1));
      continue;
    }
    const auto [target, is_new] = targets.emplace(attachment.node, key);
    if (!is_new)
      errors.add(key + ".node", std::to_string(attachment.node),
                 "a node that no other attachment holds; " + target->second + " does");
  }
}

void check_net(const std::string& prefix, const NetDesc& net, UniqueNames& attachments, Errors& errors) {
  check_fields(prefix, net_fields, net, errors);
  if (net.grid) {
    check_grid(prefix + "grid.", *net.grid, errors);
    if (!net.nodes.empty()) errors.add(prefix + "nodes", "given together with grid", "either grid, or nodes and links");
    if (!net.links.empty())
      errors.add(prefix + "links", "a list, given together with grid", "spring | limited | rigid, a grid has its links");
  } else {
    if (net.nodes.empty()) errors.add(prefix + "nodes", "none", "a grid, or a list of at least one point");
    check_links(prefix, net, errors);
  }
  check_masses(prefix, net, errors);
  check_minimum_distances(prefix, net, errors);
  check_vector(prefix + "velocity", net.velocity, "m/s", errors);
  check_numbers(prefix + "color", net.color, unit_interval, "", errors);
  check_attachments(prefix, net, attachments, errors);
}

const char* name_of(IntegratorDesc::Type type) {
  switch (type) {
    case IntegratorDesc::Type::euler:
      return "euler";
    case IntegratorDesc::Type::rk4:
      return "rk4";
    case IntegratorDesc::Type::pc5:
      return "pc5";
    case IntegratorDesc::Type::verlet:
      break;
  }
  return "verlet";
}

}  // namespace

void check_particles(const SceneDesc& scene, UniqueNames& names, Errors& errors) {
  for (std::size_t i = 0; i < scene.particles.size(); ++i) {
    const ParticleDesc& particle = scene.particles[i];
    const std::string prefix = indexed("particles", i) + ".";
    names.check(prefix + "name", particle.name, errors);
    check_fields(prefix, particle_fields, particle, errors);
    check_vector(prefix + "position", particle.position, "m", errors);
    check_vector(prefix + "velocity", particle.velocity, "m/s", errors);
    check_numbers(prefix + "color", particle.color, unit_interval, "", errors);
  }
}

void check_nets(const SceneDesc& scene, UniqueNames& names, UniqueNames& attachments, Errors& errors) {
  for (std::size_t i = 0; i < scene.nets.size(); ++i) {
    const std::string prefix = indexed("nets", i) + ".";
    names.check(prefix + "name", scene.nets[i].name, errors);
    check_net(prefix, scene.nets[i], attachments, errors);
  }
}

void check_integrator(const SceneDesc& scene, Errors& errors) {
  const IntegratorDesc& integrator = scene.integrator;
  if (integrator.type == IntegratorDesc::Type::verlet) return;
  const std::string name = name_of(integrator.type);
  if (integrator.first_step != IntegratorDesc::FirstStep::taylor)
    errors.add("integrator.first_step", "given for " + name, "only with verlet");
  if (!scene.cables.empty())
    errors.add("integrator", name + " with cables", "verlet; the others are for particles and nets of springs");
  for (std::size_t i = 0; i < scene.nets.size(); ++i) {
    if (scene.nets[i].link_type == LinkType::spring) continue;
    const char* links = scene.nets[i].link_type == LinkType::rigid ? "rigid" : "limited";
    errors.add("integrator", name + " with the " + links + " links of " + indexed("nets", i),
               "verlet; the others are for particles and nets of springs");
  }
}

}  // namespace verlet_cable
