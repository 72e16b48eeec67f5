#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <cstddef>
#include <string>
#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable::fuzz {

/// Numbers and choices of an input's bytes: mostly such as make sense, now and then (`is_odd`) any.
class Arbitrary {
 public:
  Arbitrary(const std::uint8_t* data, std::size_t size) : input_(data, size) {}

  bool is_used_up() { return input_.remaining_bytes() == 0; }
  bool is_odd() { return below(32) == 31; }
  bool flip() { return input_.ConsumeBool(); }
  /// From 0 to `count` - 1.
  int below(int count) { return input_.ConsumeIntegralInRange(0, count - 1); }
  /// An index into `count` things; an odd one is any number.
  int index(std::size_t count);

  /// From `low` to `high`, in 65,535 steps.
  double between(double low, double high);
  /// Likewise, each order of magnitude as often as any other; an odd one is none that any program should be given.
  double positive(double low, double high);
  Vector3 vector(double most);
  Quaternion rotation();
  /// Nearby, or oddly far away or not sound.
  Pose pose(const Vector3& near, double most_away);

  template <class Item, std::size_t count>
  Item one_of(const Item (&items)[count]) {
    return items[below(static_cast<int>(count))];
  }
  /// An odd one is none of them.
  std::string one_of(const std::vector<std::string>& names);

 private:
  double odd_number();

  FuzzedDataProvider input_;
};

}  // namespace verlet_cable::fuzz
