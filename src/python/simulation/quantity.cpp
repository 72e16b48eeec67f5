#include "simulation/quantity.h"

#include <algorithm>
#include <vector>

#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

/// What a name means, where cables, nets and particles share them: an index into one of the three, -1 in the others.
struct Nodes {
  int cable = -1, net = -1, particle = -1;
};

int find_particle(const World& world, const std::string& name) {
  for (std::size_t i = 0; i < world.particles().size(); ++i)
    if (world.particles()[i].desc.name == name) return static_cast<int>(i);
  return -1;
}

class Names {
 public:
  void add(const std::string& name) { list_.add(name); }
  void add_cables(const World& world) {
    for (const SimulatedCable& cable : world.cables()) add(cable.model->name);
  }
  void add_nets(const World& world) {
    for (const SimulatedNet& net : world.nets()) add(net.model.name);
  }
  [[noreturn]] void refuse(const char* what, const std::string& name) const {
    throw UnknownName(std::string(what) + ": " + in_quotes(name) + "; allowed: " + list_.text("none, there is none"));
  }

 private:
  NameList list_;
};

Nodes find_nodes(const World& world, const std::string& name) {
  Nodes found;
  if ((found.cable = find(world.cables(), name)) >= 0) return found;
  if ((found.net = find(world.nets(), name)) >= 0) return found;
  if ((found.particle = find_particle(world, name)) >= 0) return found;
  Names names;
  names.add_cables(world);
  names.add_nets(world);
  for (const SimulatedParticle& particle : world.particles()) names.add(particle.desc.name);
  names.refuse("name", name);
}

const SimulatedCable& find_cable(const World& world, const std::string& name) {
  if (const int cable = find(world.cables(), name); cable >= 0) return world.cables()[cable];
  Names names;
  names.add_cables(world);
  names.refuse("name", name);
}

const std::vector<double>& find_tension(const World& world, const std::string& name) {
  if (const int cable = find(world.cables(), name); cable >= 0) return world.cables()[cable].state.tension;
  if (const int net = find(world.nets(), name); net >= 0) return world.nets()[net].state.tension;
  Names names;
  names.add_cables(world);
  names.add_nets(world);
  names.refuse("name", name);
}

const SimulatedBody& find_body(const World& world, const std::string& name) {
  const int body = find(world.bodies(), name);
  if (body >= 0 && !world.bodies()[body].is_junction) return world.bodies()[body];
  Names names;
  for (const SimulatedBody& other : world.bodies())
    if (!other.is_junction) names.add(other.name);
  names.refuse("name", name);
}

const Attachment& find_attachment(const World& world, const std::string& name) {
  const int attachment = find(world.attachments(), name);
  if (attachment >= 0 && is_named(world.attachments()[attachment])) return world.attachments()[attachment];
  Names names;
  for (const Attachment& other : world.attachments())
    if (is_named(other)) names.add(other.name);
  names.refuse("attachment", name);
}

ContactWrench find_contact_wrench(const World& world, const std::string& name) {
  const ContactWrench wrench = world.contact_wrench(name);
  if (wrench.frame >= 0) return wrench;
  Names names;
  for (const std::string& other : solid_names(world)) names.add(other);
  names.refuse("name", name);
}

double* write(const Vector3& vector, double* to) {
  return std::copy_n(vector.data(), 3, to);
}

/// x, y, z, w
double* write(const Quaternion& q, double* to) {
  return std::copy_n(q.coeffs().data(), 4, to);
}

template <class Element>
void write(const std::vector<Element>& elements, double* to) {
  for (const Element& element : elements) to = write(element, to);
}

void write(const std::vector<double>& numbers, double* to) {
  std::copy(numbers.begin(), numbers.end(), to);
}

std::size_t count_nodes(const World& world, const Nodes& nodes) {
  if (nodes.cable >= 0) return world.cables()[nodes.cable].state.positions.size();
  return nodes.net >= 0 ? world.nets()[nodes.net].state.positions.size() : 1;
}

}  // namespace

