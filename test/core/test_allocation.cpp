#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "../support/scenes.h"

namespace {
long allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
// Not inlined: a compiler that sees only these two from within warns of memory that comes from `new` and goes to `free`.
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace verlet_cable {
namespace {

TEST(Allocation, StepAllocatesNothing) {
  SceneDesc scene = scenes::held_by_a_hand(50, AttachmentType::clamp);
  const SceneDesc whip = scenes::released(50, 1.5);
  scene.cables.push_back(whip.cables[0]);
  scene.cables.back().name = "whip";
  scene.cables.back().attachments[0].name = "top";
  BoundaryInputs inputs = scenes::hand_at({0.6, 0, 0});
  World world(scene, inputs);
  world.step(inputs);
  const long before = allocations;
  for (int i = 0; i < 1000; ++i) {
    inputs[1].pose.position.z() = 1e-4 * i;
    world.step(inputs);
  }
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace verlet_cable
