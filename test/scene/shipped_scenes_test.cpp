#include "shipped_scenes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <iomanip>
#include <map>
#include <random>
#include <regex>
#include <thread>

#include "cable_sim_fixture.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/world_stepper.h"
#include "verlet_cable/scene/scene_reader.h"

// The same scene gives the same bytes: on any number of threads, over save and restore, in any process. Every scene that is
// shipped.

namespace verlet_cable {
namespace {

constexpr int steps = 80;

/// Calls `work` where TBB has so many threads, whatever the machine has.
template <class Work>
void on_threads(int count, const Work& work) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, count);
  tbb::task_arena arena(count);
  arena.execute(work);
}

TEST(Threads, AreAsManyAsAskedFor) {
  for (const int threads : {1, 2, 16})
    on_threads(threads, [&] {
      std::atomic<int> arrived{0};
      const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
      const auto meet = [&](int) {
        ++arrived;
        while (arrived < threads && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
        EXPECT_EQ(arrived, threads);
      };
      tbb::parallel_for(0, threads, meet, tbb::simple_partitioner());
    });
}

TEST(ShippedScenes, AreFound) {
  const std::vector<std::string> names = shipped_scene_names();
  for (const char* name :
       {"config_demo", "config_scene_template", "config_scenes_lecture_box", "fuzz_worlds_blocks", "test_soak_scene"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  for (const char* name : {"config_materials", "config_sweep"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 0) << name;
}

class ShippedScene : public CableSim, public testing::WithParamInterface<std::string> {
 protected:
  ShippedScene() {
    const std::string scene_path = shipped_scene_path(GetParam());
    const SceneDesc scene = read_scene_file(scene_path);
    const std::string csv = motion_of_shipped_scene(scene_path, scene, steps * scene.time_step);
    if (!csv.empty()) motion_ = write("motion.csv", csv);
    static std::map<std::string, ShippedRun> runs;
    const auto found = runs.find(GetParam());
    run_ = found != runs.end() ? &found->second
                               : &runs.emplace(GetParam(), run_shipped_scene(scene_path, motion_, steps)).first->second;
  }

  /// What it has done before is in `run()`.
  void step(World& world) const {
    const auto next = static_cast<std::size_t>(world.steps() + 1);
    const StepResult result = world.step(run().frames[next]);
    ASSERT_EQ(bytes_of(world, result), run().bytes[next]) << "step " << next;
  }
  const ShippedRun& run() const { return *run_; }
  const std::string& motion() const { return motion_; }

 private:
  std::string motion_;
  const ShippedRun* run_ = nullptr;
};

TEST_P(ShippedScene, IsTheSameOnAnyNumberOfThreads) {
  for (const int threads : {1, 2, 16})
    on_threads(threads, [&] {
      World world(run().scene, run().frames.front());
      ASSERT_EQ(bytes_of(world), run().bytes.front());
      while (world.steps() < steps && !HasFatalFailure()) step(world);
    });
}

TEST_P(ShippedScene, IsTheSameAmongManyWorlds) {
  constexpr int count = 48, together = 10;
  for (const int threads : {1, 2, 16})
    on_threads(threads, [&] {
      World world = run().start;
      std::vector<World> worlds;
      for (int i = 0; i < count; ++i) {
        worlds.push_back(world);
        step(world);
      }
      WorldStepper stepper;
      std::vector<WorldStep> all(count);
      for (int i = 0; i < together; ++i) {
        for (int k = 0; k < count; ++k) all[k] = {&worlds[k], &run().frames[worlds[k].steps() + 1], {}};
        stepper.step(all, true);
        for (int k = 0; k < count; ++k)
          ASSERT_EQ(bytes_of(worlds[k], all[k].result), run().bytes[worlds[k].steps()]) << "world " << k << ", step " << i;
      }
    });
}

TEST_P(ShippedScene, GoesOnAfterItIsRestored) {
  std::mt19937 random(1);
  const auto below = [&](std::size_t count) { return random() % count; };
  World world = run().start;
  std::vector<World> saved = {world};
  for (int i = 0; i < 2 * steps && !HasFatalFailure(); ++i) {
    switch (below(12)) {
      case 0:
        saved.push_back(world);
        break;
      case 1:
        world = saved[below(saved.size())];  // what it has used is taken over
        break;
      case 2:
        world = World(saved[below(saved.size())]);
        break;
      default:
        break;
    }
    if (world.steps() == steps) world = saved[below(saved.size())];
    step(world);
  }
}

/// Text of a summary without what the clock decides.
std::string without_times(const std::string& json) {
  return std::regex_replace(json, std::regex("\"(wall_time|real_time_factor|ns_per_segment_substep)\": [^,]*,"), "");
}

/// Also where memory is elsewhere and full of something, on one core, in another country.
TEST_P(ShippedScene, IsTheSameInAnyProcess) {
  const std::string arguments = "'" + shipped_scene_path(GetParam()) + "' " + (motion().empty() ? "" : "--motion " + motion()) +
                                " --duration " + number_text(steps * run().scene.time_step);
  const auto outputs = [&](const std::string& name) {
    return " --output " + path(name + ".csv") + " --bodies " + path(name + "_bodies.csv") + " --summary " + path(name + ".json");
  };
  ASSERT_EQ(CableSim::run(arguments + outputs("first")), 0) << err;
  ASSERT_EQ(CableSim::run(arguments + outputs("second"),
                          "cd / && LC_ALL=de_DE.UTF-8 TZ=Asia/Kathmandu MALLOC_PERTURB_=90 taskset -c 0 "),
            0)
      << err;
  EXPECT_EQ(content(path("first.csv")), content(path("second.csv")));
  EXPECT_EQ(content(path("first_bodies.csv")), content(path("second_bodies.csv")));
  EXPECT_EQ(without_times(content(path("first.json"))), without_times(content(path("second.json"))));
  World world = run().start;
  while (world.steps() < steps) world.step(run().frames[world.steps() + 1]);
  std::ostringstream hash;
  hash << std::hex << std::setw(16) << std::setfill('0') << world.hash();
  EXPECT_EQ(summary("first.json")["state_hash"].Scalar(), hash.str());
}

INSTANTIATE_TEST_SUITE_P(Each, ShippedScene, testing::ValuesIn(shipped_scene_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace verlet_cable
