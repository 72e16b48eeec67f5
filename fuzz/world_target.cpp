// Worlds, in any order of calls.

#include <cstddef>
#include <cstdint>

#include "arbitrary.h"
#include "small_worlds.h"
#include "world_machine.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace verlet_cable;
  constexpr int most_calls = 60;
  fuzz::Arbitrary input(data, size);
  static const std::vector<SceneDesc> scenes = fuzz::small_worlds();
  SceneDesc scene = scenes[input.below(static_cast<int>(scenes.size()))];
  scene.time_step = input.one_of({0.001, 0.005, 0.02});
  fuzz::WorldMachine machine(scene, input);
  for (int i = 0; i < most_calls && !input.is_used_up() && !machine.is_tired(); ++i) machine.act();
  return 0;
}
