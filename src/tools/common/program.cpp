#include "program.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstring>
#include <exception>
#include <iostream>

#include "output_file.h"

namespace verlet_cable::tools {
namespace {

constexpr std::size_t most_errors = 100;

struct EndingSignal {
  int number;
  const char* name;
};
constexpr EndingSignal ending_signals[] = {{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}};

const char* program_name = "";
pid_t owner = 0;
std::atomic<bool> is_kept{false};  ///< the first signal, for a StopRequest
std::atomic<int> kept_signal{0};

const char* name_of(int signal) {
  for (const EndingSignal& ending : ending_signals)
    if (ending.number == signal) return ending.name;
  return nullptr;
}

/// For a signal handler: no memory, no locks.
void print(const char* text) {
  const ssize_t written = write(STDERR_FILENO, text, std::strlen(text));
  static_cast<void>(written);
}

extern "C" void on_signal(int signal) {
  if (getpid() != owner) _exit(exit_stopped);  // a child that reads a file for the program
  int none = 0;
  if (is_kept && kept_signal.compare_exchange_strong(none, signal)) return;
  remove_unfinished_files();
  if (isatty(STDERR_FILENO) == 1) print("\r\x1b[K");
  for (const char* text : {program_name, ": stopped: ended by ", name_of(signal), "\n"}) print(text);
  _exit(exit_stopped);
}

void handle_signals() {
  owner = getpid();
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  for (const EndingSignal& ending : ending_signals) {
    struct sigaction action {};
    sigaction(ending.number, nullptr, &action);
    // As nohup and shells in the background set it.
    if (action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = on_signal;
    sigaction(ending.number, &action, nullptr);
  }
}

/// So that no file that is opened takes the place of a standard stream that was closed.
void occupy_standard_streams() {
  int descriptor = 0;
  do {
    descriptor = open("/dev/null", O_RDONLY);
  } while (descriptor >= 0 && descriptor <= STDERR_FILENO);
  if (descriptor >= 0) close(descriptor);
}

}  // namespace

int run_program(const char* name, int (*run)(const std::vector<std::string>& arguments), int argc, char** argv) {
  program_name = name;
  handle_signals();
  occupy_standard_streams();
  try {
    return run({argv + std::min(argc, 1), argv + argc});
  } catch (const std::exception& error) {
    std::cerr << name << ": stopped: " << error.what() << "\n";
    return exit_stopped;
  }
}

int refuse(const char* name, const std::vector<std::string>& errors, const char* not_done) {
  const std::size_t listed = std::min(errors.size(), most_errors);
  for (std::size_t i = 0; i < listed; ++i) std::cerr << name << ": " << errors[i] << "\n";
  std::cerr << name << ": ";
  if (listed < errors.size()) {
    std::cerr << "more than " << listed << " errors, the first " << listed << " are listed; ";
  } else {
    std::cerr << listed << (listed == 1 ? " error, " : " errors, ");
  }
  std::cerr << not_done << "\n";
  return exit_bad_input;
}

bool print_result(const char* name, const std::string& text, bool to_standard_error) {
  std::ostream& stream = to_standard_error ? std::cerr : std::cout;
  stream << text << std::flush;
  if (stream || to_standard_error) return true;
  std::cerr << name << ": stopped: cannot write to standard output\n";
  return false;
}

StopRequest::StopRequest() {
  kept_signal = 0;
  is_kept = true;
}

StopRequest::~StopRequest() {
  is_kept = false;
}

const char* StopRequest::signal() const {
  return name_of(kept_signal);
}

}  // namespace verlet_cable::tools
