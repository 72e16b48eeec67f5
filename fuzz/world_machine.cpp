#include "world_machine.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

#include "check_world.h"
#include "require.h"

namespace verlet_cable::fuzz {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

bool has_winch_or_break(const World& before, const World& after) {
  return before.cables().size() != after.cables().size() || !after.findings().breaks.empty();
}

}  // namespace

WorldMachine::WorldMachine(const SceneDesc& scene, FuzzedDataProvider& input)
    : input_(input),
      scene_(scene),
      frames_(initial_frames(scene)),
      world_(scene, frames_),
      saved_(world_),
      saved_frames_(frames_) {
  check_world(world_);
}

void WorldMachine::act() {
  switch (input_.ConsumeIntegralInRange(0, 15)) {
    case 0:
    case 1:
      move_frames();
      break;
    case 2:
    case 3:
      step(input_.ConsumeIntegralInRange(1, 5));
      break;
    case 4:
      step_copy_alike();
      break;
    case 5:
      pin();
      break;
    case 6:
      apply(edit::Unpin{any_name(attachment_names())});
      break;
    case 7:
      apply(edit::MoveAttachment{any_name(attachment_names()), any_pose()});
      break;
    case 8: {
      const BodyId body = any_body();
      apply(edit::Cut{body, any_node(body)});
      break;
    }
    case 9:
      apply(edit::SetLength{any_body().index, input_.ConsumeBool(), std::abs(any_number()), std::abs(any_number())});
      break;
    case 10: {
      const int first = any_body().index;
      apply(edit::Join{first, input_.ConsumeBool(), any_body().index, input_.ConsumeBool()});
      break;
    }
    case 11:
      set_obstacle();
      break;
    case 12:
      apply(edit::RemoveObstacle{any_name(obstacle_names())});
      break;
    case 13:
      tune();
      break;
    case 14:
      world_.settle();
      break;
    default:
      put_back();
  }
  check_world(world_);
}

void WorldMachine::move_frames() {
  if (frames_.empty()) return;
  FrameInput& frame = frames_[input_.ConsumeIntegralInRange<std::size_t>(0, frames_.size() - 1)];
  switch (input_.ConsumeIntegralInRange(0, 5)) {
    case 0:
    case 1:  // a hand
      frame.pose.position += 1e-3 * any_vector();
      break;
    case 2:  // a jump
      frame.pose = any_pose();
      break;
    case 3:
      frame.pose.position[input_.ConsumeIntegralInRange(0, 2)] = input_.ConsumeBool() ? not_a_number : infinity;
      break;
    case 4:
      frame.known = !frame.known;
      break;
    default:
      frame.pose.orientation = Quaternion(any_number(), any_number(), any_number(), any_number());
  }
}

void WorldMachine::step(int steps) {
  for (int i = 0; i < steps; ++i) {
    const double others = mass(world_) - mass_of_length(world_), all = mass(world_);
    const World before = world_;
    world_.start_waiting(frames_);
    const bool began = before.cables().size() != world_.cables().size() || before.nets().size() != world_.nets().size();
    frames_.resize(world_.frames().size());
    const StepResult result = world_.step(frames_);
    require(std::isfinite(result.max_strain), "strain is finite");
    check_world(world_);
    if (began || has_winch_or_break(before, world_)) continue;
    require(std::abs(mass(world_) - mass_of_length(world_) - others) < 1e-6 * all, "a step keeps mass, but for winches");
  }
}

void WorldMachine::step_copy_alike() {
  World copy = world_;
  require(copy.hash() == world_.hash(), "a copy has the same bytes");
  copy.step_one_by_one(input_.ConsumeBool());
  copy.limit_lanes(1 << input_.ConsumeIntegralInRange(0, 3));
  for (int i = 0; i < 2; ++i) {
    frames_.resize(world_.frames().size());
    copy.step(frames_);
    world_.step(frames_);
    require(copy.hash() == world_.hash(), "a copy goes on with the same bytes");
  }
}

void WorldMachine::apply(const Edit& edit) {
  const std::uint64_t before = world_.hash();
  const double mass_before = mass(world_);
  const EditResult result = world_.apply(edit);
  if (!result.ok) {
    require(world_.hash() == before, "a refused edit changes nothing: " + result.message);
    require(!result.message.empty(), "a refused edit says why");
  }
  require(std::abs(mass(world_) - mass_before) <= 1e-9 * mass_before, "an edit keeps mass");
}

