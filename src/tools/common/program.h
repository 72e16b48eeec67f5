#pragma once

#include <string>
#include <vector>

namespace verlet_cable::tools {

constexpr int exit_done = 0;
constexpr int exit_bad_input = 2;
constexpr int exit_stopped = 3;

/// The body of a main: calls `run` with the arguments after the program's name and returns its exit status. Errors of writing
/// come back from the calls that write, and not as signals; SIGINT, SIGTERM and SIGHUP, where they are not ignored, end the
/// program with a message and `exit_stopped`, and nothing unfinished is left.
int run_program(const char* name, int (*run)(const std::vector<std::string>& arguments), int argc, char** argv);

/// Prints errors, at most 100 of them. `not_done`: "nothing was simulated". Returns `exit_bad_input`.
int refuse(const char* name, const std::vector<std::string>& errors, const char* not_done);

/// Prints to standard output, or to standard error where standard output carries data. False, with a message, if it cannot.
bool print_result(const char* name, const std::string& text, bool to_standard_error);

/// While it lives, the first signal that would end the program only asks it to stop. A second one ends it.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// The name of the signal, null as long as there was none.
  const char* signal() const;
};

}  // namespace verlet_cable::tools
