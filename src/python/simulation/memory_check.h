#pragma once

#include <new>
#include <string>
#include <utility>

namespace verlet_cable {

/// What Python calls a MemoryError, with a reason.
class TooMuchMemory : public std::bad_alloc {
 public:
  explicit TooMuchMemory(std::string reason) : reason_(std::move(reason)) {}
  const char* what() const noexcept override { return reason_.c_str(); }

 private:
  std::string reason_;
};

/// Throws TooMuchMemory where that many bytes are more than this machine has. `what`: the argument, and what takes them.
void check_memory(const std::string& what, double bytes);

}  // namespace verlet_cable
