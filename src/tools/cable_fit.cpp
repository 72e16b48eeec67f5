#include "cable_fit/command.h"
#include "common/program.h"

int main(int argc, char** argv) {
  return verlet_cable::tools::run_program("cable_fit", verlet_cable::cable_fit::run, argc, argv);
}
