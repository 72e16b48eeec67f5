// Prints a line for each scene of the benchmarks: the bytes of every node's place and velocity on the way, summed up. Two builds
// that print the same compute the same; scripts/same_bytes compares them.

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <string>

#include "contact_scenes.h"
#include "hand.h"
#include "nets.h"
#include "scenes.h"

namespace verlet_cable::bench {

namespace {

constexpr double pi = 3.14159265358979323846;

/// FNV-1a.
class Digest {
 public:
  void add(const Vector3& v) {
    for (const double value : v) {
      std::uint64_t bits;
      std::memcpy(&bits, &value, sizeof bits);
      for (int i = 0; i < 8; ++i) value_ = (value_ ^ ((bits >> (8 * i)) & 0xff)) * 1099511628211ull;
    }
  }
  void add(const std::vector<Vector3>& vectors) {
    for (const Vector3& v : vectors) add(v);
  }
  void add(const World& world) {
    for (const SimulatedCable& cable : world.cables()) {
      add(cable.state.positions);
      add(cable.state.velocities);
      for (const double tension : cable.state.tension) add({tension, 0, 0});
    }
    for (const SimulatedNet& net : world.nets()) {
      add(net.state.positions);
      add(net.state.velocities);
    }
    for (const SimulatedParticle& particle : world.particles()) {
      add(particle.position);
      add(particle.velocity);
    }
    for (const Attachment& attachment : world.attachments()) {
      add(attachment.force);
      add(attachment.torque);
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037ull;
};

using Drive = std::function<void(World&, BoundaryInputs&, int)>;

void stand(World&, BoundaryInputs&, int) {}

void print(const std::string& name, SceneDesc scene, BoundaryInputs inputs, int steps, bool settle = false,
           const Drive& drive = stand) {
  World world(scene, inputs);
  if (settle) world.settle();
  Digest digest;
  digest.add(world);
  for (int i = 0; i < steps; ++i) {
    drive(world, inputs, i);
    inputs.resize(world.frames().size());
    world.step(inputs);
    digest.add(world);
  }
  std::printf("%s %d %016" PRIx64 "\n", name.c_str(), steps, digest.value());
}

void print(const std::string& name, const SceneDesc& scene, int steps, bool settle = false, const Drive& drive = stand) {
  print(name, scene, initial_frames(scene), steps, settle, drive);
}

/// The driven hand turns, too, and jumps once.
void wave(World& world, BoundaryInputs& inputs, int i) {
  const double t = world.time() + world.time_step();
  inputs[1].pose.position = driven_hand(t);
  if (i > 150) inputs[1].pose.position.z() += 0.05;
  inputs[1].pose.orientation = Eigen::AngleAxisd(std::sin(2 * pi * t), Vector3::UnitX());
}

void print_driven() {
  for (const double bending_stiffness : {0.0, 1e-3, 1e-2, 1.0})
    for (const double axial_stiffness : {infinity, 5000.0})
      for (const bool curved : {false, true}) {
        SceneDesc scene = scenes::held_by_a_hand(40, AttachmentType::clamp);
        MaterialDesc& material = scene.materials[0].material;
        material.bending_stiffness = bending_stiffness;
        material.torsional_stiffness = 0.75 * bending_stiffness;
        material.bending_damping = 0.01 * bending_stiffness;
        material.axial_stiffness = axial_stiffness;
        material.drag = 0.05;
        if (curved && bending_stiffness > 0) {
          scene.cables[0].rest_curvature.type = RestCurvatureDesc::Type::constant;
          scene.cables[0].rest_curvature.curvature = {2, -1};
        }
        print("driven EI=" + std::to_string(bending_stiffness) + " EA=" + std::to_string(axial_stiffness) +
                  (curved ? " curved" : ""),
              scene, scenes::hand_at(driven_hand(0)), 300, bending_stiffness > 0, wave);
      }
}

void print_released() {
  for (const double angle : {pi / 9, 0.5 * pi})
    for (const double time_step : {1e-3, 5e-3}) {
      SceneDesc scene = scenes::released(60, angle);
      scene.time_step = time_step;
      print("released " + std::to_string(angle) + " " + std::to_string(time_step), scene, 200);
    }
}

void print_contacts() {
  print("capstan", capstan(0.3, pi, 60), 200, false, [](World& world, BoundaryInputs& frames, int) {
    frames[1].pose.position -= 0.1 * world.time_step() * capstan_first_pull();
    frames[2].pose.position += 0.1 * world.time_step() * capstan_second_pull(pi);
  });
  for (const ShapeType type :
       {ShapeType::plane, ShapeType::sphere, ShapeType::capsule, ShapeType::cylinder, ShapeType::box, ShapeType::mesh})
    for (const int number : {1, 2})
      print("drop " + std::to_string(static_cast<int>(type)) + " " + std::to_string(number), drop(type, number), 500);
  print("coils", coils(150, true), 150);
  print("crosswise", crosswise(4, 30), 400);
  print("knot", overhand_knot(0.2, 80), 150, false, [](World& world, BoundaryInputs& frames, int) {
    frames[1].pose.position.x() -= 0.2 * world.time_step();
    frames[2].pose.position.x() += 0.2 * world.time_step();
  });
}

void print_nets() {
  for (const LinkType type : {LinkType::spring, LinkType::limited, LinkType::rigid}) {
    SceneDesc scene = scenes::flag(12, 15, 0.05, type);
    scene.nets[0].stiffness = 500;
    scene.nets[0].damping = 0.5;
    if (type == LinkType::rigid) scene.nets[0].stiffness = scene.nets[0].damping = 0;
    print("flag " + std::to_string(static_cast<int>(type)), scene, 300, false, [](World& world, BoundaryInputs&, int i) {
      if (i == 100) world.apply(edit::Cut{net_id(0), 7});
    });
  }
  print("figure on stairs", scenes::figure_on_stairs(), 600);
  for (const IntegratorDesc::Type type :
       {IntegratorDesc::Type::verlet, IntegratorDesc::Type::euler, IntegratorDesc::Type::rk4, IntegratorDesc::Type::pc5})
    print("planet " + std::to_string(static_cast<int>(type)), scenes::planet(0.01, type), 500);
}

/// Two cables that hang side by side are pinned, wound, cut, joined, tuned and broken.
void edit(World& world, BoundaryInputs&, int i) {
  if (i == 20)
    world.apply(edit::Pin{"pin", cable_id(0), 17, 0, {{0.3, 0.05, -0.2}, Quaternion::Identity()}, AttachmentType::clamp});
  if (i == 60) world.apply(edit::SetLength{1, true, 0.7, 0.5});
  if (i == 150) world.apply(edit::Unpin{"pin"});
  if (i == 170) world.apply(edit::Cut{cable_id(0), 12});
  if (i == 260) world.apply(edit::SetLength{1, true, 1.1, 1.0});
  if (i == 330) world.apply(edit::Join{0, true, 2, false});
  if (i == 450) {
    Obstacle ball;
    ball.name = "ball";
    ball.shape = SphereShape{0.1};
    ball.pose.position = {0.3, 0, -0.5};
    world.apply(edit::SetObstacle{ball});
  }
  if (i == 600) world.apply(edit::RemoveObstacle{"ball"});
  if (i == 620) {
    SceneDesc scene = scenes::one_cable(10);
    scene.materials[0].material.bending_stiffness = 2e-3;
    scene.materials[0].material.drag = 0.3;
    scene.gravity.acceleration = {0.5, 0, -9};
    world.tune(scene);
  }
}

void print_edits() {
  for (const bool touching : {false, true}) {
    SceneDesc scene = scenes::between_two_points(30, 0.6);
    MaterialDesc& material = scene.materials[0].material;
    material.bending_stiffness = 1e-3;
    material.bending_damping = 1e-5;
    material.axial_stiffness = 2000;
    material.axial_damping = 1;
    scene.cables.push_back(scene.cables[0]);
    scene.cables[1].name = "other";
    for (AttachmentDesc& attachment : scene.cables[1].attachments) {
      attachment.name += "_other";
      attachment.offset.y() = 0.05;
    }
    scene.cables[0].stiff_ends = {0.05, 0};
    if (touching) scene.contact = ContactDesc{};
    print(std::string("edits") + (touching ? " touching" : ""), scene, 800, false, edit);
    scene.materials[0].material.breaking_tension = 3;
    print(std::string("breaks") + (touching ? " touching" : ""), scene, 400, false, [](World& world, BoundaryInputs&, int i) {
      if (i < 300) world.apply(edit::MoveAttachment{"right", {{0.6 + 0.002 * i, 0, 0}, Quaternion::Identity()}});
    });
  }
}

}  // namespace

}  // namespace verlet_cable::bench

int main() {
  using namespace verlet_cable::bench;
  print_driven();
  print_released();
  print_contacts();
  print_nets();
  print_edits();
  return 0;
}
