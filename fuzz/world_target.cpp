// Worlds, in any order of calls.

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "arbitrary.h"
#include "small_worlds.h"
#include "world_machine.h"

namespace {

using namespace verlet_cable;

struct Start {
  SceneDesc scene;
  World world;
};

/// Each scene is started once with each time step, and copied for each input: settling takes longer than most of what inputs do.
const Start& any_start(fuzz::Arbitrary& input) {
  static const std::vector<SceneDesc> scenes = fuzz::small_worlds();
  static std::map<std::pair<int, double>, Start> starts;
  const int index = input.below(static_cast<int>(scenes.size()));
  const double time_step = input.one_of({0.001, 0.005, 0.02});
  const auto found = starts.find({index, time_step});
  if (found != starts.end()) return found->second;
  SceneDesc scene = scenes[index];
  scene.time_step = time_step;
  const World world(scene, initial_frames(scene));
  return starts.emplace(std::make_pair(index, time_step), Start{scene, world}).first->second;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr int most_calls = 60;
  fuzz::Arbitrary input(data, size);
  const Start& start = any_start(input);
  fuzz::WorldMachine machine(start.scene, start.world, input);
  for (int i = 0; i < most_calls && !input.is_used_up() && !machine.is_tired(); ++i) machine.act();
  return 0;
}
