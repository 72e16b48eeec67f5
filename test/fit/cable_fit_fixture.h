#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "../scene/cable_sim_fixture.h"

namespace verlet_cable {

/// Both programs, in a directory of its own.
class CableFitProgram : public CableSim {
 protected:
  /// The exit status; `before`: commands of the same shell.
  int fit(const std::string& arguments, const std::string& before = "") {
    const std::string command = before + CABLE_FIT_PROGRAM + " " + arguments + " > " + path("out") + " 2> " + path("err");
    const int status = std::system(command.c_str());
    out = content(path("out"));
    err = content(path("err"));
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

}  // namespace verlet_cable
