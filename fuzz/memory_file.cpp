#include "memory_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include "require.h"

namespace verlet_cable::fuzz {

MemoryFile::MemoryFile(const std::uint8_t* data, std::size_t size)
    : file_(memfd_create("input", 0)), path_("/proc/self/fd/" + std::to_string(file_)) {
  require(file_ >= 0 && write(file_, data, size) == static_cast<ssize_t>(size), "there is memory for the input");
}

MemoryFile::~MemoryFile() {
  close(file_);
}

}  // namespace verlet_cable::fuzz
