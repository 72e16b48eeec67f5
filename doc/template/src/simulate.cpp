// simulate SCENE.yaml: simulates a second of the scene, without ROS. Frames stay at their initial_pose.
#include <cstdio>
#include <exception>

#include "verlet_cable/core/world.h"
#include "verlet_cable/scene/scene_reader.h"

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: simulate SCENE.yaml\n");
    return 2;
  }
  const verlet_cable::SceneDesc scene = verlet_cable::read_scene_file(argv[1]);
  const verlet_cable::BoundaryInputs frames = verlet_cable::initial_frames(scene);
  verlet_cable::World world(scene, frames);
  while (world.time() < 1) world.step(frames);
  for (const verlet_cable::Attachment& attachment : world.attachments()) {
    std::printf("%s bears %.3f N\n", attachment.name.c_str(), attachment.force.norm());
  }
} catch (const std::exception& error) {  // SceneError: all errors of the scene, one per line
  std::fprintf(stderr, "simulate: %s\n", error.what());
  return 2;
}
