#include <malloc.h>

#include <cstdlib>

#include "node/cable_node.h"
#include "node/node_program.h"

namespace {

/// Large blocks of scenes and rollouts are mapped, and go back to the system as soon as they are freed. glibc would raise this
/// threshold to the largest block that was freed, and then cut them out of what its threads keep, which splits it up.
void map_large_blocks() {
  constexpr int threshold = 128 * 1024;  // [bytes] the one that it begins with
  mallopt(M_MMAP_THRESHOLD, threshold);
}

}  // namespace

int main(int argc, char** argv) {
  map_large_blocks();
  const verlet_cable::NodeProgram program{"cable_node", "cable",
                                          "Simulates the cables of its private parameters. To start it with a scene file:\n"
                                          "roslaunch verlet_cable cable.launch scene:=FILE\n"};
  return verlet_cable::run_node<verlet_cable::CableNode>(argc, argv, program, [](const verlet_cable::CableNode& node) {
    // A process need not wait for its threads.
    if (node.busy()) std::_Exit(0);
  });
}
