#pragma once

#include <optional>

#include "acceptance.h"

namespace verlet_cable::bench {

/// The fastest setting that is accepted.
struct Best {
  Candidate candidate;
  Verdict verdict;
  double cost = 0;  ///< processor time a simulated second [s]
};

struct SearchResult {
  std::optional<Best> best;
  int tried = 0;
  bool complete = true;  ///< false: the processor time ran out before all candidates were tried
  std::string nearest;   ///< without an accepted one: the setting that went furthest, and what stopped it
};

/// Tries every candidate, each no longer than the fastest so far took.
SearchResult find_fastest(const std::vector<Candidate>& candidates, const RopeTask& task, const Criteria& criteria,
                          double processor_limit);
/// For candidates in the order of their cost: the first that is accepted, or one of the next few.
SearchResult find_first(const std::vector<Candidate>& candidates, const RopeTask& task, const Criteria& criteria,
                        double processor_limit);

}  // namespace verlet_cable::bench
