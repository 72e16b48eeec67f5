#include "node/node_program.h"

#include <iostream>

#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

/// The exit status, where the arguments that are no remappings of ROS end the program.
std::optional<int> answer_arguments(int argc, char** argv, const NodeProgram& program) {
  if (argc < 2) return std::nullopt;
  const std::string argument = argv[1];
  if (argument == "--help" || argument == "-h") {
    std::cout << program.usage();
    return 0;
  }
  std::cerr << program.name << ": " << in_quotes(argument) << "; allowed: --help and remappings of ROS\n" << program.usage();
  return 2;
}

void wait_for_master() {
  if (ros::master::check()) return;
  ROS_ERROR("no ROS master at %s: start roscore, or use roslaunch", ros::master::getURI().c_str());
  while (!ros::master::check()) ros::WallDuration(0.2).sleep();
}

}  // namespace

std::string NodeProgram::usage() const {
  return "usage: " + name + " [__name:=NAME] [FROM:=TO]...\n" + what_it_does;
}

std::optional<int> start_node(int argc, char** argv, const NodeProgram& program) {
  try {
    ros::init(argc, argv, program.node_name);
  } catch (const ros::Exception& error) {
    std::cerr << program.name << ": " << escaped(error.what()) << '\n' << program.usage();
    return 2;
  }
  if (const auto status = answer_arguments(argc, argv, program)) return status;
  wait_for_master();
  return std::nullopt;
}

void register_what_logging_needs() {
  bool ignored = false;
  ros::param::getCached("/rosout_disable_topics_generation", ignored);
}

}  // namespace verlet_cable
