#include "cable_sim/command.h"
#include "common/program.h"

int main(int argc, char** argv) {
  return verlet_cable::tools::run_program("cable_sim", verlet_cable::cable_sim::run, argc, argv);
}
