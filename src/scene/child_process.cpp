#include "child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>

extern char** environ;

namespace verlet_cable {
namespace {

constexpr int longest_wait = 50;  // [ms] until the next look at whether patience has ended

[[noreturn]] void fail(const std::string& what, int error) {
  throw ResourceError(what + ": " + std::generic_category().message(error));
}

/// Beyond the standard streams, whose numbers it could have where those are closed.
FileDescriptor above_streams(int number) {
  const FileDescriptor original(number);
  FileDescriptor moved(fcntl(number, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
  if (moved.number() < 0) fail("no file can be opened", errno);
  return moved;
}

/// No signal of this process is blocked or ignored in the other.
class SpawnAttributes {
 public:
  SpawnAttributes() {
    posix_spawnattr_init(&attributes_);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;

  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

class SpawnFiles {
 public:
  SpawnFiles(int input, int output) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  }
  ~SpawnFiles() { posix_spawn_file_actions_destroy(&actions_); }
  SpawnFiles(const SpawnFiles&) = delete;
  SpawnFiles& operator=(const SpawnFiles&) = delete;

  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

}  // namespace

ChildProcess::ChildProcess(const std::string& program, std::vector<std::string> arguments, const FileDescriptor& input) {
  std::array<int, 2> ends;
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail("no pipe can be opened", errno);
  output_ = FileDescriptor(ends[0]);
  const FileDescriptor their_output = above_streams(ends[1]);
  const FileDescriptor their_input = above_streams(fcntl(input.number(), F_DUPFD_CLOEXEC, 0));
  std::string name = program;
  std::vector<char*> argv{name.data()};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const SpawnAttributes attributes;
  const SpawnFiles files(their_input.number(), their_output.number());
  const int error = posix_spawn(&id_, program.c_str(), files.get(), attributes.get(), argv.data(), environ);
  if (error != 0) {
    id_ = -1;
    fail("cannot start " + program, error);
  }
}

ChildProcess::~ChildProcess() {
  if (id_ < 0) return;
  kill(id_, SIGKILL);
  wait();
}

std::size_t ChildProcess::read(void* data, std::size_t size, const Patience& patience) {
  std::size_t done = 0;
  while (done < size) {
    patience.check();
    pollfd ready{output_.number(), POLLIN, 0};
    if (poll(&ready, 1, longest_wait) <= 0) continue;
    const ssize_t count = ::read(output_.number(), static_cast<char*>(data) + done, size - done);
    if (count == 0) break;
    if (count < 0 && errno != EINTR) fail("its reader is lost", errno);
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return done;
}

int ChildProcess::wait() {
  int status = -1;
  while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
  }
  id_ = -1;
  return status;
}

}  // namespace verlet_cable
