#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>
#include <vector>

#include "file_descriptor.h"
#include "mesh_file.h"

namespace verlet_cable {

/// A program whose output is read. Ends with this, at the latest.
class ChildProcess {
 public:
  /// Starts it with `input` as its standard input. Throws ResourceError.
  ChildProcess(const std::string& program, std::vector<std::string> arguments, const FileDescriptor& input);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Reads `size` bytes of its output, fewer where that ends. Throws ResourceError when patience ends.
  std::size_t read(void* data, std::size_t size, const Patience& patience);
  /// After the end of its output: how it ended, a status of waitpid(); -1 if that is not known.
  int wait();

 private:
  FileDescriptor output_;
  pid_t id_ = -1;
};

}  // namespace verlet_cable
