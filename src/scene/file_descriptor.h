#pragma once

#include <unistd.h>

#include <string>
#include <utility>

namespace verlet_cable {

/// Closes what it holds.
class FileDescriptor {
 public:
  explicit FileDescriptor(int number = -1) : number_(number) {}
  ~FileDescriptor() {
    if (number_ >= 0) close(number_);
  }
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  int number() const { return number_; }

 private:
  int number_;
};

/// Opens a regular file of at most 64 MB to read; waits for nothing, whatever is at the path. Throws ResourceError.
FileDescriptor open_regular_file(const std::string& path);

}  // namespace verlet_cable
