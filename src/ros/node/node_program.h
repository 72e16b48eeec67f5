#pragma once

#include <ros/ros.h>

#include <optional>
#include <string>

#include "node/cable_node.h"

namespace verlet_cable {

/// A program that is a node.
struct NodeProgram {
  std::string name;          ///< of the program
  std::string node_name;     ///< where nobody gives another
  std::string what_it_does;  ///< whole lines

  std::string usage() const;
};

/// Begins to be a node of ROS, when there is a master. The exit status where the arguments end the program.
std::optional<int> start_node(int argc, char** argv, const NodeProgram& program);

/// roscpp subscribes to a parameter with the first line that is logged. In a node without any, that line would say that another
/// node has taken its name; whoever subscribes then counts as the newer one, and the master would end the other node, too.
void register_what_logging_needs();

/// Makes a Node of the private parameters, and runs it until it is told to end; then calls `ended` with it. The exit status of
/// the program: 2 where the parameters are wrong, which is logged.
template <class Node, class Ended>
int run_node(int argc, char** argv, const NodeProgram& program, const Ended& ended) {
  if (const auto status = start_node(argc, argv, program)) return *status;
  // Outlives what is thrown: logging ends with the last node handle.
  const ros::NodeHandle handle("~");
  register_what_logging_needs();
  try {
    const Node node(handle);
    ros::spin();
    ros::shutdown();
    ended(node);
  } catch (const SceneError& error) {
    log_errors(error);
    return 2;
  }
  return 0;
}

}  // namespace verlet_cable
