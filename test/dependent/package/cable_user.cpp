// A cable that swings for a tenth of a second, its scene read from text, its state as a message.
#include <cstdio>
#include <verlet_cable/Cable.h>

#include "verlet_cable/core/world.h"
#include "verlet_cable/scene/scene_reader.h"

int main() {
  const YAML::Node root = YAML::Load(
      "{materials: {rope: {linear_density: 0.1, radius: 0.005}},"
      " cables: [{name: rope, length: 1, segments: 10, material: rope, attachments: [{name: left, at: start}],"
      "           initial: {type: straight, from: [0, 0, 0], to: [1, 0, 0]}}]}");
  const verlet_cable::SceneDesc scene = verlet_cable::read_scene(root);
  verlet_cable::BoundaryInputs inputs(verlet_cable::frame_names(scene).size());
  verlet_cable::World world(scene, inputs);
  while (world.time() < 0.1) world.step(inputs);
  verlet_cable::Cable message;
  message.name = "rope";
  std::printf("%s at %.6f s: %.6f m\n", message.name.c_str(), world.time(), world.cables()[0].state.positions.back().z());
}
