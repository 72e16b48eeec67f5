#pragma once

#include <string>
#include <vector>

#include "recording.h"

namespace verlet_cable::cable_fit {

/// A cable of a harness, and which markers of the recordings are on it.
struct HarnessCable {
  std::string name;
  int first_marker = 0, last_marker = 0;  ///< they are numbered along the cable
  int from = -1;                          ///< the marker at which it leaves another cable; -1: it is the trunk
  double linear_density = 0;              ///< [kg/m]; 0: not given
  double radius = 0;                      ///< [m]; 0: not given
};

/// Cables that branch, as they are recorded.
struct Harness {
  std::vector<HarnessCable> cables;  ///< the trunk first, each before those that leave it
  std::vector<int> held;             ///< markers that are on what holds the harness, ascending
};

/// What holds a cable of a harness: at an end, two markers of which the outer one is there and the other gives the direction;
/// else one marker, where the cable is held in the direction that it has at first.
struct HarnessHold {
  int cable = 0;   ///< index into Harness::cables
  int marker = 0;  ///< where it holds
  int second = -1;
  bool at_start = false, at_end = false;
};

/// Reads a harness from a YAML file with the keys `cables` (maps of `name`, `markers`, `from`, `linear_density`, `radius`) and
/// `held`. Adds a line to `errors` for each that is wrong.
Harness read_harness(const std::string& path, std::vector<std::string>& errors);

/// Adds a line to `errors` where recordings have other markers than the harness.
void check_markers(const Harness& harness, const std::vector<Recording>& recordings, std::vector<std::string>& errors);

int marker_count(const Harness& harness);
/// The cable that a marker is on.
int cable_of(const Harness& harness, int marker);
/// The markers along a cable; that of a branch begins with the one at which it leaves another cable.
std::vector<int> markers_along(const HarnessCable& cable);
std::vector<HarnessHold> holds_of(const Harness& harness);

}  // namespace verlet_cable::cable_fit
