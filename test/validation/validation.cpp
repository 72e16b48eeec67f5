#include "validation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace verlet_cable::validation {

namespace {

/// Below this, errors are of Newton's tolerance and rounding, and have no order.
constexpr double error_floor = 2e-8;
/// What a second-order error may show between two refinements that are not infinitely fine.
constexpr double lowest_order = 1.8;

void append(const std::string& file, const std::string& rows) {
  if (const char* directory = std::getenv("VALIDATION_OUTPUT"))
    std::ofstream(std::string(directory) + "/" + file, std::ios::app) << rows;
}

/// For CSV: names have commas.
std::string in_quotes(const std::string& name) {
  return '"' + name + '"';
}

}  // namespace

std::string short_text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

void Simulation::step() {
  ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok) << "at t = " << world.time();
}

void Simulation::run(double duration) {
  for (long steps = std::lround(duration / world.time_step()); steps > 0 && !testing::Test::HasFatalFailure(); --steps) step();
}

const Vector3& Simulation::force(const std::string& attachment) const {
  return world.attachments()[find(world.attachments(), attachment)].force;
}

const Vector3& Simulation::torque(const std::string& attachment) const {
  return world.attachments()[find(world.attachments(), attachment)].torque;
}

void report(const std::string& name, const std::vector<Sample>& samples, double tolerance, Order order) {
  std::string line = "validation: " + name + ":";
  std::string rows;
  for (const Sample& s : samples) {
    line += " " + short_text(s.error) + " (n = " + short_text(s.n) + ")";
    rows += in_quotes(name) + "," + short_text(s.n) + "," + short_text(s.error) + "," + short_text(tolerance) + "\n";
  }
  const Sample& last = samples.back();
  if (samples.size() > 1) {
    const Sample& before = samples[samples.size() - 2];
    const double slope = std::log(before.error / last.error) / std::log(last.n / before.n);
    line += ", order " + short_text(slope);
    if (order == Order::second && last.error > error_floor) {
      EXPECT_GT(slope, lowest_order) << name;
    }
  }
  std::printf("%s, to reach %s\n", line.c_str(), short_text(tolerance).c_str());
  std::string key = name;
  std::replace_if(
      key.begin(), key.end(), [](char c) { return c == ' ' || c == ',' || c == ':'; }, '_');
  testing::Test::RecordProperty(key, short_text(last.error));
  append("errors.csv", rows);
  EXPECT_LT(last.error, tolerance) << name;
}

void record_curve(const std::string& name, const std::string& label, const std::vector<double>& x, const std::vector<double>& y) {
  std::string rows;
  for (std::size_t i = 0; i < x.size(); ++i)
    rows += in_quotes(name) + "," + label + "," + std::to_string(x[i]) + "," + std::to_string(y[i]) + "\n";
  append("curves.csv", rows);
}

std::vector<Sample> sample(const std::vector<int>& segments, const std::function<double(int)>& error) {
  std::vector<Sample> samples;
  for (const int n : segments) samples.push_back({static_cast<double>(n), std::abs(error(n))});
  return samples;
}

double angular_frequency(Simulation& run, const std::function<double(const Simulation&)>& amplitude, int half_periods) {
  double before = amplitude(run), first = 0;
  for (int crossings = 0; !testing::Test::HasFatalFailure();) {
    run.step();
    const double now = amplitude(run);
    if ((before < 0) != (now < 0)) {
      const double time = run.world.time() - run.world.time_step() * now / (now - before);
      if (crossings == 0) first = time;
      if (crossings++ == half_periods) return half_periods * M_PI / (time - first);
    }
    if (run.world.time() > 1000) break;
    before = now;
  }
  ADD_FAILURE() << "no oscillation";
  return 0;
}

}  // namespace verlet_cable::validation
