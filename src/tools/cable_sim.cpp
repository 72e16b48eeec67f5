#include <exception>
#include <iostream>

#include "cable_sim/command.h"

int main(int argc, char** argv) {
  try {
    return verlet_cable::cable_sim::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << "cable_sim: stopped: " << error.what() << "\n";
    return verlet_cable::cable_sim::exit_stopped;
  }
}
