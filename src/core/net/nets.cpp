#include <algorithm>
#include <string>

#include "net/model.h"
#include "verlet_cable/core/world.h"
#include "world/energy.h"
#include "world/implementation.h"

namespace verlet_cable {

namespace {

using Status = StepResult::Status;

/// Nodes that are nearer than this to a held one [m] are carried along with it.
constexpr double nearest = 1e-6;

void forget_motion(const NetModel& model, NetProgress& memory) {
  memory.links.started = false;
  std::fill(memory.links.impulses.begin(), memory.links.impulses.end(), 0.0);
  memory.points.resize(model.masses.size());
}

/// Held nodes move as their holders do.
void take_velocities(const KinematicTargets& targets, NetState& state) {
  for (const KinematicTarget& target : targets.nodes) state.velocities[target.node] = target.velocity;
}

/// Carries a net along with holders that have jumped: each node by the holders' ways, weighted by the inverse squares of their
/// distances (Shepard 1968).
void carry_along(const KinematicTargets& targets, NetState& state) {
  const std::vector<Vector3> before = state.positions;
  for (std::size_t i = 0; i < before.size(); ++i) {
    Vector3 sum = Vector3::Zero();
    double weights = 0;
    for (const KinematicTarget& target : targets.nodes) {
      const double weight = 1 / std::max((before[i] - before[target.node]).squaredNorm(), nearest * nearest);
      sum += weight * (target.position - before[target.node]);
      weights += weight;
    }
    state.positions[i] += sum / weights;
  }
  for (const KinematicTarget& target : targets.nodes) state.positions[target.node] = target.position;
}

/// Whether what holds a net is where the nodes are.
bool is_in_place(const KinematicTargets& targets, const NetState& state) {
  return std::all_of(targets.nodes.begin(), targets.nodes.end(), [&](const KinematicTarget& target) {
    return (target.position - state.positions[target.node]).norm() <= nearest;
  });
}

/// No forces are known of what has no solution.
void bring_to_rest(NetState& state) {
  std::fill(state.velocities.begin(), state.velocities.end(), Vector3::Zero());
  std::fill(state.tension.begin(), state.tension.end(), 0.0);
}

}  // namespace

void World::Implementation::start_net(const NetDesc& desc, const FrameIds& ids, const BoundaryInputs& inputs) {
  const int index = static_cast<int>(state.nets.size());
  for (const NetAttachmentDesc& a : desc.attachments) {
    Attachment attachment;
    attachment.name = a.name;
    attachment.body = net_id(index);
    attachment.node = a.node;
    attachment.frame = ids.at(a.frame);
    attachment.pose.position = a.offset;
    state.attachments.push_back(attachment);
  }
  state.nets.push_back(make_net(desc));
  const NetModel& model = state.nets.back().model;
  NetProgress& memory = state.net_progress.emplace_back();
  memory.points.resize(model.masses.size());
  memory.links.midstep_velocities.assign(model.masses.size(), Vector3::Zero());
  memory.links.impulses.assign(model.links.size() + model.minimum_distances.size(), 0.0);
  update_net(index);
  start_targets(state.attachments, state.frames.poses, inputs, state.scene->jump_speed, memory.targets);
  if (model.link_type != LinkType::spring && !is_in_place(memory.targets, state.nets.back().state))
    carry_along(memory.targets, state.nets.back().state);
  take_velocities(memory.targets, state.nets.back().state);
}

/// After a change of what holds a net or what it is made of.
void World::Implementation::update_net(int index) {
  const SimulatedNet& net = state.nets[index];
  NetProgress& memory = state.net_progress[index];
  memory.targets =
      find_net_targets(net.state.positions, net.state.velocities, state.attachments,
                       attachments_of(net_id(index), state.attachments), state.frames.poses, memory.targets, state.time());
  aim_hinges(state.attachments, state.frames.poses, state.time(), memory.targets);
  if (net.model.link_type == LinkType::spring) memory.points.restart();
  if (static_cast<int>(net_solvers.value.size()) > index) net_solvers.value.resize(index);
}

/// Made where it is missing: for a new or changed net, or in a copy.
NetSolver& World::Implementation::solver_of(int index) {
  std::vector<NetSolver>& solvers = net_solvers.value;
  for (int i = static_cast<int>(solvers.size()); i <= index; ++i) {
    const NetModel& model = state.nets[i].model;
    NetSolver& solver = solvers.emplace_back();
    solver.boundary = boundary_now(state.net_progress[i].targets);
    if (model.link_type == LinkType::spring)
      solver.springs.resize(model);
    else
      solver.links.resize(model, solver.boundary.nodes, state.scene->time_step);
  }
  return solvers[index];
}

void World::Implementation::add_particle(const ParticleDesc& desc) {
  state.particles.push_back({desc, desc.position, desc.velocity});
  state.particle_integrators.emplace_back().resize(1);
}

void World::Implementation::step_nets_and_particles(StepResult& result) {
  if (state.nets.empty() && state.particles.empty()) return;
  Energy before, after;
  add_net_energy(before);
  move_obstacles(state, 0, 1, moving_obstacles.value);
  // What a net leaves of its share of the work, the next ones may have.
  double work = budget::most, size = 0;
  for (const SimulatedNet& net : state.nets) size += size_of(net.model);
  for (int net = 0; net < static_cast<int>(state.nets.size()); ++net) {
    const NetModel& model = state.nets[net].model;
    NetConstraintSolver& links = solver_of(net).links;
    links.allow_work(first_share_of(model) + work * size_of(model) / size);
    step_net(net, result);
    work -= std::clamp(links.work() - first_share_of(model), 0.0, work);
    size -= size_of(model);
  }
  for (int particle = 0; particle < static_cast<int>(state.particles.size()); ++particle) step_particle(particle, result);
  result.substeps = std::max(result.substeps, 1);
  add_net_energy(after);
  account_for_unfollowed(after.total() - before.total(), state.ledger.balance);
}

void World::Implementation::step_net(int index, StepResult& result) {
  SimulatedNet& net = state.nets[index];
  NetProgress& memory = state.net_progress[index];
  NetSolver& solver = solver_of(index);
  aim_net(index, result);
  hold_at(0, 1, memory.targets, solver.boundary);
  solver.before = net.state;
  const NetStep step{net.model, *state.scene, moving_obstacles.value, memory.targets, solver.boundary.nodes};
  const NetStepResult of_net = net.model.link_type == LinkType::spring ? solver.springs.advance(step, net.state, memory.points)
                                                                       : solver.links.advance(step, net.state, memory.links);
  if (of_net.finite) {
    result.iterations += of_net.iterations;
    result.max_strain = std::max(result.max_strain, of_net.max_strain);
  } else {
    net.state = solver.before;
  }
  result.exhausted = result.exhausted || of_net.exhausted;
  if (!of_net.finite || of_net.torn) {
    bring_to_rest(net.state);
    forget_motion(net.model, memory);
    const DegradedCause cause = of_net.finite ? DegradedCause::no_solution : DegradedCause::unstable;
    note({net_id(index), Status::degraded, 0, of_net.max_strain, cause}, result);
    complete_step(state.scene->time_step, memory.targets);
    show_velocities(memory.targets, net.state.velocities);
    return;
  }
  // It keeps its velocities: where it took too much work for many steps, it would hang in the air without.
  const auto tell = [&](Status status, int node, DegradedCause cause = DegradedCause::none) {
    note({net_id(index), status, node, of_net.max_strain, cause}, result);
  };
  if (of_net.exhausted) tell(Status::degraded, std::max(of_net.unsolved_node, 0), DegradedCause::too_much_work);
  if (of_net.softened) tell(Status::degraded, 0, DegradedCause::too_stiff);
  if (of_net.unsolved_node >= 0) tell(Status::degraded, of_net.unsolved_node, DegradedCause::no_solution);
  if (of_net.overstretched_node >= 0) tell(Status::overstretched, of_net.overstretched_node);
  for (std::size_t k = 0; k < solver.boundary.nodes.size(); ++k)
    state.attachments[memory.targets.nodes[k].attachment].force = solver.boundary.nodes[k].force;
  complete_step(state.scene->time_step, memory.targets);
  show_velocities(memory.targets, net.state.velocities);
}

/// Aims what holds a net at where it will be. Where that jumps, the net is carried along, and keeps its velocities.
void World::Implementation::aim_net(int index, StepResult& result) {
  NetProgress& memory = state.net_progress[index];
  aim_hinges(state.attachments, state.frames.poses, state.time(), memory.targets);
  forget_forces(memory.targets, state.attachments);
  take_back_shown_velocities(memory.targets, state.nets[index].state.velocities);
  const Following following = follow_aims(state.attachments, state.time(), step_of_frames(state), memory.targets, findings.jumps);
  if (following.started) take_velocities(memory.targets, state.nets[index].state);
  if (following.jumping_node < 0) return;
  carry_along(memory.targets, state.nets[index].state);
  memory.points.restart();
  note({net_id(index), Status::jumped, following.jumping_node}, result);
}

void World::Implementation::step_particle(int index, StepResult& result) {
  SimulatedParticle& particle = state.particles[index];
  if (particle_stepper.value.advance(*state.scene, moving_obstacles.value, particle, state.particle_integrators[index])) return;
  particle.velocity.setZero();
  state.particle_integrators[index].restart();
  note({particle_id(index), Status::degraded, 0, 0, DegradedCause::unstable}, result);
}

void World::Implementation::add_net_energy(Energy& energy) const {
  const auto add_point = [&](double mass, const Vector3& position, const Vector3& velocity) {
    energy.kinetic += 0.5 * mass * velocity.squaredNorm();
    energy.gravity += mass * state.scene->gravity.potential_at(position);
  };
  for (const SimulatedNet& net : state.nets) {
    for (int i = 0; i < net.model.nodes(); ++i) add_point(net.model.masses[i], net.state.positions[i], net.state.velocities[i]);
    for (std::size_t i = 0; i < net.model.links.size(); ++i) {
      const double stretch = strain(net, static_cast<int>(i)) * net.model.rest_lengths[i];
      energy.stretch += 0.5 * net.model.stiffness * stretch * stretch;
    }
  }
  for (const SimulatedParticle& particle : state.particles) add_point(particle.desc.mass, particle.position, particle.velocity);
}

EditResult World::Implementation::cut_link(int index, int link) {
  if (index < 0 || index >= static_cast<int>(state.nets.size()))
    return refused("net: " + std::to_string(index) + "; must be the index of a net");
  SimulatedNet& net = state.nets[index];
  const int links = static_cast<int>(net.model.links.size());
  if (link < 0 || link >= links)
    return refused("link: " + std::to_string(link) + " of net " + net.model.name +
                   (links == 0 ? "; it has none" : "; must be from 0 to " + std::to_string(links - 1)));
  net.model.links.erase(net.model.links.begin() + link);
  net.model.rest_lengths.erase(net.model.rest_lengths.begin() + link);
  net.state.tension.erase(net.state.tension.begin() + link);
  std::vector<double>& impulses = state.net_progress[index].links.impulses;
  impulses.erase(impulses.begin() + link);
  update_net(index);
  return {true, {}, {}};
}

}  // namespace verlet_cable
