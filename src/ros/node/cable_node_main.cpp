#include <malloc.h>
#include <ros/ros.h>

#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>

#include "node/cable_node.h"
#include "verlet_cable/core/quoted_text.h"

namespace {

const char* const usage =
    "usage: cable_node [__name:=NAME] [FROM:=TO]...\n"
    "Simulates the cables of its private parameters. To start it with a scene file:\n"
    "roslaunch verlet_cable cable.launch scene:=FILE\n";

/// The exit status, where the arguments that are no remappings of ROS end the program.
std::optional<int> answer_arguments(int argc, char** argv) {
  if (argc < 2) return std::nullopt;
  const std::string argument = argv[1];
  if (argument == "--help" || argument == "-h") {
    std::cout << usage;
    return 0;
  }
  std::cerr << "cable_node: " << verlet_cable::quoted(argument) << "; allowed: --help and remappings of ROS\n" << usage;
  return 2;
}

void wait_for_master() {
  if (ros::master::check()) return;
  ROS_ERROR("no ROS master at %s: start roscore, or use roslaunch", ros::master::getURI().c_str());
  while (!ros::master::check()) ros::WallDuration(0.2).sleep();
}

/// roscpp subscribes to this parameter with the first line that is logged. In a node without any, that line would say that
/// another node has taken its name; whoever subscribes then counts as the newer one, and the master would end the other node,
/// too.
void register_what_logging_needs() {
  bool ignored = false;
  ros::param::getCached("/rosout_disable_topics_generation", ignored);
}

/// Large blocks of scenes and rollouts are mapped, and go back to the system as soon as they are freed. glibc would raise this
/// threshold to the largest block that was freed, and then cut them out of what its threads keep, which splits it up.
void map_large_blocks() {
  constexpr int threshold = 128 * 1024;  // [bytes] the one that it begins with
  mallopt(M_MMAP_THRESHOLD, threshold);
}

}  // namespace

int main(int argc, char** argv) {
  map_large_blocks();
  try {
    ros::init(argc, argv, "cable");
  } catch (const ros::Exception& error) {
    std::cerr << "cable_node: " << verlet_cable::escaped(error.what()) << '\n' << usage;
    return 2;
  }
  if (const auto status = answer_arguments(argc, argv)) return *status;
  wait_for_master();
  // Outlives what is thrown: logging ends with the last node handle.
  const ros::NodeHandle node("~");
  register_what_logging_needs();
  try {
    const verlet_cable::CableNode cable_node(node);
    ros::spin();
    ros::shutdown();
    // A process need not wait for its threads.
    if (cable_node.busy()) std::_Exit(0);
  } catch (const verlet_cable::SceneError& error) {
    verlet_cable::log_errors(error);
    return 2;
  }
  return 0;
}
