#include "check_world.h"

#include <cmath>
#include <string>
#include <vector>

#include "../test/support/world_inspector.h"
#include "require.h"
#include "world/invariant.h"

namespace verlet_cable::fuzz {
namespace {

void check_finite(const std::string& what, double number) {
  require(std::isfinite(number), what + " is finite");
}

void check_finite(const std::string& what, const Vector3& v) {
  require(v.allFinite(), what + " is finite");
}

void check_finite(const std::string& what, const Pose& pose) {
  require(pose.position.allFinite() && pose.orientation.coeffs().allFinite(), what + " is finite");
  require(std::abs(pose.orientation.norm() - 1) < 1e-6, what + " is a rotation");
}

template <class Item>
void check_all(const std::string& what, const std::vector<Item>& items, int size) {
  require(static_cast<int>(items.size()) == size, what + ": " + std::to_string(items.size()) + " of " + std::to_string(size));
  for (const Item& item : items) check_finite(what, item);
}

void check_cable(const World& world, int index) {
  const SimulatedCable& cable = world.cables()[index];
  const CableState& state = cable.state;
  const std::string& name = cable.model->name;
  const int nodes = state.nodes(), segments = state.segments();
  require(segments >= 1 && nodes == segments + 1, name + ": a node more than segments");
  check_all(name + ": masses", state.masses, nodes);
  check_all(name + ": positions", state.positions, nodes);
  check_all(name + ": velocities", state.velocities, nodes);
  check_all(name + ": accelerations", state.accelerations, nodes);
  check_all(name + ": rest lengths", state.rest_lengths, segments);
  check_all(name + ": tension", state.tension, segments);
  for (const double length : state.rest_lengths) require(length > 0, name + ": rest lengths are positive");
  for (const double mass : state.masses) require(mass > 0, name + ": masses are positive");
  check_all(name + ": curvature", node_curvature(state), segments - 1);
  check_all(name + ": twist", node_twist(state), segments - 1);
  for (const Quaternion& q : segment_orientations(state)) check_finite(name + ": orientation", Pose{Vector3::Zero(), q});
  std::vector<JointView> joints;
  world.view_joints(index, joints);
  for (const JointView& joint : joints) check_finite(name + ": joint", Vector3(joint.arc_length, joint.curvature, joint.twist));
}

void check_net(const SimulatedNet& net) {
  const int nodes = net.model.nodes();
  check_all(net.model.name + ": positions", net.state.positions, nodes);
  check_all(net.model.name + ": velocities", net.state.velocities, nodes);
  check_all(net.model.name + ": tension", net.state.tension, static_cast<int>(net.model.links.size()));
}

bool is_index(int index, std::size_t size) {
  return index >= 0 && index < static_cast<int>(size);
}

bool is_there(const World& world, const BodyId& body) {
  switch (body.kind) {
    case BodyId::Kind::none:
      return true;
    case BodyId::Kind::cable:
      return is_index(body.index, world.cables().size());
    case BodyId::Kind::net:
      return is_index(body.index, world.nets().size());
    case BodyId::Kind::particle:
      return is_index(body.index, world.particles().size());
    case BodyId::Kind::rigid_body:
      return is_index(body.index, world.bodies().size());
  }
  return false;
}

void check_findings(const World& world) {
  const Findings& findings = world.findings();
  const auto is_segment = [&](int cable, int segment) {
    return is_index(cable, world.cables().size()) && is_index(segment, world.cables()[cable].state.rest_lengths.size());
  };
  for (const Break& gone : findings.breaks)
    require(is_index(gone.cable, world.cables().size()) && is_index(gone.new_cable, world.cables().size()) && gone.limit > 0,
            "what broke is there");
  for (const Excursion& excursion : findings.excursions) {
    require(is_index(excursion.cable, world.cables().size()) &&
                is_index(excursion.node, world.cables()[excursion.cable].state.positions.size()),
            "what bends is there");
    check_finite("excursion", excursion.value);
  }
  for (const std::vector<int>* guides : {&findings.caught, &findings.released})
    for (const int guide : *guides) require(is_index(guide, world.guides().size()), "what caught or let go is there");
  for (const Jump& jump : findings.jumps) {
    require(is_index(jump.attachment, world.attachments().size()), "what jumped is there");
    check_finite("jump", Vector3(jump.distance, jump.time, jump.duration));
  }
  for (const Intrusion& intrusion : findings.intrusions) {
    require(is_segment(intrusion.cable, intrusion.segment) && is_index(intrusion.obstacle, world.obstacles().size()),
            "what is inside of what is there");
    check_finite("depth", intrusion.depth);
  }
  for (const SimulatedContact& contact : findings.contacts) {
    require(is_segment(contact.cable, contact.segment), "what touches is there");
    if (contact.obstacle >= 0) require(is_index(contact.obstacle, world.obstacles().size()), "the touched obstacle is there");
    if (contact.other_cable >= 0) require(is_segment(contact.other_cable, contact.other_segment), "the touched cable is there");
    if (contact.body >= 0) require(is_index(contact.body, world.bodies().size()), "the touched body is there");
    check_finite("contact position", contact.position);
    check_finite("contact normal", contact.normal);
    check_finite("contact force", contact.force);
  }
}

void check_attachment(const World& world, const Attachment& attachment) {
  check_finite(attachment.name + ": force", attachment.force);
  check_finite(attachment.name + ": torque", attachment.torque);
  check_finite(attachment.name + ": pose", attachment.pose);
  for (const Vector3& point : attachment.tangent_points) check_finite(attachment.name + ": tangent point", point);
  require(is_index(attachment.frame, world.frames().size()), attachment.name + ": its frame is there");
  const BodyId& body = attachment.body;
  if (body.is_cable())
    require(is_index(body.index, world.cables().size()) &&
                is_index(attachment.node, world.cables()[body.index].state.positions.size()),
            attachment.name + ": its node is there");
  if (body.is_net())
    require(
        is_index(body.index, world.nets().size()) && is_index(attachment.node, world.nets()[body.index].state.positions.size()),
        attachment.name + ": its node is there");
  if (body.is_rigid_body()) require(is_index(body.index, world.bodies().size()), attachment.name + ": its body is there");
}

}  // namespace

void check_world(const World& world) {
  const std::string violated = violation(WorldInspector::state(world));
  require(violated.empty(), violated);
  for (int cable = 0; cable < static_cast<int>(world.cables().size()); ++cable) check_cable(world, cable);
  for (const SimulatedNet& net : world.nets()) check_net(net);
  for (const SimulatedParticle& particle : world.particles()) {
    check_finite(particle.desc.name + ": position", particle.position);
    check_finite(particle.desc.name + ": velocity", particle.velocity);
  }
  for (const SimulatedBody& body : world.bodies()) {
    check_finite(body.name + ": pose", body.pose);
    check_finite(body.name + ": velocity", body.velocity);
    check_finite(body.name + ": angular velocity", body.angular_velocity);
  }
  for (const Attachment& attachment : world.attachments()) check_attachment(world, attachment);
  for (int guide = 0; guide < static_cast<int>(world.guides().size()); ++guide) {
    const GuideView view = world.view_guide(guide);
    check_finite(world.guides()[guide].name, Vector3(view.arc_length, view.tension[0], view.tension[1]));
  }
  check_findings(world);
  check_finite("energy", world.energy().total());
  check_finite("time", world.time());
}

void check_result(const World& world, const StepResult& result) {
  check_finite("strain", result.max_strain);
  require(result.status != StepResult::Status::fault, "no cable is stopped by a fault");
  require(result.status == StepResult::Status::ok || bool(result.body), "what is not well is named");
  require(is_there(world, result.body), "what is not well is there");
  require(result.ignored_frame < static_cast<int>(world.frames().size()), "the ignored frame is there");
}

double mass(const World& world) {
  double sum = 0;
  for (const SimulatedCable& cable : world.cables())
    for (const double mass : cable.state.masses) sum += mass;
  for (const SimulatedNet& net : world.nets())
    for (const double mass : net.model.masses) sum += mass;
  for (const SimulatedBody& body : world.bodies()) sum += body.mass;
  return sum;
}

}  // namespace verlet_cable::fuzz
