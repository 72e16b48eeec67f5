#pragma once

#include <cstddef>

#if defined(__SANITIZE_THREAD__)
#define VERLET_CABLE_THREAD_SANITIZER
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define VERLET_CABLE_THREAD_SANITIZER
#endif
#endif

#ifdef VERLET_CABLE_THREAD_SANITIZER
#include <algorithm>
#include <future>
#include <vector>
#else
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#endif

namespace verlet_cable {

/// Calls `work(from, to)` for ranges that together are 0 to `count`, on all cores; those of no more than `least` items are not
/// divided. What `work` throws is thrown on.
#ifdef VERLET_CABLE_THREAD_SANITIZER
// On threads that it watches: how TBB's library, which is not compiled with it, hands tasks to its own it does not see.
template <class Work>
void parallel_for(std::size_t count, std::size_t least, const Work& work) {
  constexpr std::size_t most_threads = 4;
  const std::size_t share = std::max(least, (count + most_threads - 1) / most_threads);
  std::vector<std::future<void>> others;
  for (std::size_t from = share; from < count; from += share)
    others.push_back(std::async(std::launch::async, [&work, from, to = std::min(count, from + share)] { work(from, to); }));
  if (count > 0) work(std::size_t{0}, std::min(count, share));
  for (std::future<void>& other : others) other.get();
}
#else
template <class Work>
void parallel_for(std::size_t count, std::size_t least, const Work& work) {
  using Range = tbb::blocked_range<std::size_t>;
  tbb::parallel_for(Range(0, count, least), [&](const Range& range) { work(range.begin(), range.end()); });
}
#endif

/// Calls `work(i)` for each i of 0 to `count` - 1, likewise.
template <class Work>
void parallel_for(std::size_t count, const Work& work) {
  parallel_for(count, 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) work(i);
  });
}

}  // namespace verlet_cable
