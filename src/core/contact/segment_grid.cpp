#include "contact/segment_grid.h"

#include <algorithm>
#include <cmath>

#include "contact/keep_nearest.h"
#include "geometry/segment_geometry.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// Segments of one cable touch only where the cable between them is longer than this, in radii: it cannot bend more sharply.
constexpr double bend_radii = 2.5;
/// Those that a junction joins only where the way between them through it is longer than this, in radii: branches come off at
/// angles, and are in each other there.
constexpr double junction_radii = 12;
/// A margin lets nodes move for so many substeps until the pairs have to be found anew,
constexpr double margin_substeps = 20;
/// by no more than so many segment lengths, or a radius, and no less than this part of a radius.
constexpr double margin_segments = 0.5;
constexpr double least_margin = 0.2;
/// Others that a segment is watched for: where more are as near, cables are heaped up in one place, and the nearest count.
constexpr std::size_t most_neighbours = 256;

double largest_speed(const std::vector<SimulatedCable>& cables, const std::vector<int>& group) {
  double square = 0;
  for (const int cable : group)
    for (const Vector3& v : cables[cable].state.velocities) square = std::max(square, v.squaredNorm());
  return std::sqrt(square);
}

/// Whether the cable from one node to another is longer than `length` [m], at rest.
bool longer(const CableState& state, int first, int last, double length) {
  for (int i = first; i < last; ++i) {
    length -= state.rest_lengths[i];
    if (length < 0) return true;
  }
  return false;
}

/// [m] Along the cable at rest, from a segment to a node; infinite where it is longer than `length` [m].
double way_to(const CableState& state, int segment, int node, double length) {
  double way = 0;
  for (int i = std::min(node, segment + 1); i < std::max(node, segment); ++i) {
    way += state.rest_lengths[i];
    if (way > length) return infinity;
  }
  return way;
}

/// Whether the way from one segment to another through a junction is no longer than `length` [m].
bool close_at_junction(const std::vector<SimulatedCable>& cables, const std::vector<JoinedNode>& joined, const SegmentId& first,
                       const SegmentId& second, double length) {
  for (const JoinedNode& a : joined) {
    if (a.cable != first.cable) continue;
    const double way = way_to(cables[a.cable].state, first.segment, a.node, length);
    if (way > length) continue;
    for (const JoinedNode& b : joined)
      if (b.junction == a.junction && b.cable == second.cable &&
          way + way_to(cables[b.cable].state, second.segment, b.node, length) <= length)
        return true;
  }
  return false;
}

/// How far and how fast the nodes have come since pairs were found; then, of the two nodes of a segment, the larger. False if
/// one may leave its margin in the next h [s].
bool follow_nodes(const std::vector<SimulatedCable>& cables, const std::vector<int>& group, double h, SegmentPairs& found) {
  std::size_t k = 0;
  for (const int cable : group) {
    const CableState& state = cables[cable].state;
    const std::size_t first = k, nodes = state.positions.size();
    if (first + nodes > found.places.size()) return false;
    for (std::size_t i = 0; i < nodes; ++i, ++k) {
      const double moved = (state.positions[i] - found.places[k]).norm(), speed = state.velocities[i].norm();
      if (!(moved + h * speed <= found.margin)) return false;
      found.moved[k] = moved;
      found.speeds[k] = speed;
    }
    for (std::size_t i = first; i + 1 < k; ++i) {
      found.moved[i] = std::max(found.moved[i], found.moved[i + 1]);
      found.speeds[i] = std::max(found.speeds[i], found.speeds[i + 1]);
    }
  }
  return k == found.places.size();
}

/// [m] That nodes may move until the pairs have to be found anew.
double find_margin(const std::vector<SimulatedCable>& cables, const std::vector<int>& group, double h) {
  double longest = 0, thickest = 0;
  for (const int cable : group) {
    longest =
        std::max(longest, *std::max_element(cables[cable].state.rest_lengths.begin(), cables[cable].state.rest_lengths.end()));
    thickest = std::max(thickest, CableMaterials(cables[cable]).largest_radius());
  }
  const double way = h * largest_speed(cables, group);
  return std::clamp(margin_substeps * way, least_margin * thickest, std::max(thickest, margin_segments * longest)) + 2 * way;
}

/// Of the pairs of a segment, which are the last ones, from `first` on, descending: those that are the closest.
void keep_closest(std::size_t first, std::vector<SegmentPairs::Pair>& pairs) {
  using Pair = SegmentPairs::Pair;
  const auto nearer = [](const Pair& a, const Pair& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.second_node < b.second_node;
  };
  keep_nearest(first, most_neighbours, pairs, nearer, [](const Pair& a, const Pair& b) { return a.second_node > b.second_node; });
}

}  // namespace

