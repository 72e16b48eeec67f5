#include "verlet_cable/ros/frame_history.h"

namespace verlet_cable {

void FrameHistory::extend(Nanoseconds stamp) {
  static_ = false;
  if (intervals_.empty() || stamp - intervals_.back().last > longest_gap_) {
    intervals_.push_back({stamp, stamp});
  } else if (stamp > intervals_.back().last) {
    intervals_.back().last = stamp;
  }
}

void FrameHistory::set_static() {
  intervals_.clear();
  static_ = true;
}

void FrameHistory::forget_before(Nanoseconds time) {
  // The last one stays: it says that the frame was seen, and until when.
  while (intervals_.size() > 1 && intervals_[1].first <= time) intervals_.pop_front();
}

void FrameHistory::clear() {
  intervals_.clear();
  static_ = false;
}

FrameHistory::Coverage FrameHistory::at(Nanoseconds time) const {
  if (static_) return Coverage::covered;
  if (intervals_.empty() || time < intervals_.front().first) return Coverage::unseen;
  for (const Interval& interval : intervals_) {
    if (time < interval.first) return Coverage::gap;
    if (time <= interval.last) return Coverage::covered;
  }
  return Coverage::ahead;
}

Nanoseconds FrameHistory::first() const {
  return intervals_.empty() ? 0 : intervals_.front().first;
}

Nanoseconds FrameHistory::newest() const {
  return intervals_.empty() ? 0 : intervals_.back().last;
}

Nanoseconds FrameHistory::last_before(Nanoseconds time) const {
  Nanoseconds last = 0;
  for (const Interval& interval : intervals_) {
    if (interval.last < time) last = interval.last;
  }
  return last;
}

Nanoseconds FrameHistory::first_after(Nanoseconds time) const {
  for (const Interval& interval : intervals_) {
    if (interval.first > time) return interval.first;
  }
  return 0;
}

}  // namespace verlet_cable
