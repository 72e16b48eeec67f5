// Saved worlds: bytes that are cut off, mixed up and overwritten behind a checksum that is right.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "arbitrary.h"
#include "check_world.h"
#include "require.h"
#include "scene/world_file.h"
#include "simulation/driven_world.h"
#include "small_worlds.h"

namespace {

using namespace verlet_cable;

constexpr int steps_before = 3, steps_after = 5;
constexpr int most_changes = 6;

struct Saved {
  std::shared_ptr<const SceneDesc> scene;
  std::string bytes;
  /// Without the mark before them, and the checksum after them.
  std::string parts;
};

/// A world of each scene, after some steps.
const std::vector<Saved>& saved_worlds() {
  static const std::vector<Saved> worlds = [] {
    std::vector<Saved> made;
    const std::string nothing = sealed("");
    const std::size_t checksum = sizeof(std::uint64_t), mark = nothing.size() - checksum;
    for (const SceneDesc& scene : fuzz::small_worlds()) {
      auto shared = std::make_shared<const SceneDesc>(scene);
      DrivenWorld world(shared, Motion{});
      for (int k = 0; k < steps_before; ++k) world.step();
      std::string bytes = world.save();
      std::string parts = bytes.substr(mark, bytes.size() - mark - checksum);
      made.push_back({std::move(shared), std::move(bytes), std::move(parts)});
    }
    return made;
  }();
  return worlds;
}

std::size_t place(fuzz::Arbitrary& input, const std::string& bytes) {
  constexpr int fine = 1 << 20;
  return static_cast<std::size_t>(input.below(fine)) * bytes.size() / fine;
}

/// A number that a length, an index or a size may be taken for, or a byte.
std::string arbitrary_bytes(fuzz::Arbitrary& input) {
  if (input.flip()) return std::string(1, static_cast<char>(input.below(256)));
  const std::uint64_t numbers[] = {
      0, 1, 2, 7, 0xffffffff, 0x7fffffff, ~std::uint64_t{0}, std::uint64_t{1} << 40, 0x7ff8000000000000, 0x7ff0000000000000};
  const std::uint64_t number = input.one_of(numbers);
  const int size = input.flip() ? 8 : 4;
  return std::string(reinterpret_cast<const char*>(&number), size);
}

void change(fuzz::Arbitrary& input, std::string& bytes) {
  if (bytes.empty()) return;
  const std::size_t at = place(input, bytes);
  switch (input.below(5)) {
    case 0: {
      const std::string given = arbitrary_bytes(input);
      bytes.replace(at, std::min(given.size(), bytes.size() - at), given);
      break;
    }
    case 1:
      bytes.insert(at, arbitrary_bytes(input));
      break;
    case 2:
      bytes.erase(at, 1 + place(input, bytes) / 16);
      break;
    case 3:
      bytes.resize(at);
      break;
    default: {
      const std::vector<Saved>& worlds = saved_worlds();
      const std::string& other = worlds[input.below(static_cast<int>(worlds.size()))].parts;
      bytes.replace(at, 64, other, place(input, other), 64);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Arbitrary input(data, size);
  const std::vector<Saved>& worlds = saved_worlds();
  const Saved& saved = worlds[input.below(static_cast<int>(worlds.size()))];
  const bool is_sealed = input.below(8) != 0;
  std::string bytes = is_sealed ? saved.parts : saved.bytes;
  for (int k = 0; k < most_changes && !input.is_used_up(); ++k) change(input, bytes);
  if (is_sealed) bytes = sealed(bytes);
  try {
    DrivenWorld world = DrivenWorld::load(*saved.scene, bytes);
    fuzz::require(is_sealed || bytes == saved.bytes, "changed bytes are refused");
    fuzz::check_world(world.world());
    const std::string again = world.save();
    fuzz::require(DrivenWorld::load(*saved.scene, again).save() == again, "what was loaded is saved and loaded as it is");
    for (int k = 0; k < steps_after; ++k) world.step();
    fuzz::check_world(world.world());
  } catch (const std::invalid_argument& error) {
    fuzz::require(std::string(error.what()).rfind("data: ", 0) == 0, std::string("a message names the data: ") + error.what());
  }
  return 0;
}
