#include "verlet_cable/core/world.h"
#include "world/implementation.h"
#include "world/state_fields.h"

namespace verlet_cable {

double World::time() const {
  return implementation_->state.time();
}
std::int64_t World::steps() const {
  return implementation_->state.steps;
}
double World::time_step() const {
  return implementation_->state.scene->time_step;
}
const std::vector<std::string>& World::frames() const {
  return implementation_->state.frames.names;
}
const Pose& World::frame_pose(int frame) const {
  return implementation_->state.frames.poses[frame];
}
bool World::frame_known(int frame) const {
  return implementation_->state.frames.known[frame];
}
const std::vector<SimulatedCable>& World::cables() const {
  return implementation_->state.cables;
}
const std::vector<std::string>& World::waiting() const {
  return implementation_->findings.waiting;
}
const std::vector<Attachment>& World::attachments() const {
  return implementation_->state.attachments;
}

const std::vector<std::string>& World::unsettled() const {
  return implementation_->findings.unsettled;
}

const std::vector<std::string>& World::misfits() const {
  return implementation_->findings.misfits;
}

const std::vector<Break>& World::breaks() const {
  return implementation_->findings.breaks;
}

const std::vector<Jump>& World::jumps() const {
  return implementation_->findings.jumps;
}

std::vector<SimulatedContact> World::contacts() const {
  return implementation_->findings.contacts;
}

const std::vector<Intrusion>& World::intrusions() const {
  return implementation_->findings.intrusions;
}

int World::find_cable(const std::string& name) const {
  for (std::size_t i = 0; i < cables().size(); ++i)
    if (cables()[i].model.name == name) return static_cast<int>(i);
  return -1;
}

int World::find_attachment(const std::string& name) const {
  for (std::size_t i = 0; i < attachments().size(); ++i)
    if (attachments()[i].name == name) return static_cast<int>(i);
  return -1;
}

Energy World::energy() const {
  Energy energy;
  const GravityDesc& gravity = implementation_->state.scene->gravity;
  for (std::size_t k = 0; k < cables().size(); ++k) {
    const SimulatedCable& cable = cables()[k];
    energy.bend +=
        bending_energy(cable.model, cable.state, boundary_now(implementation_->state.cable_progress[k].targets).directions);
    for (int i = 0; i < cable.model.nodes(); ++i) {
      energy.kinetic += 0.5 * cable.model.masses[i] * cable.state.velocities[i].squaredNorm();
      energy.gravity += cable.model.masses[i] * gravity.potential_at(cable.state.positions[i]);
    }
    for (int i = 0; i < cable.model.segments(); ++i)
      energy.twist += 0.5 * cable.model.material.torsional_stiffness * cable.model.rest_lengths[i] * cable.state.twist[i] *
                      cable.state.twist[i];
    if (cable.model.material.axial_stiffness == infinity) continue;
    for (int i = 0; i < cable.model.segments(); ++i) {
      const double e = strain(cable, i);
      energy.stretch += 0.5 * cable.model.material.axial_stiffness * cable.model.rest_lengths[i] * e * e;
    }
  }
  implementation_->add_net_energy(energy);
  return energy;
}

std::uint64_t World::hash() const {
  return verlet_cable::hash(implementation_->state);
}

}  // namespace verlet_cable
