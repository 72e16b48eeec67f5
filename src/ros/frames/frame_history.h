#pragma once

#include <deque>

#include "time/time_grid.h"

namespace verlet_cable {

/// When the pose of one frame is known: the intervals between its stamps that are no longer apart than the longest gap. What it
/// answers depends on the stamps alone and not on when they arrived.
class FrameHistory {
 public:
  explicit FrameHistory(Nanoseconds longest_gap) : longest_gap_(longest_gap) {}

  enum class Coverage {
    unseen,   ///< before the first stamp, or there is none
    covered,  ///< between stamps
    gap,      ///< after a stamp whose successor is too far away
    ahead     ///< after the last stamp
  };

  void extend(Nanoseconds stamp);
  void set_static();  ///< known at all times
  void forget_before(Nanoseconds time);
  void clear();

  Coverage at(Nanoseconds time) const;
  bool seen() const { return static_ || !intervals_.empty(); }
  bool is_static() const { return static_; }
  Nanoseconds first() const;                        ///< earliest stamp that is remembered, 0 if static or unseen
  Nanoseconds newest() const;                       ///< 0 if static or unseen
  Nanoseconds last_before(Nanoseconds time) const;  ///< end of the last interval that ends before `time`, 0 if there is none
  Nanoseconds first_after(Nanoseconds time) const;  ///< start of the first interval that starts after `time`, 0 if there is none

 private:
  struct Interval {
    Nanoseconds first, last;
  };
  std::deque<Interval>::const_iterator first_ending_from(Nanoseconds time) const;  ///< the interval, at or after `time`

  Nanoseconds longest_gap_;
  bool static_ = false;
  std::deque<Interval> intervals_;  ///< ascending
};

}  // namespace verlet_cable
