// Fits cables to synthetic recordings with 2 mm of noise, again and again with other noise, and prints what was found over what
// is true, and how often the 95 % intervals hold the truth. Run by scripts/real.
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "cable_fit/confidence.h"
#include "cable_fit/least_squares.h"
#include "synthetic.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr int tries = 10, takes = 4, segments = 32;
constexpr double duration = 4, noise = 0.002;  // [s], [m]

struct Known {
  const char* name;
  double (*value)(const MaterialDesc& material);
};
constexpr Known known_values[] = {
    // in the order of the parameters
    {"bending_stiffness", [](const MaterialDesc& m) { return m.bending_stiffness.front(); }},
    {"bending_damping", [](const MaterialDesc& m) { return m.bending_damping; }},
    {"drag", [](const MaterialDesc& m) { return m.drag; }},
    {"torsional_stiffness", [](const MaterialDesc& m) { return m.torsional_stiffness; }},
};

struct Found {
  double ratio[std::size(known_values)];
  bool covered[std::size(known_values)];
};

Found found_by(const Problem& problem, const std::vector<double>& values, const MaterialDesc& truth) {
  const std::vector<Confidence> intervals = confidence(problem, values);
  Found found;
  for (std::size_t i = 0; i < std::size(known_values); ++i) {
    const double difference = values[i] - std::log10(known_values[i].value(truth));
    found.ratio[i] = std::pow(10, difference);
    found.covered[i] = std::abs(difference) <= intervals[i].half_width;
  }
  return found;
}

/// By the line through the markers, and by the centre line.
std::array<Found, 2> one_try(int number) {
  const SceneDesc known = known_cable();
  const MaterialDesc& truth = known.materials[0].material;
  std::vector<Recording> recordings;
  std::vector<Smoothed> inputs;
  for (int take = 0; take < takes; ++take) {
    recordings.push_back(synthetic_recording(known, take, duration, noise, 100 * (number + 1)));
    inputs.push_back(smoothed(recordings.back()));
  }
  CableSettings settings;
  settings.name = "found";
  settings.segments = segments;
  settings.linear_density = truth.linear_density;
  std::vector<int> all(takes);
  std::iota(all.begin(), all.end(), 0);
  measure_cable(recordings, inputs, all, settings);
  const Problem on_markers{recordings, inputs, settings, cable_parameters(settings), [] {}};
  const std::vector<double> line = fit(on_markers, all, coarse_search(on_markers, all));
  settings.centre_line = true;
  const Problem beside{recordings, inputs, settings, cable_parameters(settings), [] {}};
  return {found_by(on_markers, line, truth), found_by(beside, fit(beside, all, with_markers_on_line(settings, line)), truth)};
}

void print_table(const char* title, const std::vector<Found>& found) {
  std::printf(
      "\n%s\n\n| parameter | mean of found / true | furthest from 1 | intervals that hold the truth |\n|---|---|---|---|\n",
      title);
  for (std::size_t i = 0; i < std::size(known_values); ++i) {
    double mean = 0, furthest = 1;
    int covered = 0;
    for (const Found& one : found) {
      mean += one.ratio[i] / tries;
      if (std::abs(one.ratio[i] - 1) > std::abs(furthest - 1)) furthest = one.ratio[i];
      covered += one.covered[i];
    }
    std::printf("| %s | %.3f | %.3f | %d of %d |\n", known_values[i].name, mean, furthest, covered, tries);
  }
}

}  // namespace
}  // namespace verlet_cable::cable_fit

int main() {
  using namespace verlet_cable::cable_fit;
  std::vector<Found> on_markers, beside;
  for (int number = 0; number < tries; ++number) {
    const std::array<Found, 2> found = one_try(number);
    on_markers.push_back(found[0]);
    beside.push_back(found[1]);
  }
  print_table("Line through the markers:", on_markers);
  print_table("Centre line:", beside);
}
