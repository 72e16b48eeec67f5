#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <stdexcept>

namespace verlet_cable {

/// What one thread uses no other may: others run while a step does. All changes of the flag are made with the interpreter's lock.
class InUse {
 public:
  InUse(bool& busy, const char* what) : busy_(busy) {
    check(busy, what);
    busy_ = true;
  }
  ~InUse() { busy_ = false; }
  InUse(const InUse&) = delete;
  InUse& operator=(const InUse&) = delete;

  static void check(bool busy, const char* what) {
    if (busy)
      throw std::runtime_error(std::string("the ") + what + " is in use by another thread; allowed: one thread at a time");
  }

 private:
  bool& busy_;
};

/// Runs `work` without the interpreter's lock. Where the interpreter ends before it has the lock again, it ends this thread by
/// unwinding it: out of a function, which it could not out of a destructor.
template <class Work>
void without_lock(const Work& work) {
  PyThreadState* const thread = PyEval_SaveThread();
  try {
    work();
  } catch (...) {
    PyEval_RestoreThread(thread);
    throw;
  }
  PyEval_RestoreThread(thread);
}

/// Runs `work(n)` for all of `steps`, some at a time and without the interpreter's lock, so that Ctrl-C ends it in between: then
/// it throws.
template <class Work>
void run_steps(std::int64_t steps, const Work& work) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds short_time(20), long_time(100);
  std::int64_t some = 1;
  while (steps > 0) {
    some = std::min(some, steps);
    Clock::duration taken;
    without_lock([&] {
      const Clock::time_point start = Clock::now();
      work(some);
      taken = Clock::now() - start;
    });
    steps -= some;
    if (steps > 0 && PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
    if (taken < short_time)
      some *= 2;
    else if (taken > long_time)
      some = std::max<std::int64_t>(1, some / 2);
  }
}

}  // namespace verlet_cable
