#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// A segment of one of several cables.
struct SegmentId {
  int cable = 0, segment = 0;
};

/// Pairs of segments that may touch soon. They stay valid as long as no node has moved by more than a margin, so that most
/// substeps find them ready.
struct SegmentPairs {
  struct Pair {
    SegmentId first, second;              ///< ascending
    int first_node = 0, second_node = 0;  ///< of the segments, into the arrays of nodes
    double distance = 0;                  ///< [m] of the centre lines
    bool may_adjoin = false;              ///< whether they do follows from the rest lengths now, see SegmentGrid::adjoin
  };
  std::vector<Pair> pairs;  ///< ascending
  // When they were found; nowhere: never
  std::vector<Vector3> places;       ///< [m] of the nodes, cable by cable
  double margin = 0;                 ///< [m] that a node may move
  std::vector<double> rest_lengths;  ///< [m] of the segments; by their first nodes
  double rest_margin = 0;            ///< [m] that those of a cable may change by, in all: winches and guides change them
  // Now
  std::vector<double> moved;   ///< [m] by a segment since, at either end; by its first node
  std::vector<double> speeds;  ///< [m/s] of a segment, at either end; likewise
};

/// Finds pairs of segments with a hash of cubic cells (Teschner et al., Optimized Spatial Hashing for Collision Detection of
/// Deformable Objects, 2003).
class SegmentGrid {
 public:
  /// Which pairs count.
  struct Rules {
    bool self = false;            ///< segments of one cable
    bool between_cables = false;  ///< segments of two
  };
  /// A node of a cable that is joined with others at a junction.
  struct JoinedNode {
    int cable = 0, node = 0;
    int junction = 0;  ///< the body that it is
  };

  /// Brings `found` up to date: those of `group`, ascending indices into `cables`, whose centre lines may come closer in the
  /// next h [s] than the sum of the radii and `reach` [m]. No centre lines of a pair are closer now than its distance less what
  /// its two segments have moved. Those that adjoin are left out, but for pairs of which that may change.
  void update(const std::vector<SimulatedCable>& cables, const std::vector<int>& group, const Rules& rules,
              const std::vector<JoinedNode>& joined, double reach, double h, SegmentPairs& found);

  /// Whether two segments, ascending, are so close to each other along the cable, or by way of a junction, that they do not count
  /// as touching: closer than their radii ask for and `spare` [m] more.
  static bool adjoin(const std::vector<SimulatedCable>& cables, const std::vector<JoinedNode>& joined, const SegmentId& first,
                     const SegmentId& second, double spare = 0);

 private:
  struct Entry {
    SegmentId id;
    int node;  ///< its first one, among all
    Vector3 middle;
    double radius;  ///< of a ball around the capsule, with margin
    std::array<std::int32_t, 3> cell{};
    int next;  ///< in the same bucket, -1: none
  };

  void fill(const std::vector<SimulatedCable>& cables, const std::vector<int>& group, double reach, double margin);
  void collect(const std::vector<SimulatedCable>& cables, const Rules& rules, const std::vector<JoinedNode>& joined, double reach,
               SegmentPairs& found);
  std::size_t bucket(const std::array<std::int32_t, 3>& cell) const;

  std::vector<Entry> entries_;
  std::vector<int> buckets_;  ///< first entry, -1: none; a power of two of them
  std::vector<int> near_;
};

}  // namespace verlet_cable
