#include "camera/camera_node.h"
#include "node/node_program.h"

int main(int argc, char** argv) {
  const verlet_cable::NodeProgram program{
      "camera_node", "camera",
      "Publishes what a depth camera sees of the cables of a cable node. To start it beside one:\n"
      "roslaunch verlet_cable camera.launch optical_frame:=FRAME\n"};
  return verlet_cable::run_node<verlet_cable::CameraNode>(argc, argv, program, [](const verlet_cable::CameraNode&) {});
}
