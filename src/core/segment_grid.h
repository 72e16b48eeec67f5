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

/// Finds the pairs of segments that may touch soon, with a hash of cubic cells (Teschner et al., Optimized Spatial Hashing for
/// Collision Detection of Deformable Objects, 2003). The pairs stay valid as long as no node has moved by more than a margin, so
/// that most substeps find them ready.
class SegmentGrid {
 public:
  struct Pair {
    SegmentId first, second;  ///< ascending
  };
  /// Which pairs count.
  struct Rules {
    bool self = false;            ///< segments of one cable
    bool between_cables = false;  ///< segments of two
  };

  /// Brings `pairs` up to date: those of `group`, ascending indices into `cables`, whose centre lines may come closer in the
  /// next h [s] than the sum of the radii and `reach` [m].
  void update(const std::vector<SimulatedCable>& cables, const std::vector<int>& group, const Rules& rules, double reach,
              double h);
  /// The pairs have to be found anew.
  void invalidate() { valid_ = false; }
  /// Ascending.
  const std::vector<Pair>& pairs() const { return pairs_; }

 private:
  struct Entry {
    SegmentId id;
    Vector3 middle;
    double radius;  ///< of a ball around the capsule, with margin
    std::array<std::int32_t, 3> cell{};
    int next;  ///< in the same bucket, -1: none
  };

  bool still_valid(const std::vector<SimulatedCable>& cables, const std::vector<int>& group, double h) const;
  void fill(const std::vector<SimulatedCable>& cables, const std::vector<int>& group, double reach, double h);
  void collect(const std::vector<SimulatedCable>& cables, const Rules& rules);
  std::size_t bucket(const std::array<std::int32_t, 3>& cell) const;

  bool valid_ = false;
  double margin_ = 0;           ///< [m] that a node may move
  std::vector<Vector3> built_;  ///< places of the nodes when the pairs were found [m]
  std::vector<Entry> entries_;
  std::vector<int> buckets_;  ///< first entry, -1: none; a power of two of them
  std::vector<int> near_;
  std::vector<Pair> pairs_;
};

}  // namespace verlet_cable
