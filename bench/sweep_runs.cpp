// The samples of a sweep without Python, Dask and Zarr: what scripts/bench sweep compares cable_sweep with.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "simulation/batch.h"
#include "simulation/driven_world.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable::bench {
namespace {

constexpr int steps = 200;       ///< of 5 ms, as the sweep's duration says
constexpr int record_every = 4;  ///< 50 Hz
constexpr std::size_t chunk = 128;
constexpr Quantity quantities[]{Quantity::positions, Quantity::tension};

/// What varies, of one sample.
struct Values {
  double length = 0, drag = 0, linear_density = 0;
};

std::vector<Values> read_values(const char* file) {
  std::ifstream in(file);
  std::vector<Values> all;
  for (Values values; in >> values.length >> values.drag >> values.linear_density;) all.push_back(values);
  return all;
}

std::shared_ptr<const SceneDesc> scene_of(const SceneDesc& base, const Values& values) {
  auto scene = std::make_shared<SceneDesc>(base);
  scene->cables[0].length = values.length;
  scene->materials[0].material.drag = values.drag;
  scene->materials[0].material.linear_density = values.linear_density;
  if (const std::vector<std::string> errors = validate(*scene); !errors.empty()) throw SceneError(errors);
  return scene;
}

/// What a sample records: all rows of `quantities`, row after row.
using Rows = std::vector<double>;

void append(const World& world, Rows& rows) {
  for (const Quantity quantity : quantities) {
    const std::size_t before = rows.size();
    rows.resize(before + shape_of(world, quantity, "hose").size());
    copy_quantity(world, quantity, "hose", rows.data() + before);
  }
}

/// All records of a world of a batch.
void append(const Records& records, std::size_t world, Rows& rows) {
  for (std::size_t record = 0; record < records.count(); ++record)
    for (const Record& one : records.all()) {
      const double* from = one.numbers.get() + (world * records.count() + record) * one.shape.size();
      rows.insert(rows.end(), from, from + one.shape.size());
    }
}

/// World after world, as cable_sim has it.
void run_one_by_one(const SceneDesc& base, const std::vector<Values>& values, std::size_t first, std::size_t last,
                    std::vector<Rows>& rows) {
  for (std::size_t i = first; i < last; ++i) {
    const auto scene = scene_of(base, values[i]);
    DrivenWorld world(scene, Motion{});
    world.world().step_one_by_one(true);
    append(world.world(), rows[i]);
    for (int step = 1; step <= steps; ++step) {
      world.step();
      if (step % record_every == 0) append(world.world(), rows[i]);
    }
  }
}

/// As many worlds at once as a chunk of the sweep has.
void run_together(const SceneDesc& base, const std::vector<Values>& values, std::size_t first, std::size_t last,
                  std::vector<Rows>& rows) {
  for (std::size_t start = first; start < last; start += chunk) {
    const std::size_t end = std::min(last, start + chunk);
    std::vector<std::shared_ptr<const SceneDesc>> scenes;
    for (std::size_t i = start; i < end; ++i) scenes.push_back(scene_of(base, values[i]));
    Batch batch(scenes, {}, {}, 1);
    for (std::size_t i = start; i < end; ++i) append(batch[i - start].world(), rows[i]);
    batch.begin_steps(steps, record_every, {std::begin(quantities), std::end(quantities)});
    batch.advance(steps);
    for (std::size_t i = start; i < end; ++i) append(*batch.records(), i - start, rows[i]);
  }
}

/// Seconds of `run` on so many threads, each with its part of the samples.
template <class Run>
double seconds(const Run& run, const SceneDesc& base, const std::vector<Values>& values, std::size_t threads,
               std::vector<Rows>& rows) {
  rows.assign(values.size(), {});
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::thread> all;
  for (std::size_t k = 0; k < threads; ++k)
    all.emplace_back([&, k] { run(base, values, values.size() * k / threads, values.size() * (k + 1) / threads, rows); });
  for (std::thread& thread : all) thread.join();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void write(const std::vector<Rows>& rows, const char* file) {
  std::ofstream out(file, std::ios::binary);
  for (const Rows& sample : rows)
    out.write(reinterpret_cast<const char*>(sample.data()), static_cast<std::streamsize>(sample.size() * sizeof(double)));
}

}  // namespace
}  // namespace verlet_cable::bench

int main(int argc, char** argv) {
  using namespace verlet_cable;
  if (argc != 5) {
    std::cerr << "usage: verlet_cable_sweep_runs SCENE.yaml VALUES THREADS OUTPUT\n";
    return 2;
  }
  const SceneDesc base = read_scene_file(argv[1]);
  const auto values = bench::read_values(argv[2]);
  const auto threads = static_cast<std::size_t>(std::atoi(argv[3]));
  std::vector<bench::Rows> rows;
  const double together = bench::seconds(bench::run_together, base, values, threads, rows);
  const std::vector<bench::Rows> rows_together = std::move(rows);
  const double one_by_one = bench::seconds(bench::run_one_by_one, base, values, threads, rows);
  if (rows != rows_together) {
    std::cerr << "verlet_cable_sweep_runs: worlds that are stepped together are not what they are alone\n";
    return 1;
  }
  bench::write(rows, argv[4]);
  std::printf("%.6f %.6f\n", one_by_one, together);
}
