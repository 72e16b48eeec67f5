#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <string>

#include "time/time_grid.h"

namespace verlet_cable {

/// Which stamps tf2 keeps of each frame. It keeps all of the last `memory`, however many are sent: beyond `most` in all, each
/// frame gets the same share of them, evenly over that time, so that a flood of one takes no other away. Frames that fell
/// silent keep theirs: from twice as many on, no new frame is taken.
class StoredTransforms {
 public:
  StoredTransforms(Nanoseconds memory, std::size_t most) : memory_(memory), most_(most) {}

  /// [ns] that a stamp has to be after the frame's newest one, as things are; 0 while there is room for all.
  Nanoseconds least_interval() const;
  bool knows(const std::string& frame) const { return stamps_.count(frame) != 0; }
  /// Whether tf2 may be given a transform with that stamp.
  bool has_room(const std::string& frame, Nanoseconds stamp) const;
  void add(const std::string& frame, Nanoseconds stamp);
  void clear();
  std::size_t size() const { return size_; }
  std::size_t most() const { return most_; }

 private:
  Nanoseconds memory_;
  std::size_t most_;
  std::size_t size_ = 0;
  std::map<std::string, std::deque<Nanoseconds>> stamps_;  ///< by child frame, ascending
};

}  // namespace verlet_cable
