#include <ros/ros.h>

#include "verlet_cable/ros/cable_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "cable");
  // Outlives what is thrown: logging ends with the last node handle.
  const ros::NodeHandle node("~");
  try {
    const verlet_cable::CableNode cable_node(node);
    ros::spin();
  } catch (const verlet_cable::SceneError& error) {
    verlet_cable::log_errors(error);
    return 2;
  }
  return 0;
}