QuantityShape shape_of(const World& world, Quantity quantity, const std::string& name) {
  switch (quantity) {
    case Quantity::positions:
    case Quantity::velocities:
      return {count_nodes(world, find_nodes(world, name)), 3};
    case Quantity::tension:
      return {find_tension(world, name).size(), 0};
    case Quantity::curvature:
    case Quantity::twist:
    case Quantity::plastic_curvature:
      return {static_cast<std::size_t>(find_cable(world, name).state.segments() - 1), 0};
    case Quantity::orientations:
      return {static_cast<std::size_t>(find_cable(world, name).state.segments()), 4};
    case Quantity::wrench:
      find_attachment(world, name);
      return {6, 0};
    case Quantity::contact_force:
      find_contact_wrench(world, name);
      return {6, 0};
    case Quantity::body_pose:
      find_body(world, name);
      return {7, 0};
    case Quantity::body_twist:
      find_body(world, name);
      return {6, 0};
  }
  return {};
}

void copy_quantity(const World& world, Quantity quantity, const std::string& name, double* to) {
  switch (quantity) {
    case Quantity::positions:
    case Quantity::velocities: {
      const Nodes nodes = find_nodes(world, name);
      const bool places = quantity == Quantity::positions;
      if (nodes.cable >= 0) {
        const CableState& state = world.cables()[nodes.cable].state;
        return write(places ? state.positions : state.velocities, to);
      }
      if (nodes.net >= 0) {
        const NetState& state = world.nets()[nodes.net].state;
        return write(places ? state.positions : state.velocities, to);
      }
      const SimulatedParticle& particle = world.particles()[nodes.particle];
      write(places ? particle.position : particle.velocity, to);
      return;
    }
    case Quantity::tension:
      return write(find_tension(world, name), to);
    case Quantity::curvature:
      return write(node_curvature(find_cable(world, name).state), to);
    case Quantity::twist:
      return write(node_twist(find_cable(world, name).state), to);
    case Quantity::plastic_curvature: {
      std::vector<double> curvature = plastic_curvature(find_cable(world, name));
      curvature.resize(find_cable(world, name).state.segments() - 1, 0.0);
      return write(curvature, to);
    }
    case Quantity::orientations:
      return write(segment_orientations(find_cable(world, name).state), to);
    case Quantity::wrench: {
      const Attachment& attachment = find_attachment(world, name);
      write(attachment.torque, write(attachment.force, to));
      return;
    }
    case Quantity::contact_force: {
      const ContactWrench wrench = find_contact_wrench(world, name);
      write(wrench.torque, write(wrench.force, to));
      return;
    }
    case Quantity::body_pose: {
      const Pose& pose = find_body(world, name).pose;
      write(pose.orientation, write(pose.position, to));
      return;
    }
    case Quantity::body_twist: {
      const SimulatedBody& body = find_body(world, name);
      write(body.angular_velocity, write(body.velocity, to));
      return;
    }
  }
}

bool try_copy_quantity(const World& world, Quantity quantity, const std::string& name, const QuantityShape& shape, double* to) {
  try {
    if (shape_of(world, quantity, name) != shape) return false;
  } catch (const UnknownName&) {
    return false;
  }
  copy_quantity(world, quantity, name, to);
  return true;
}

void copy_points(const World& world, Quantity quantity, const std::string& name, std::size_t points, double* to) {
  const CableState& state = find_cable(world, name).state;
  const std::vector<Vector3>& nodes = quantity == Quantity::positions ? state.positions : state.velocities;
  const double distance = state.length() / static_cast<double>(points - 1);
  int segment = 0;
  double start = 0;  // [m] of the segment
  for (std::size_t i = 0; i < points; ++i) {
    const double place = static_cast<double>(i) * distance;
    while (segment + 1 < state.segments() && start + state.rest_lengths[segment] <= place) start += state.rest_lengths[segment++];
    const double fraction = std::min(1.0, (place - start) / state.rest_lengths[segment]);
    to = write(Vector3((1 - fraction) * nodes[segment] + fraction * nodes[segment + 1]), to);
  }
}

}  // namespace verlet_cable
