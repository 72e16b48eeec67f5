#include <exception>
#include <iostream>

#include "cable_fit/command.h"

int main(int argc, char** argv) {
  try {
    return verlet_cable::cable_fit::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << "cable_fit: stopped: " << error.what() << "\n";
    return verlet_cable::cable_fit::exit_stopped;
  }
}
