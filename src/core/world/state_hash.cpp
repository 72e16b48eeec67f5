#include <cstring>

#include "world/state_fields.h"

namespace verlet_cable {

namespace {

/// Takes eight bytes at a time: FNV's steps, with the upper half folded into the lower one, where a multiplication does not
/// carry.
class Hash {
 public:
  template <class Number>
  void operator()(const Number& number) {
    static_assert(sizeof number <= sizeof(std::uint64_t));
    std::uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof number);
    value_ = (value_ ^ bits) * 1099511628211ull;
    value_ ^= value_ >> 32;
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037ull;
};

}  // namespace

std::uint64_t hash(const State& state) {
  Hash hash;
  visit(state, hash);
  return hash.value();
}

}  // namespace verlet_cable