bool can_touch(const std::vector<SimulatedCable>& cables, const std::vector<JoinedNode>& joined, const SegmentPairs::Pair& pair) {
  const SegmentId &first = pair.first, &second = pair.second;
  const SimulatedCable &cable = cables[first.cable], &other = cables[second.cable];
  const double thicker = std::max(CableMaterials(cable)[first.segment].radius, CableMaterials(other)[second.segment].radius);
  if (first.cable == second.cable && !longer(cable.state, first.segment + 1, second.segment, bend_radii * thicker)) return false;
  return joined.empty() || !close_at_junction(cables, joined, first, second, junction_radii * thicker);
}

void SegmentGrid::update(const std::vector<SimulatedCable>& cables, const std::vector<int>& group, const Rules& rules,
                         double reach, double h, SegmentPairs& found) {
  if (follow_nodes(cables, group, h, found)) return;
  found.margin = find_margin(cables, group, h);
  found.places.clear();
  for (const int cable : group) {
    const std::vector<Vector3>& places = cables[cable].state.positions;
    found.places.insert(found.places.end(), places.begin(), places.end());
  }
  found.moved.resize(found.places.size());
  found.speeds.resize(found.places.size());
  fill(cables, group, reach, found.margin);
  collect(cables, rules, reach, found);
  follow_nodes(cables, group, h, found);
}

void SegmentGrid::fill(const std::vector<SimulatedCable>& cables, const std::vector<int>& group, double reach, double margin) {
  entries_.clear();
  double largest = 0;
  int node = 0;
  for (const int cable : group) {
    const CableMaterials materials(cables[cable]);
    const std::vector<Vector3>& x = cables[cable].state.positions;
    for (int i = 0; i < cables[cable].state.segments(); ++i, ++node) {
      Entry entry;
      entry.id = {cable, i};
      entry.node = node;
      entry.middle = 0.5 * (x[i] + x[i + 1]);
      entry.radius = 0.5 * (x[i + 1] - x[i]).norm() + materials[i].radius + 0.5 * reach + margin;
      entry.next = -1;
      largest = std::max(largest, entry.radius);
      entries_.push_back(entry);
    }
    ++node;
  }
  const double cell = 2 * largest;
  for (Entry& entry : entries_)
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double far = 1e9;  // what is further away shares the outermost cells
      entry.cell[axis] = static_cast<std::int32_t>(std::floor(std::clamp(entry.middle[axis] / cell, -far, far)));
    }
}

void SegmentGrid::collect(const std::vector<SimulatedCable>& cables, const Rules& rules, double reach, SegmentPairs& found) {
  found.pairs.clear();
  std::size_t buckets = 1;
  while (buckets < 2 * entries_.size()) buckets *= 2;
  buckets_.assign(buckets, -1);
  // From the last one on, so that each meets those after it alone.
  for (int a = static_cast<int>(entries_.size()) - 1; a >= 0; --a) {
    Entry& first = entries_[a];
    const double radius = CableMaterials(cables[first.id.cable])[first.id.segment].radius;
    near_.clear();
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const std::array<std::int32_t, 3> cell{first.cell[0] + dx, first.cell[1] + dy, first.cell[2] + dz};
          for (int b = buckets_[bucket(cell)]; b >= 0; b = entries_[b].next) {
            const Entry& second = entries_[b];
            if (second.cell[0] != cell[0] || second.cell[1] != cell[1] || second.cell[2] != cell[2]) continue;
            const double sum = first.radius + second.radius;
            if ((first.middle - second.middle).squaredNorm() > sum * sum) continue;
            const bool same = first.id.cable == second.id.cable;
            if (same ? !rules.self || second.id.segment == first.id.segment + 1 : !rules.between_cables) continue;
            near_.push_back(b);
          }
        }
    int& own_bucket = buckets_[bucket(first.cell)];
    first.next = own_bucket;
    own_bucket = a;
    std::sort(near_.rbegin(), near_.rend());
    const Vector3 &start = found.places[first.node], &end = found.places[first.node + 1];
    const std::size_t before = found.pairs.size();
    for (const int b : near_) {
      const Entry& second = entries_[b];
      const Vector3 &other_start = found.places[second.node], &other_end = found.places[second.node + 1];
      const SegmentFractions closest = closest_fractions(start, end, other_start, other_end);
      const double distance =
          (start + closest.first * (end - start) - other_start - closest.second * (other_end - other_start)).norm();
      const double far = radius + CableMaterials(cables[second.id.cable])[second.id.segment].radius + reach + 2 * found.margin;
      if (distance <= far) found.pairs.push_back({first.id, second.id, first.node, second.node, distance});
    }
    keep_closest(before, found.pairs);
  }
  std::reverse(found.pairs.begin(), found.pairs.end());
}

std::size_t SegmentGrid::bucket(const std::array<std::int32_t, 3>& cell) const {
  const std::uint64_t hash = static_cast<std::uint64_t>(cell[0]) * 73856093u ^ static_cast<std::uint64_t>(cell[1]) * 19349663u ^
                             static_cast<std::uint64_t>(cell[2]) * 83492791u;
  return hash & (buckets_.size() - 1);
}

}  // namespace verlet_cable