void WorldMachine::pin() {
  edit::Pin pin;
  if (input_.ConsumeBool()) pin.name = "grip";
  pin.body = any_body();
  pin.node = any_node(pin.body);
  pin.type = input_.PickValueInArray({AttachmentType::hinge, AttachmentType::clamp, AttachmentType::axle});
  pin.pose = any_pose();
  pin.frame = input_.ConsumeBool() ? world_.add_frame("added", any_pose())
                                   : input_.ConsumeIntegralInRange(-1, static_cast<int>(world_.frames().size()));
  apply(pin);
}

void WorldMachine::set_obstacle() {
  Obstacle obstacle;
  obstacle.name = input_.PickValueInArray({"block", "ball", "floor"});
  obstacle.frame = input_.ConsumeIntegralInRange(0, static_cast<int>(world_.frames().size()) - 1);
  obstacle.pose = any_pose();
  const double radius = input_.ConsumeFloatingPointInRange(1e-3, 1.0), length = input_.ConsumeFloatingPointInRange(1e-3, 1.0);
  switch (input_.ConsumeIntegralInRange(0, 4)) {
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
    default:
      obstacle.shape = BoxShape{{radius, length, radius}};
  }
  apply(edit::SetObstacle{obstacle});
}

void WorldMachine::tune() {
  SceneDesc tuned = scene_;
  tuned.gravity.acceleration = any_vector();
  tuned.fluid.velocity = any_vector();
  tuned.fluid.density = std::abs(any_number());
  for (NamedMaterial& material : tuned.materials) {
    material.material.bending_stiffness = BendingStiffness(std::abs(any_number()));
    material.material.bending_damping = std::abs(any_number());
    material.material.torsional_stiffness = std::abs(any_number());
    material.material.friction = std::abs(any_number());
    material.material.drag = std::abs(any_number());
  }
  if (!validate(tuned).empty()) return;
  const std::uint64_t before = world_.hash();
  try {
    world_.tune(tuned);
    scene_ = tuned;
  } catch (const SceneError&) {
    require(world_.hash() == before, "refused tuning changes nothing");
  }
}

void WorldMachine::put_back() {
  if (input_.ConsumeBool()) {
    saved_ = world_;
    saved_frames_ = frames_;
  } else {
    world_ = saved_;
    frames_ = saved_frames_;
  }
}

BodyId WorldMachine::any_body() {
  const int index = input_.ConsumeIntegralInRange(-1, 6);
  switch (input_.ConsumeIntegralInRange(0, 5)) {
    case 0:
      return net_id(index);
    case 1:
      return rigid_body_id(index);
    case 2:
      return particle_id(index);
    default:
      return cable_id(std::min(index, static_cast<int>(world_.cables().size()) - 1));
  }
}

int WorldMachine::any_node(const BodyId& body) {
  if (input_.ConsumeProbability<float>() < 0.05F) return input_.ConsumeIntegral<int>();
  int most = 12;
  if (body.is_cable() && body.index >= 0) most = world_.cables()[body.index].state.segments();
  return input_.ConsumeIntegralInRange(0, most);
}

std::string WorldMachine::any_name(const std::vector<std::string>& names) {
  const std::size_t index = input_.ConsumeIntegralInRange<std::size_t>(0, names.size());
  return index < names.size() ? names[index] : "nobody";
}

std::vector<std::string> WorldMachine::attachment_names() const {
  std::vector<std::string> names;
  for (const Attachment& attachment : world_.attachments()) names.push_back(attachment.name);
  return names;
}

std::vector<std::string> WorldMachine::obstacle_names() const {
  std::vector<std::string> names;
  for (const Obstacle& obstacle : world_.obstacles()) names.push_back(obstacle.name);
  return names;
}

/// Mostly of the size of what is simulated, sometimes none that any program should be given.
double WorldMachine::any_number() {
  constexpr std::array<double, 8> odd{0, not_a_number, infinity, -infinity, 1e300, -1e9, 1e-300, 1e12};
  if (input_.ConsumeIntegralInRange(0, 15) == 0) return input_.PickValueInArray(odd);
  return input_.ConsumeFloatingPointInRange(-4.0, 4.0);
}

double WorldMachine::any_coordinate() {
  return input_.ConsumeFloatingPointInRange(-3.0, 3.0);
}

Vector3 WorldMachine::any_vector() {
  if (input_.ConsumeIntegralInRange(0, 15) == 0) return {any_number(), any_number(), any_number()};
  return {any_coordinate(), any_coordinate(), any_coordinate()};
}

Pose WorldMachine::any_pose() {
  return {any_vector(), quaternion_from_rpy({any_coordinate(), any_coordinate(), any_coordinate()})};
}

}  // namespace verlet_cable::fuzz
