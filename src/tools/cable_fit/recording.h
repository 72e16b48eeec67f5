#pragma once

#include <array>
#include <string>
#include <vector>

#include "verlet_cable/core/types.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable::cable_fit {

/// A cable as it was filmed: markers along it over time, gravity along -z. The first two and the last two markers sit on what
/// holds the cable.
struct Recording {
  std::string path;
  std::vector<double> times;                  ///< [s] a row, ascending from 0
  std::vector<std::vector<Vector3>> markers;  ///< [m] a row, a marker

  int rows() const { return static_cast<int>(times.size()); }
  int marker_count() const { return static_cast<int>(markers.front().size()); }
};

/// Reads CSV files with the header `t,x0,y0,z0,x1,...` [s, m]. Adds a line to `errors` for each that is wrong, with the file and
/// the line (at most 100 a file): numbers that are none, times that do not ascend, too few rows or markers, held markers at one
/// place, different numbers of markers.
std::vector<Recording> read_recordings(const std::vector<std::string>& paths, std::vector<std::string>& errors);

/// The first or the last two markers were numbered the wrong way round: in most rows the cable doubles back behind them, as no
/// cable does that is held straight.
struct SwappedEnds {
  bool start = false, end = false;
  bool any() const { return start || end; }
};
const char* swapped_text(const SwappedEnds& swapped);  ///< "none", "the first two", ...
SwappedEnds swapped_ends(const Recording& recording);

/// The recording with the markers of such ends in their order along the cable.
Recording in_order(Recording recording, const SwappedEnds& swapped);

/// The upper one of two in the middle.
double median(std::vector<double> values);

/// [m] from the first point along the others, one a point.
std::vector<double> distances_along(const std::vector<Vector3>& points);

/// [m] along the cable between the outer markers: the median over the rows, as measured distances vary by some percent.
double measured_length(const Recording& recording);

/// Where the markers sit, as fractions of the cable's length from its start: by the median distances of neighbours over all rows
/// of some recordings of the cable.
std::vector<double> marker_places(const std::vector<const Recording*>& recordings);

/// [m/s] a marker, from the first two rows.
std::vector<Vector3> initial_velocities(const Recording& recording);

/// What a hand holds in these directions, a row: x along them, each turned the smallest way from the usual direction, that from
/// +x; of a hand that ever turns further than 120 degrees from it, from row to row.
std::vector<Quaternion> held_orientations(const std::vector<Vector3>& directions, const Vector3& usual);

/// What holds the cable.
struct HeldEnds {
  FrameTrack start, end;
};

/// The directions in which hands hold start and end, as unit vectors from start to end of the cable.
using HeldDirections = std::array<Vector3, 2>;

/// The mean ones of some recordings; +x where there is none.
HeldDirections usual_directions(const std::vector<const Recording*>& recordings);

/// The frames in the outer markers, +x along the cable from start to end. Roll was not recorded: the hands' axes are the world's,
/// turned the smallest way from +x to the direction of the first row, then from row to row.
HeldEnds held_ends(const Recording& recording);

/// The same with the hands' axes turned the smallest way from +x to the usual direction, and from there to that of each row; of a
/// hand that ever turns further than 120 degrees from it, to that of the first row, then from row to row.
HeldEnds held_ends(const Recording& recording, const HeldDirections& usual);

}  // namespace verlet_cable::cable_fit
