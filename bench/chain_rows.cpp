#include <algorithm>

#include "rows.h"
#include "search.h"

namespace verlet_cable::bench {

namespace {

constexpr double duration = 10;
constexpr int repetitions = 3;

/// Both costs measured again, in turns, so that the machine's other load meets both; the least of each counts.
void measure_in_turns(Best& first, Best& second, double processor_limit) {
  for (int i = 0; i < repetitions; ++i)
    for (Best* best : {&first, &second})
      best->cost = std::min(best->cost, processor_time_per_second(*best->candidate.make(), duration, processor_limit));
}

std::string real_time_factor(const SearchResult& found) {
  return found.best ? figure(1 / found.best->cost) : "-";
}

std::string setting(const SearchResult& found) {
  return found.best ? found.best->candidate.name : "none";
}

/// A row: the package and a peer, each at its fastest accepted setting.
void compare(Report& report, SearchResult ours, SearchResult peer, int segments, double target) {
  if (ours.best && peer.best) measure_in_turns(*ours.best, *peer.best, 5);
  std::string ratio = "-", verdict;
  if (ours.best && peer.best) {
    const double value = peer.best->cost / ours.best->cost;
    ratio = figure(value);
    verdict = report.at_least(value, target);
  } else {
    verdict = ours.best ? "peer never accepted" : report.at_least(0, 1);
  }
  report.row({std::to_string(segments), setting(ours), real_time_factor(ours), setting(peer), real_time_factor(peer), ratio,
              figure(target), verdict});
  for (const SearchResult* result : {&ours, &peer}) {
    const char* name = result == &ours ? "package" : "peer";
    if (!result->best)
      report.note(std::string(name) + ": none of " + std::to_string(result->tried) + " settings accepted" +
                  (result->complete ? "" : " in the time given") + "; nearest " + result->nearest);
    else
      report.note(std::string(name) + ": strain " + figure(result->best->verdict.strain, 2) + ", energy error " +
                  figure(result->best->verdict.energy_error, 2) + " m g L, tip at 0.4 s " +
                  figure(result->best->verdict.tip_height, 4) + " m");
  }
}

const std::vector<std::string>& columns() {
  static const std::vector<std::string> names{"     n",     "time step", "     RTF", "       peer's setting",
                                              "peer's RTF", " ratio",    "target",   "verdict"};
  return names;
}

}  // namespace

void released_against_bullet(Report& report, bool quick) {
  report.table("Released from the horizontal, undamped, 10 s: real-time factors (RTF) against Bullet's soft-body rope",
               columns());
  const std::vector<std::pair<int, double>> targets{{20, 10}, {50, 12}, {100, 35}, {200, 100}};  // segments, ratio
  for (std::size_t i = 0; i < (quick ? 2 : targets.size()); ++i) {
    const auto [n, target] = targets[i];
    const RopeTask task = released_from_horizontal(n);
    Criteria criteria;
    criteria.energy_gain = 0.05;
    criteria.tip_height = true;
    const double limit = quick ? 20 : 120;
    compare(report, find_fastest(cable_candidates(task), task, criteria, limit),
            find_first(bullet_candidates(task), task, criteria, limit), n, target);
  }
}

void released_against_simbody(Report& report, bool quick) {
  report.table(
      "The same without numerical damping, energy error below 1 % of m g L throughout: against Simbody (pins and point masses)",
      columns());
  for (const int n : quick ? std::vector<int>{20} : std::vector<int>{20, 50, 100}) {
    RopeTask task = released_from_horizontal(n);
    task.numerical_damping = false;
    Criteria criteria;
    criteria.energy_error = 0.01;
    const double limit = quick ? 20 : 120;
    compare(report, find_fastest(cable_candidates(task), task, criteria, limit),
            find_fastest(simbody_candidates(task), task, criteria, limit), n, 100);
  }
}

void driven_against_bullet(Report& report, bool quick) {
  report.table("Both ends held, one driven 0.1 m at 1 Hz, 10 s, strain below 1 %: against Bullet's soft-body rope", columns());
  const RopeTask task = driven(100);
  const Criteria criteria;
  const double limit = quick ? 20 : 120;
  compare(report, find_fastest(cable_candidates(task), task, criteria, limit),
          find_first(bullet_candidates(task), task, criteria, limit), task.segments, 15);
}

}  // namespace verlet_cable::bench
