#include <algorithm>
#include <string>

#include "net_model.h"
#include "verlet_cable/core/world.h"
#include "world_implementation.h"

namespace verlet_cable {

namespace {

using Status = StepResult::Status;

/// Nodes that are nearer than this to a held one [m] are carried along with it.
constexpr double nearest = 1e-6;

void note_net(Status status, int net, int node, StepResult& result) {
  if (status <= result.status) return;
  note_status(status, -1, node, result);
  result.net = net;
}

void forget_motion(const NetModel& model, NetScratch& s) {
  s.link_memory.started = false;
  std::fill(s.link_memory.impulses.begin(), s.link_memory.impulses.end(), 0.0);
  s.point_memory.resize(model.masses.size());
}

/// Held nodes move as their holders do.
void take_velocities(const Holders& holders, NetState& state) {
  for (const Holder& holder : holders.nodes) state.velocities[holder.node] = holder.velocity;
}

/// Carries a net along with holders that have jumped: each node by the holders' ways, weighted by the inverse squares of their
/// distances (Shepard 1968).
void carry_along(const Holders& holders, NetState& state) {
  const std::vector<Vector3> before = state.positions;
  for (std::size_t i = 0; i < before.size(); ++i) {
    Vector3 sum = Vector3::Zero();
    double weights = 0;
    for (const Holder& holder : holders.nodes) {
      const double weight = 1 / std::max((before[i] - before[holder.node]).squaredNorm(), nearest * nearest);
      sum += weight * (holder.position - before[holder.node]);
      weights += weight;
    }
    state.positions[i] += sum / weights;
  }
  for (const Holder& holder : holders.nodes) state.positions[holder.node] = holder.position;
}

void bring_to_rest(NetState& state) {
  std::fill(state.velocities.begin(), state.velocities.end(), Vector3::Zero());
}

}  // namespace

void World::Implementation::start_net(const NetDesc& desc, const BoundaryInputs& inputs) {
  const int index = static_cast<int>(nets.size());
  for (const NetAttachmentDesc& a : desc.attachments) {
    Attachment attachment;
    attachment.name = a.name;
    attachment.cable = -1;
    attachment.net = index;
    attachment.node = a.node;
    attachment.frame = a.frame.empty() ? 0 : find_frame(frames, a.frame);
    attachment.pose.position = a.offset;
    attachments.push_back(attachment);
  }
  nets.push_back(make_net(desc));
  net_scratch.emplace_back();
  const NetModel& model = nets.back().model;
  net_scratch.back().point_memory.resize(model.masses.size());
  net_scratch.back().link_memory.midstep_velocities.assign(model.masses.size(), Vector3::Zero());
  net_scratch.back().link_memory.impulses.assign(model.links.size() + model.minimum_distances.size(), 0.0);
  update_net(index);
  start_holders(attachments, poses, inputs, net_scratch.back().holders);
  take_velocities(net_scratch.back().holders, nets.back().state);
}

/// After a change of what holds a net or what it is made of.
void World::Implementation::update_net(int index) {
  const SimulatedNet& net = nets[index];
  NetScratch& s = net_scratch[index];
  s.holders = find_net_holders(index, net.state.positions, net.state.velocities, attachments, poses, s.holders, time());
  aim_hinges(attachments, poses, time(), s.holders);
  hold_at(0, 0, s.holders, s.boundary);
  if (net.model.link_type == LinkType::spring) {
    s.springs.resize(net.model);
    s.point_memory.restart();
  } else {
    s.links.resize(net.model, s.boundary.nodes, scene.time_step);
  }
}

void World::Implementation::add_particle(const ParticleDesc& desc) {
  particles.push_back({desc, desc.position, desc.velocity});
  particle_memory.emplace_back().resize(1);
}

void World::Implementation::step_nets_and_particles(StepResult& result) {
  if (nets.empty() && particles.empty()) return;
  move_obstacles(0, 1, moving_obstacles);
  for (int net = 0; net < static_cast<int>(nets.size()); ++net) step_net(net, result);
  for (int particle = 0; particle < static_cast<int>(particles.size()); ++particle) step_particle(particle, result);
  result.substeps = std::max(result.substeps, 1);
}

void World::Implementation::step_net(int index, StepResult& result) {
  SimulatedNet& net = nets[index];
  NetScratch& s = net_scratch[index];
  aim_net(index, result);
  hold_at(0, 1, s.holders, s.boundary);
  s.before = net.state;
  const NetStep step{net.model, scene, moving_obstacles, s.holders, s.boundary.nodes};
  const NetStepResult of_net = net.model.link_type == LinkType::spring ? s.springs.advance(step, net.state, s.point_memory)
                                                                       : s.links.advance(step, net.state, s.link_memory);
  if (!of_net.finite) {
    net.state = s.before;
    bring_to_rest(net.state);
    forget_motion(net.model, s);
    note_net(Status::degraded, index, 0, result);
    complete_step(scene.time_step, s.holders);
    show_velocities(s.holders, net.state.velocities);
    return;
  }
  if (of_net.softened) note_net(Status::degraded, index, 0, result);
  if (of_net.overstretched_node >= 0) note_net(Status::overstretched, index, of_net.overstretched_node, result);
  result.iterations += of_net.iterations;
  result.max_strain = std::max(result.max_strain, of_net.max_strain);
  for (std::size_t k = 0; k < s.boundary.nodes.size(); ++k)
    attachments[s.holders.nodes[k].attachment].force = s.boundary.nodes[k].force;
  complete_step(scene.time_step, s.holders);
  show_velocities(s.holders, net.state.velocities);
}

/// Aims what holds a net at where it will be. Where that jumps, the net is carried along, and keeps its velocities.
void World::Implementation::aim_net(int index, StepResult& result) {
  NetScratch& s = net_scratch[index];
  aim_hinges(attachments, poses, time(), s.holders);
  take_back_shown_velocities(s.holders, nets[index].state.velocities);
  const Following following = follow_aims(attachments, time(), scene.time_step, s.holders, jumps);
  if (following.started) take_velocities(s.holders, nets[index].state);
  if (following.jumping_node < 0) return;
  carry_along(s.holders, nets[index].state);
  s.point_memory.restart();
  note_net(Status::jumped, index, following.jumping_node, result);
}

void World::Implementation::step_particle(int index, StepResult& result) {
  SimulatedParticle& particle = particles[index];
  if (particle_stepper.advance(scene, moving_obstacles, particle, particle_memory[index])) return;
  particle.velocity.setZero();
  particle_memory[index].restart();
  if (result.status >= Status::degraded) return;
  note_status(Status::degraded, -1, 0, result);
  result.particle = index;
}

void World::Implementation::add_net_energy(Energy& energy) const {
  const auto add_point = [&](double mass, const Vector3& position, const Vector3& velocity) {
    energy.kinetic += 0.5 * mass * velocity.squaredNorm();
    energy.gravity += mass * scene.gravity.potential_at(position);
  };
  for (const SimulatedNet& net : nets) {
    for (int i = 0; i < net.model.nodes(); ++i) add_point(net.model.masses[i], net.state.positions[i], net.state.velocities[i]);
    for (std::size_t i = 0; i < net.model.links.size(); ++i) {
      const double stretch = strain(net, static_cast<int>(i)) * net.model.rest_lengths[i];
      energy.stretch += 0.5 * net.model.stiffness * stretch * stretch;
    }
  }
  for (const SimulatedParticle& particle : particles) add_point(particle.desc.mass, particle.position, particle.velocity);
}

const std::vector<SimulatedNet>& World::nets() const {
  return implementation_->nets;
}

const std::vector<SimulatedParticle>& World::particles() const {
  return implementation_->particles;
}

int World::find_net(const std::string& name) const {
  for (std::size_t i = 0; i < nets().size(); ++i)
    if (nets()[i].model.name == name) return static_cast<int>(i);
  return -1;
}

EditResult World::cut_link(int index, int link) {
  Implementation& w = *implementation_;
  if (index < 0 || index >= static_cast<int>(w.nets.size()))
    return {false, "net: " + std::to_string(index) + "; must be the index of a net", {}};
  SimulatedNet& net = w.nets[index];
  const int links = static_cast<int>(net.model.links.size());
  if (link < 0 || link >= links)
    return {false,
            "link: " + std::to_string(link) + " of net " + net.model.name +
                (links == 0 ? "; it has none" : "; must be from 0 to " + std::to_string(links - 1)),
            {}};
  net.model.links.erase(net.model.links.begin() + link);
  net.model.rest_lengths.erase(net.model.rest_lengths.begin() + link);
  net.state.tension.erase(net.state.tension.begin() + link);
  std::vector<double>& impulses = w.net_scratch[index].link_memory.impulses;
  impulses.erase(impulses.begin() + link);
  w.update_net(index);
  return {true, "", net.model.name};
}

}  // namespace verlet_cable
