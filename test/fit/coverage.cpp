// Fits cables to recordings of a rod that another program has simulated, again and again with other noise, and prints what was
// found over what is true, and how often the 95 % intervals of what is determined hold the truth. Run by scripts/real.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/world/parallel_for.h"
#include "known_rod.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr int takes = 4, motions = 20, segments = 40, rod_segments = 80;
constexpr double duration = 2;  // [s]
constexpr int known = 7;        ///< parameters whose values are known, and not 0

struct Tally {
  double predicting = 0, found = 0, furthest = 1;  // found over true, a sum of sets
  int determined = 0, held = 0;
};

double ratio(std::size_t parameter, const Parameter& of, double value) {
  return scene_value(of, value) / scene_value(of, value_of_rod(parameter));
}

void print_table(const std::vector<Recording>& clean, const char* motion, double noise, int sets) {
  std::vector<Tally> tallies(known);
  std::vector<std::string> names;
  int curvatures = 0;
  for (int set = 0; set < sets; ++set) {
    std::vector<Recording> recordings;
    for (int take = 0; take < takes; ++take) {
      const std::size_t which = static_cast<std::size_t>(set + take) % clean.size();
      recordings.push_back(with_noise(clean[which], noise, static_cast<unsigned>(1000 * set + take)));
    }
    const FoundRod rod = find_rod(recordings, segments);
    names.clear();
    for (std::size_t i = 0; i < rod.parameters.size(); ++i) {
      const Confidence& confidence = rod.estimate.confidence[i];
      if (i >= known) {
        curvatures += confidence.told;
        continue;
      }
      names.push_back(rod.parameters[i].key);
      Tally& tally = tallies[i];
      const double found = ratio(i, rod.parameters[i], rod.estimate.values[i]);
      tally.predicting += ratio(i, rod.parameters[i], rod.predicting[i]) / sets;
      tally.found += found / sets;
      if (std::abs(found - 1) > std::abs(tally.furthest - 1)) tally.furthest = found;
      tally.determined += confidence.told;
      tally.held += confidence.told && std::abs(rod.estimate.values[i] - value_of_rod(i)) <= confidence.half_width;
    }
    std::fprintf(stderr, "%s, %g mm: set %d of %d\n", motion, 1000 * noise, set + 1, sets);
  }
  std::printf("\n%s, %g mm of noise:\n\n", motion, 1000 * noise);
  std::printf(
      "| parameter | predicting best / true | found / true | furthest from 1 | determined | of these, intervals that hold the "
      "truth |\n");
  std::printf("|---|---|---|---|---|---|\n");
  for (int i = 0; i < known; ++i)
    std::printf("| `%s` | %.3f | %.3f | %.3f | %d of %d | %d |\n", names[i].c_str(), tallies[i].predicting, tallies[i].found,
                tallies[i].furthest, tallies[i].determined, sets, tallies[i].held);
  std::printf("\nCurvatures of the straight rod called determined: %d\n", curvatures);
  std::fflush(stdout);
}

std::vector<Recording> record(int count, unsigned first_seed, double pace, double seconds) {
  std::vector<Recording> recordings(count);
  parallel_for(recordings.size(), [&](std::size_t i) {
    recordings[i] = recording_of_rod(first_seed + static_cast<unsigned>(i), pace, seconds, rod_segments);
  });
  return recordings;
}

}  // namespace
}  // namespace verlet_cable::cable_fit

int main(int argc, char** argv) {
  using namespace verlet_cable::cable_fit;
  const int sets = argc > 1 ? std::atoi(argv[1]) : 20;
  const std::vector<Recording> fast = record(motions, 1, 1, duration);
  for (const double noise : {0.002, 0.004, 0.001}) print_table(fast, "Swinging hands", noise, sets);
  print_table(record(takes, 101, 0.12, duration), "Slow hands", 0.002, std::min(sets, 5));
}
