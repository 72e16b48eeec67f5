#include "net/long_range_attachments.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <tuple>

namespace verlet_cable {

namespace {

/// More would cost more than they help.
constexpr std::size_t most_tethers = 3;

struct Arrival {
  double length = 0;  ///< [m]
  int node = 0, held = 0, links = 0;
  bool operator>(const Arrival& other) const {
    return std::tie(length, node, held) > std::tie(other.length, other.node, other.held);
  }
};

struct Neighbour {
  int node;
  double length;  ///< [m]
};

std::vector<std::vector<Neighbour>> find_neighbours(const NetModel& model) {
  std::vector<std::vector<Neighbour>> neighbours(model.masses.size());
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    const auto [i, j] = model.links[link];
    neighbours[i].push_back({j, model.rest_lengths[link]});
    neighbours[j].push_back({i, model.rest_lengths[link]});
  }
  return neighbours;
}

}  // namespace

/// Dijkstra's algorithm from all held nodes at once: the shortest ways to each node from the nearest few.
void LongRangeAttachments::resize(const NetModel& model, const std::vector<HeldNode>& held, double stretch) {
  long_range_attachments_.clear();
  impulses_.assign(held.size(), Vector3::Zero());
  most_links_ = 0;
  const std::vector<std::vector<Neighbour>> neighbours = find_neighbours(model);
  std::vector<std::vector<Way>> reached_from(model.masses.size());
  std::vector<std::vector<Way>> waiting(model.masses.size());
  std::priority_queue<Arrival, std::vector<Arrival>, std::greater<>> ways;
  // What is no shorter than another that waits, from the same held node, would come to nothing.
  const auto push = [&](const Arrival& way) {
    if (reached_from[way.node].size() == most_tethers) return;
    std::vector<Way>& known = waiting[way.node];
    const auto same = std::find_if(known.begin(), known.end(), [&](const Way& other) { return other.held == way.held; });
    if (same != known.end() && same->length <= way.length) return;
    if (same != known.end())
      same->length = way.length;
    else
      known.push_back({way.length, way.held});
    ways.push(way);
  };
  for (std::size_t k = 0; k < held.size(); ++k) push({0, held[k].node, static_cast<int>(k), 0});
  while (!ways.empty()) {
    const Arrival way = ways.top();
    ways.pop();
    std::vector<Way>& from = reached_from[way.node];
    const auto known = [&](const Way& other) { return other.held == way.held; };
    if (from.size() == most_tethers || std::any_of(from.begin(), from.end(), known)) continue;
    if (from.empty()) most_links_ = std::max(most_links_, way.links);
    from.push_back({way.length, way.held});
    if (way.links > 0) long_range_attachments_.push_back({way.node, way.held, stretch * way.length});
    for (const Neighbour& next : neighbours[way.node]) push({way.length + next.length, next.node, way.held, way.links + 1});
  }
  std::stable_sort(long_range_attachments_.begin(), long_range_attachments_.end(),
                   [](const Tether& a, const Tether& b) { return a.node < b.node; });
  find_spans(reached_from);
}

/// Ways from two held nodes that meet at a node are a way between the two.
void LongRangeAttachments::find_spans(const std::vector<std::vector<Way>>& ways) {
  std::map<std::pair<int, int>, double> lengths;
  for (const std::vector<Way>& here : ways)
    for (std::size_t a = 0; a < here.size(); ++a)
      for (std::size_t b = a + 1; b < here.size(); ++b) {
        const double length = here[a].length + here[b].length;
        const auto [at, added] = lengths.try_emplace(std::minmax(here[a].held, here[b].held), length);
        if (!added) at->second = std::min(at->second, length);
      }
  spans_.clear();
  for (const auto& [ends, length] : lengths) spans_.push_back({ends.first, ends.second, length});
}

int LongRangeAttachments::overstretched_node(const std::vector<HeldNode>& held, double stretch) const {
  for (const Span& span : spans_)
    if ((held[span.first].position - held[span.second].position).norm() > stretch * span.length) return held[span.first].node;
  return -1;
}

void LongRangeAttachments::pull(const std::vector<HeldNode>& held, double h, LinkArrays& arrays) {
  std::fill(impulses_.begin(), impulses_.end(), Vector3::Zero());
  for (const Tether& tether : long_range_attachments_) {
    const double inverse_mass = arrays.inverse_mass[tether.node];
    if (inverse_mass == 0) continue;
    const Vector3 velocity = get(arrays.velocity, tether.node);
    const Vector3 away = get(arrays.position, tether.node) + h * velocity - held[tether.held].position;
    const double square = away.squaredNorm();
    if (square <= tether.length * tether.length) continue;
    const double distance = std::sqrt(square);
    const Vector3 change = (distance - tether.length) / (h * distance) * away;
    set(arrays.velocity, tether.node, velocity - change);
    impulses_[tether.held] += change / inverse_mass;
  }
}

}  // namespace verlet_cable
