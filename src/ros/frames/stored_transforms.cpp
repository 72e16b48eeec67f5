#include "frames/stored_transforms.h"

#include <algorithm>

namespace verlet_cable {

Nanoseconds StoredTransforms::least_interval() const {
  if (size_ < most_) return 0;
  return memory_ / static_cast<Nanoseconds>(std::max<std::size_t>(1, most_ / std::max<std::size_t>(1, stamps_.size())));
}

bool StoredTransforms::has_room(const std::string& frame, Nanoseconds stamp) const {
  const auto stored = stamps_.find(frame);
  if (stored == stamps_.end()) return size_ < 2 * most_;
  const Nanoseconds interval = least_interval();
  return interval == 0 || stamp - stored->second.back() >= interval;
}

void StoredTransforms::add(const std::string& frame, Nanoseconds stamp) {
  std::deque<Nanoseconds>& stamps = stamps_[frame];
  const std::size_t before = stamps.size();
  stamps.insert(std::upper_bound(stamps.begin(), stamps.end(), stamp), stamp);
  while (stamps.front() < stamps.back() - memory_) stamps.pop_front();
  size_ += stamps.size() - before;
}

void StoredTransforms::clear() {
  stamps_.clear();
  size_ = 0;
}

}  // namespace verlet_cable
