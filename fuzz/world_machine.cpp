#include "world_machine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "check_world.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable::fuzz {

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
      &Machine::reset,
      &Machine::pin,
      &Machine::pin,
      &Machine::unpin,
      &Machine::move_attachment,
      &Machine::cut,
      &Machine::cut,
      &Machine::set_length,
      &Machine::set_tension,
      &Machine::join,
      &Machine::join,
      &Machine::join,
      &Machine::cut_and_join,
      &Machine::cut_and_join,
      &Machine::set_obstacle,
      &Machine::remove_obstacle,
      &Machine::tune,
      &Machine::apply_load,
      &Machine::set_state,
  };
  (this->*input_.one_of(acts))();
  check_world(world_);
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

/// As much work as many steps, like settling: not in each input.
void WorldMachine::reset() {
  if (input_.below(world_.bodies().empty() ? 4 : 8) != 0) return;
  effort_ += most_effort / 2;
  frames_.resize(initial_frames(scene_).size());
  world_ = World(scene_, frames_);
  copy_.reset();
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
