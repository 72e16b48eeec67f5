#pragma once

#include <string>

#include "../scene/cable_sim_fixture.h"

namespace verlet_cable {

/// Both programs, in a directory of its own.
class CableFitProgram : public CableSim {
 protected:
  /// The exit status; `before`: commands of the same shell.
  int fit(const std::string& arguments, const std::string& before = "") {
    return run_program(CABLE_FIT_PROGRAM, arguments, before);
  }
};

}  // namespace verlet_cable
