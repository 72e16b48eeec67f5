#include "search.h"

#include <algorithm>

#include "stopwatch.h"

namespace verlet_cable::bench {

namespace {

/// A cost is only an estimate until it is measured: so many more are tried after the first success.
constexpr int tried_after_success = 3;
/// What checking costs besides the run itself.
constexpr double patience = 1.5;

SearchResult search(const std::vector<Candidate>& candidates, const RopeTask& task, const Criteria& criteria,
                    double processor_limit, bool ordered) {
  SearchResult result;
  const double start = processor_seconds();
  double furthest = -1;
  int after_success = 0;
  for (const Candidate& candidate : candidates) {
    if (ordered && result.best && ++after_success > tried_after_success) break;
    const double left = processor_limit - (processor_seconds() - start);
    if (left <= 0) {
      result.complete = false;
      break;
    }
    ++result.tried;
    const double useful = result.best ? patience * result.best->cost * criteria.duration + 0.01 : left;
    const Verdict verdict = check(*candidate.make(), task, criteria, std::min(left, useful));
    if (!verdict.accepted) {
      if (verdict.progress > furthest) {
        furthest = verdict.progress;
        result.nearest =
            candidate.name + ": " + verdict.reason + " after " + std::to_string(verdict.progress).substr(0, 5) + " s";
      }
      continue;
    }
    const double cost = processor_time_per_second(*candidate.make(), criteria.duration, std::min(useful, 1e9));
    if (!result.best || cost < result.best->cost) result.best = Best{candidate, verdict, cost};
  }
  return result;
}

}  // namespace

SearchResult find_fastest(const std::vector<Candidate>& candidates, const RopeTask& task, const Criteria& criteria,
                          double processor_limit) {
  return search(candidates, task, criteria, processor_limit, false);
}

SearchResult find_first(const std::vector<Candidate>& candidates, const RopeTask& task, const Criteria& criteria,
                        double processor_limit) {
  return search(candidates, task, criteria, processor_limit, true);
}

}  // namespace verlet_cable::bench
