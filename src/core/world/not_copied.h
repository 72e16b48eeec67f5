#pragma once

namespace verlet_cable {

/// What is no part of a value: a copy of it starts with a new one, and what is assigned to begins anew.
template <class T>
struct NotCopied {
  T value;

  NotCopied() = default;
  NotCopied(const NotCopied&) {}
  NotCopied& operator=(const NotCopied&) {
    value = T{};
    return *this;
  }
};

}  // namespace verlet_cable
