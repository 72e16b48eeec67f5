#include "world_machine.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>

#include "check_world.h"
#include "require.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/triangle_mesh.h"

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

WorldMachine::WorldMachine(const SceneDesc& scene, const World& world, Arbitrary& input)
    : input_(input), scene_(scene), frames_(initial_frames(scene)), world_(world), saved_(world), saved_frames_(frames_) {
  check_world(world_);
}

void WorldMachine::act() {
  using Machine = WorldMachine;
  // What is to happen more often is there more often.
  void (Machine::*const acts[])() = {
      &Machine::step_some,
      &Machine::step_some,
      &Machine::step_some,
      &Machine::step_some,
      &Machine::step_some,
      &Machine::move_frame,
      &Machine::move_frame,
      &Machine::move_frame,
      &Machine::disturb_frame,
      &Machine::start_waiting,
      &Machine::settle,
      &Machine::copy,
      &Machine::save_or_restore,
      &Machine::pin,
      &Machine::pin,
      &Machine::unpin,
      &Machine::move_attachment,
      &Machine::cut,
      &Machine::cut,
      &Machine::set_length,
      &Machine::set_length,
      &Machine::join,
      &Machine::join,
      &Machine::join,
      &Machine::set_obstacle,
      &Machine::remove_obstacle,
      &Machine::tune,
  };
  (this->*input_.one_of(acts))();
  check_world(world_);
}

template <class Call>
auto WorldMachine::on_both(const Call& call) {
  const auto and_compare = [&] {
    if (!copy_) return;
    call(*copy_);
    require(copy_->hash() == world_.hash(), "a copy goes on with the same bytes");
  };
  if constexpr (std::is_void_v<decltype(call(world_))>) {
    call(world_);
    and_compare();
  } else {
    const auto result = call(world_);
    and_compare();
    return result;
  }
}

/// As a hand does, until it is told otherwise.
void WorldMachine::move_frame() {
  if (frames_.empty()) return;
  moving_frame_ = input_.below(static_cast<int>(frames_.size()));
  velocity_ = input_.vector(input_.one_of({0.0, 0.2, 1.0, 4.0}));
}

void WorldMachine::disturb_frame() {
  if (frames_.empty()) return;
  FrameInput& frame = frames_[input_.below(static_cast<int>(frames_.size()))];
  switch (input_.below(5)) {
    case 0:
      frame.pose = input_.pose(frame.pose.position, 2);
      break;
    case 1:
      frame.pose.position[input_.below(3)] = input_.flip() ? std::numeric_limits<double>::quiet_NaN() : infinity;
      break;
    case 2:
      frame.pose.orientation = Quaternion{input_.between(-2, 2), input_.between(-2, 2), 0, 0};
      break;
    case 3:
      frame.velocity = FrameVelocity{input_.vector(4), input_.vector(10)};
      break;
    default:
      frame.known = !frame.known;
  }
}

void WorldMachine::step_some() {
  for (int steps = input_.one_of({1, 3, 10, 30}); steps > 0 && !is_tired(); --steps) {
    step();
    check_world(world_);
  }
}

void WorldMachine::step() {
  for (int i = static_cast<int>(frames_.size()); i < static_cast<int>(world_.frames().size()); ++i)
    frames_.push_back({world_.frame_pose(i), world_.frame_known(i)});
  if (moving_frame_ < frames_.size()) frames_[moving_frame_].pose.position += world_.time_step() * velocity_;
  const double before = mass(world_), wound = most_wound();
  const StepResult result = on_both([&](World& world) { return world.step(frames_); });
  effort_ += result.substeps + result.iterations;
  check_result(world_, result);
  require(std::abs(mass(world_) - before) <= wound + 1e-9 * before, "a step keeps mass, but for winches");
}

double WorldMachine::most_wound() const {
  if (winch_speed_ == 0) return 0;
  double most = 0;
  for (const SimulatedCable& cable : world_.cables()) {
    const CableMaterials materials(cable);
    const double density = materials.largest([](const MaterialDesc& material) { return material.linear_density; });
    // Twice the speed, as it gives back what bent places lost; and segments that are taken in become of their neighbour's
    // material.
    const double length = 2 * winch_speed_ * world_.time_step() + (materials.vary() ? 1.5 * cable.model->segment_length : 0);
    most += density * length;
  }
  return most;
}

void WorldMachine::start_waiting() {
  on_both([&](World& world) { return world.start_waiting(frames_); });
}

/// As much work as many steps, which bodies multiply: not in each input.
void WorldMachine::settle() {
  if (input_.below(world_.bodies().empty() ? 4 : 8) != 0) return;
  effort_ += most_effort / 2;
  on_both([&](World& world) { return world.settle(); });
}

void WorldMachine::copy() {
  copy_ = world_;
  require(copy_->hash() == world_.hash(), "a copy has the same bytes");
  if (input_.flip()) {
    World moved(std::move(*copy_));
    *copy_ = std::move(moved);
    require(copy_->hash() == world_.hash(), "what is moved has the same bytes");
  }
  copy_->step_one_by_one(input_.flip());
  copy_->limit_lanes(input_.one_of({1, 2, 4, 8}));
}

void WorldMachine::save_or_restore() {
  if (input_.flip()) {
    saved_ = world_;
    saved_frames_ = frames_;
  } else {
    world_ = saved_;
    frames_ = saved_frames_;
    copy_.reset();
  }
}

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
    switch (input_.below(6)) {
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

BodyId WorldMachine::any_body() {
  const int kind = input_.below(8);
  if (kind == 0 && !world_.nets().empty()) return net_id(input_.index(world_.nets().size()));
  if (kind == 1 && !world_.bodies().empty()) return rigid_body_id(input_.index(world_.bodies().size()));
  if (input_.is_odd()) return particle_id(input_.index(world_.particles().size()));
  return world_.cables().empty() && !world_.nets().empty() ? net_id(input_.index(world_.nets().size())) : cable_id(any_cable());
}

int WorldMachine::any_cable() {
  return input_.index(world_.cables().size());
}

int WorldMachine::any_frame() {
  return input_.flip() ? 0 : input_.index(world_.frames().size());
}

int WorldMachine::any_node(const BodyId& body) {
  const auto is_in = [&](std::size_t size) { return body.index >= 0 && body.index < static_cast<int>(size); };
  if (body.is_cable() && is_in(world_.cables().size())) return input_.index(world_.cables()[body.index].state.nodes());
  if (body.is_net() && is_in(world_.nets().size())) return input_.index(world_.nets()[body.index].state.positions.size());
  return input_.index(1);
}

Vector3 WorldMachine::place_of(const BodyId& body, int node) const {
  const auto is_in = [](int index, std::size_t size) { return index >= 0 && index < static_cast<int>(size); };
  if (body.is_cable() && is_in(body.index, world_.cables().size())) {
    const std::vector<Vector3>& positions = world_.cables()[body.index].state.positions;
    if (is_in(node, positions.size())) return positions[node];
  }
  if (body.is_net() && is_in(body.index, world_.nets().size())) {
    const std::vector<Vector3>& positions = world_.nets()[body.index].state.positions;
    if (is_in(node, positions.size())) return positions[node];
  }
  if (body.is_rigid_body() && is_in(body.index, world_.bodies().size())) return world_.bodies()[body.index].pose.position;
  return Vector3::Zero();
}

std::vector<std::string> WorldMachine::attachment_names() const {
  std::vector<std::string> names;
  for (const Attachment& attachment : world_.attachments()) names.push_back(attachment.name);
  return names;
}

}  // namespace verlet_cable::fuzz
