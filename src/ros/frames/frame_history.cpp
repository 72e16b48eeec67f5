#include "frames/frame_history.h"

#include <algorithm>
#include <iterator>

namespace verlet_cable {

void FrameHistory::extend(Nanoseconds stamp) {
  static_ = false;
  const auto next = intervals_.begin() + (first_ending_from(stamp) - intervals_.cbegin());
  const bool has_next = next != intervals_.end(), has_previous = next != intervals_.begin();
  if (has_next && next->first <= stamp) return;
  const bool joins_next = has_next && next->first - stamp <= longest_gap_;
  const bool joins_previous = has_previous && stamp - std::prev(next)->last <= longest_gap_;
  if (joins_previous && joins_next) {
    next->first = std::prev(next)->first;
    intervals_.erase(std::prev(next));
  } else if (joins_previous) {
    std::prev(next)->last = stamp;
  } else if (joins_next) {
    next->first = stamp;
  } else {
    intervals_.insert(next, {stamp, stamp});
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

std::deque<FrameHistory::Interval>::const_iterator FrameHistory::first_ending_from(Nanoseconds time) const {
  return std::lower_bound(intervals_.begin(), intervals_.end(), time,
                          [](const Interval& interval, Nanoseconds t) { return interval.last < t; });
}

FrameHistory::Coverage FrameHistory::at(Nanoseconds time) const {
  if (static_) return Coverage::covered;
  if (intervals_.empty() || time < intervals_.front().first) return Coverage::unseen;
  const auto next = first_ending_from(time);
  if (next == intervals_.end()) return Coverage::ahead;
  return time < next->first ? Coverage::gap : Coverage::covered;
}

Nanoseconds FrameHistory::first() const {
  return intervals_.empty() ? 0 : intervals_.front().first;
}

Nanoseconds FrameHistory::newest() const {
  return intervals_.empty() ? 0 : intervals_.back().last;
}

Nanoseconds FrameHistory::last_before(Nanoseconds time) const {
  const auto next = first_ending_from(time);
  return next == intervals_.begin() ? 0 : std::prev(next)->last;
}

Nanoseconds FrameHistory::first_after(Nanoseconds time) const {
  const auto next = std::upper_bound(intervals_.begin(), intervals_.end(), time,
                                     [](Nanoseconds t, const Interval& interval) { return t < interval.first; });
  return next == intervals_.end() ? 0 : next->first;
}

}  // namespace verlet_cable
