#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "check_world.h"
#include "require.h"
#include "verlet_cable/core/triangle_mesh.h"
#include "world_machine.h"

// The edits of a WorldMachine.

namespace verlet_cable::fuzz {
namespace {

/// None, where the lengths are none.
std::shared_ptr<const TriangleMesh> tetrahedron(double width, double height) {
  const std::vector<Vector3> vertices = {Vector3::Zero(), {width, 0, 0}, {0, width, 0}, {0, 0, height}};
  const std::vector<TriangleMesh::Triangle> triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const bool is_solid = TriangleMesh::problem(vertices, triangles).empty();
  return is_solid ? std::make_shared<TriangleMesh>(vertices, triangles) : nullptr;
}

}  // namespace

void WorldMachine::apply(const Edit& edit) {
  const std::uint64_t before = world_.hash();
  const double mass_before = mass(world_);
  const EditResult result = on_both([&](World& world) { return world.apply(edit); });
  if (!result.ok) {
    require(world_.hash() == before, "a refused edit changes nothing: " + result.message);
    require(!result.message.empty(), "a refused edit says why");
  }
  require(std::abs(mass(world_) - mass_before) <= 1e-9 * mass_before, "an edit keeps mass");
}

void WorldMachine::pin() {
  edit::Pin pin;
  if (input_.below(4) == 0) pin.name = "grip";
  pin.body = any_body();
  pin.node = any_node(pin.body);
  pin.type = input_.one_of({AttachmentType::hinge, AttachmentType::clamp, AttachmentType::axle});
  const Pose in_world = input_.pose(place_of(pin.body, pin.node), input_.one_of({0.0, 0.02, 0.5}));
  if (input_.below(4) == 0) {
    pin.frame = on_both([&](World& world) { return world.add_frame("added", in_world); });
  } else {
    pin.frame = any_frame();
  }
  const bool has_pose = pin.frame >= 0 && pin.frame < static_cast<int>(world_.frames().size()) && world_.frame_known(pin.frame);
  pin.pose = has_pose ? world_.frame_pose(pin.frame).inverse() * in_world : in_world;
  apply(pin);
}

void WorldMachine::unpin() {
  apply(edit::Unpin{input_.one_of(attachment_names())});
}

void WorldMachine::move_attachment() {
  edit::MoveAttachment move;
  move.name = input_.one_of(attachment_names());
  const int index = find(world_.attachments(), move.name);
  const Vector3 now = index < 0 ? Vector3::Zero() : world_.attachments()[index].pose.position;
  move.pose = input_.pose(now, input_.one_of({0.01, 0.1, 1.0}));
  apply(move);
}

void WorldMachine::cut() {
  edit::Cut cut;
  cut.body = any_body();
  if (cut.body.is_rigid_body()) cut.body = cable_id(any_cable());
  cut.element = any_node(cut.body);
  apply(cut);
}

void WorldMachine::set_length() {
  edit::SetLength change;
  change.cable = any_cable();
  change.at_end = input_.flip();
  const bool is_there = change.cable >= 0 && change.cable < static_cast<int>(world_.cables().size());
  const double length = is_there ? world_.cables()[change.cable].state.length() : 1;
  change.length = input_.positive(0.7 * length, 1.5 * length);
  change.speed = input_.positive(0.1, 4);
  const double speed = change.speed;
  const EditResult result = on_both([&](World& world) { return world.apply(change); });
  if (result.ok) winch_speed_ = std::max(winch_speed_, speed);
}

void WorldMachine::set_tension() {
  edit::SetTension change;
  change.cable = any_cable();
  change.at_end = input_.flip();
  const bool is_there = change.cable >= 0 && change.cable < static_cast<int>(world_.cables().size());
  const double length = is_there ? world_.cables()[change.cable].state.length() : 1;
  if (input_.flip()) change.tension = input_.positive(0.1, 100);
  change.max_speed = input_.positive(0.1, 4);
  change.min_length = input_.positive(0.2 * length, length);
  change.max_length = input_.positive(length, 2 * length);
  const double speed = change.max_speed;
  const EditResult result = on_both([&](World& world) { return world.apply(change); });
  if (result.ok) winch_speed_ = std::max(winch_speed_, speed);
}

void WorldMachine::join() {
  edit::Join join;
  join.first = any_cable();
  // Of one material, where there is one: the others are refused.
  std::vector<int> alike;
  const std::vector<SimulatedCable>& cables = world_.cables();
  if (join.first >= 0 && join.first < static_cast<int>(cables.size()))
    for (int i = 0; i < static_cast<int>(cables.size()); ++i)
      if (i != join.first && cables[i].model->material_name == cables[join.first].model->material_name) alike.push_back(i);
  join.second = alike.empty() || input_.is_odd() ? any_cable() : alike[input_.below(static_cast<int>(alike.size()))];
  join.first_at_end = input_.flip();
  join.second_at_end = input_.flip();
  apply(join);
}

/// Some times over, with whatever else may happen to the pieces in between.
void WorldMachine::cut_and_join() {
  void (WorldMachine::*const between[])() = {&WorldMachine::step_some,      &WorldMachine::step_some, &WorldMachine::pin,
                                             &WorldMachine::unpin,          &WorldMachine::tune,      &WorldMachine::set_length,
                                             &WorldMachine::save_or_restore};
  for (int rounds = input_.one_of({1, 2, 4}); rounds > 0 && !is_tired(); --rounds) {
    for (const auto act : {&WorldMachine::cut, input_.one_of(between), &WorldMachine::join, input_.one_of(between)}) {
      (this->*act)();
      check_world(world_);
    }
  }
}

void WorldMachine::set_obstacle() {
  Obstacle obstacle;
  obstacle.name = input_.one_of({"block", "ball", "floor"});
  obstacle.frame = any_frame();
  obstacle.pose = input_.pose(Vector3::Zero(), input_.one_of({0.1, 1.0}));
  if (input_.flip()) obstacle.friction = input_.positive(0.01, 2);
  if (input_.flip()) obstacle.padding = input_.positive(1e-4, 0.1);
  const double radius = input_.positive(0.01, 0.5), length = input_.positive(0.01, 1);
  switch (input_.below(6)) {
    case 0:
      obstacle.shape = PlaneShape{};
      break;
    case 1:
      obstacle.shape = SphereShape{radius};
      break;
    case 2:
      obstacle.shape = CapsuleShape{radius, length};
      break;
    case 3:
      obstacle.shape = CylinderShape{radius, length};
      break;
    case 4:
      obstacle.shape = MeshShape{tetrahedron(radius, length)};
      break;
    default:
      obstacle.shape = BoxShape{{radius, length, radius}};
  }
  apply(edit::SetObstacle{obstacle});
}

void WorldMachine::remove_obstacle() {
  std::vector<std::string> names;
  for (const Obstacle& obstacle : world_.obstacles()) names.push_back(obstacle.name);
  apply(edit::RemoveObstacle{input_.one_of(names)});
}

void WorldMachine::tune() {
  SceneDesc tuned = scene_;
  if (input_.flip()) tuned.gravity.acceleration = input_.vector(15);
  if (input_.flip()) tuned.fluid.velocity = input_.vector(2);
  if (input_.flip()) tuned.fluid.density = input_.positive(0.1, 1500);
  for (NamedMaterial& named : tuned.materials) {
    MaterialDesc& material = named.material;
    const double stiffness = input_.positive(1e-5, 0.1);
    switch (input_.below(8)) {
      case 0:
        material.bending_stiffness = BendingStiffness(stiffness);
        break;
      case 1:
        material.torsional_stiffness = stiffness;
        break;
      case 2:
        material.bending_damping = 0.01 * stiffness;
        break;
      case 3:
        material.friction = 10 * stiffness;
        break;
      case 4:
        material.drag = 10 * stiffness;
        break;
      case 5:
        material.yield_curvature = 1000 * stiffness;
        material.hardening = 10 * stiffness;
        break;
      case 6:
        material.bending_friction = 0.1 * stiffness;
        break;
      default:
        material.radius = 0.1 * stiffness;
    }
  }
  if (!validate(tuned).empty()) return;
  const std::uint64_t before = world_.hash();
  const auto is_taken_over = [&](World& world) {
    try {
      world.tune(tuned);
      return true;
    } catch (const SceneError&) {
      return false;
    }
  };
  if (!on_both(is_taken_over)) require(world_.hash() == before, "refused tuning changes nothing");
}

void WorldMachine::apply_load() {
  edit::ApplyLoad load;
  if (input_.below(4) != 0) load.name = input_.one_of({"push", "pull"});
  load.body = any_body();
  load.node = any_node(load.body);
  if (input_.flip()) load.force = input_.vector(input_.one_of({0.1, 10.0, 1000.0}));
  if (load.body.is_rigid_body() || input_.is_odd()) {
    if (input_.flip()) load.point = input_.vector(0.2);
    if (input_.flip()) load.torque = input_.vector(1);
    load.is_local = input_.flip();
  }
  if (input_.flip()) load.duration = input_.positive(1e-4, 0.1);
  apply(load);
}

/// A vector for each of those, as far from it as that; oddly, one more.
std::vector<Vector3> WorldMachine::any_vectors(const std::vector<Vector3>& near, double most_away) {
  std::vector<Vector3> vectors = near;
  const Vector3 all = input_.vector(most_away);
  for (Vector3& vector : vectors) vector += all;
  if (!vectors.empty() && input_.flip()) vectors[input_.below(static_cast<int>(vectors.size()))] += input_.vector(most_away);
  if (input_.is_odd()) vectors.push_back(all);
  return vectors;
}

edit::SetState::OfCable WorldMachine::any_cable_state() {
  edit::SetState::OfCable change;
  change.cable = any_cable();
  const bool is_there = change.cable >= 0 && change.cable < static_cast<int>(world_.cables().size());
  const CableState none, &cable = is_there ? world_.cables()[change.cable].state : none;
  if (input_.flip()) change.positions = any_vectors(cable.positions, input_.one_of({0.001, 0.1, 2.0}));
  if (input_.flip()) change.velocities = any_vectors(cable.velocities, input_.one_of({0.01, 1.0, 10.0}));
  return change;
}

edit::SetState::OfBody WorldMachine::any_body_state() {
  edit::SetState::OfBody change;
  change.body = input_.index(world_.bodies().size());
  const bool is_there = change.body >= 0 && change.body < static_cast<int>(world_.bodies().size());
  const Vector3 now = is_there ? place_of(rigid_body_id(change.body), 0) : Vector3::Zero();
  if (input_.flip()) change.pose = input_.pose(now, input_.one_of({0.001, 0.1, 1.0}));
  if (input_.flip()) change.velocity = input_.vector(4);
  if (input_.flip()) change.angular_velocity = input_.vector(10);
  return change;
}

void WorldMachine::set_state() {
  edit::SetState change;
  const int kinds = 1 + input_.below(7);
  if (kinds & 1) change.cables.push_back(any_cable_state());
  if (kinds & 2) change.bodies.push_back(any_body_state());
  if (kinds & 4) change.guides.push_back({input_.index(world_.guides().size()), input_.positive(0.01, 1)});
  if (input_.is_odd()) change.cables.push_back(any_cable_state());
  apply(change);
}

}  // namespace verlet_cable::fuzz
