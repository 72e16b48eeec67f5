#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "verlet_cable/core/world.h"

/// Scenes of particles and nets that tests and benchmarks share.
namespace verlet_cable::scenes {

inline void run(World& world, int steps) {
  const BoundaryInputs inputs(world.frames().size());
  for (int i = 0; i < steps; ++i) world.step(inputs);
}

inline SceneDesc weightless() {
  SceneDesc scene;
  scene.gravity.acceleration.setZero();
  return scene;
}

/// A planet around a mass of mu = 1 in the origin, at its nearest.
inline SceneDesc planet(double time_step, IntegratorDesc::Type integrator, double speed = 1.1) {
  SceneDesc scene;
  scene.gravity.type = GravityDesc::Type::central;
  scene.time_step = time_step;
  scene.integrator.type = integrator;
  ParticleDesc planet;
  planet.name = "planet";
  planet.mass = 1;
  planet.position = {1, 0, 0};
  planet.velocity = {0, speed, 0};
  scene.particles = {planet};
  return scene;
}

inline NetAttachmentDesc net_attachment(const std::string& name, int node, const Vector3& offset) {
  NetAttachmentDesc desc;
  desc.name = name;
  desc.node = node;
  desc.offset = offset;
  return desc;
}

/// Nodes joined one after the other, 1 kg in all.
inline NetDesc chain(std::vector<Vector3> nodes, LinkType type) {
  NetDesc net;
  net.name = "chain";
  net.nodes = std::move(nodes);
  for (int i = 0; i + 1 < static_cast<int>(net.nodes.size()); ++i) net.links.push_back({i, i + 1});
  net.mass = 1;
  net.link_type = type;
  return net;
}

/// 0.2 kg in the plane of x and z, hanging down from the origin.
inline NetDesc grid(int rows, int columns, double spacing, LinkType type) {
  NetDesc net;
  net.name = "flag";
  net.grid = GridDesc{};
  net.grid->rows = rows;
  net.grid->columns = columns;
  net.grid->spacing = spacing;
  net.mass = 0.2;
  net.link_type = type;
  return net;
}

/// A flag that hangs on its upper corners, in wind from its back.
inline SceneDesc flag(int rows, int columns, double spacing, LinkType type) {
  SceneDesc scene;
  scene.fluid.density = 1.2;
  scene.fluid.velocity = {0.5, 4, 0.5};
  NetDesc net = grid(rows, columns, spacing, type);
  net.attachments = {net_attachment("left", 0, {0, 0, 0}), net_attachment("right", columns - 1, {(columns - 1) * spacing, 0, 0})};
  scene.nets = {net};
  return scene;
}

/// The figure of Hitman (Jakobsen, Advanced Character Physics, 2001): sticks in the shape of a body, cross sticks that keep it
/// from folding, knees and elbows that do not bend backwards beyond a distance.
inline NetDesc figure(const Vector3& pelvis) {
  NetDesc net;
  net.name = "figure";
  const std::vector<Vector3> nodes{
      {0.12, 0, 0.66},  {0, 0, 0.52},                                // 0 head, 1 neck
      {0, 0.18, 0.42},  {0, 0.30, 0.20},      {0.05, 0.34, -0.05},   // 2 3 4 left shoulder, elbow, hand
      {0, -0.18, 0.42}, {0, -0.30, 0.20},     {0.05, -0.34, -0.05},  // 5 6 7 right
      {0, 0.10, 0},     {0.03, 0.12, -0.42},  {0, 0.12, -0.85},      // 8 9 10 left hip, knee, foot
      {0, -0.10, 0},    {0.03, -0.12, -0.42}, {0, -0.12, -0.85},     // 11 12 13 right
      {-0.14, 0, 0.25}};                                             // 14 spine
  for (const Vector3& node : nodes) net.nodes.push_back(pelvis + node);
  net.links = {{0, 1},  {0, 2},  {0, 5},  {1, 2},  {1, 5},   {2, 5},  {2, 3},  {3, 4}, {5, 6},  {6, 7},   {8, 11}, {2, 8},
               {5, 11}, {2, 11}, {1, 14}, {14, 8}, {14, 11}, {14, 2}, {14, 5}, {8, 9}, {9, 10}, {11, 12}, {12, 13}};
  net.minimum_distances = {{{2, 4}, 0.25}, {{5, 7}, 0.25}, {{8, 10}, 0.45}, {{11, 13}, 0.45}, {{9, 12}, 0.1}, {{10, 13}, 0.1}};
  net.mass = 70;
  net.link_type = LinkType::rigid;
  return net;
}

/// Thrown down eight steps.
inline SceneDesc figure_on_stairs() {
  SceneDesc scene;
  scene.nets = {figure({0, 0, 3.2})};
  scene.nets[0].velocity = {1.5, 0.2, 0};
  ObstacleDesc floor;
  floor.name = "floor";
  scene.obstacles.push_back(floor);
  for (int i = 0; i < 8; ++i) {
    ObstacleDesc step;
    step.name = "step_" + std::to_string(i + 1);
    step.type = ShapeType::box;
    const double height = 0.2 * (8 - i);
    step.size = {0.3, 2, height};
    step.pose = {0.3 * i, 0, 0.5 * height, 0, 0, 0};
    scene.obstacles.push_back(step);
  }
  return scene;
}

}  // namespace verlet_cable::scenes
