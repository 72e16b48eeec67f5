#include "world_file.h"

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "scene_structure.h"
#include "verlet_cable/core/bytes.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_numbers.h"

namespace verlet_cable {
namespace {

constexpr std::string_view mark = "verlet_cable world\n";

/// FNV-1a.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t value = 14695981039346656037ull;
  for (const char byte : bytes) value = (value ^ static_cast<unsigned char>(byte)) * 1099511628211ull;
  return value;
}

void write_structure(const SceneDesc& scene, ByteWriter& bytes) {
  for (const auto& [kind, texts] : structure_of(scene)) {
    bytes(texts.size());
    for (const std::string& text : texts) bytes.write_text(text);
  }
}

[[noreturn]] void refuse(const std::string& reason) {
  throw std::invalid_argument("data: " + reason + "; allowed: what a world with such a scene has saved");
}

/// That scenes differ in numbers only, of which the world has its own.
void require_structure(const SceneDesc& scene, ByteReader& bytes) {
  std::string of_bytes, here;
  for (const auto& [kind, texts] : structure_of(scene)) {
    std::vector<std::string> given(bytes.read_length());
    for (std::string& text : given) text = bytes.read_text();
    if (given == texts) continue;
    const auto add = [name = kind](const std::vector<std::string>& names, std::string& list) {
      list += (list.empty() ? "" : "; ") + name + " " + NameList(names).text();
    };
    add(given, of_bytes);
    add(texts, here);
  }
  if (!here.empty()) refuse("it is of a scene with " + of_bytes + ", and this one has " + here);
}

WorldFile read_parts(const SceneDesc& scene, ByteReader& bytes) {
  const std::string version = bytes.read_text();
  if (version != VERLET_CABLE_VERSION)
    refuse("version " + in_quotes(version) + " of the package has saved it, and this is " + VERLET_CABLE_VERSION);
  require_structure(scene, bytes);
  SceneDesc at_first = scene;
  set_numbers(bytes.read_text(), at_first);
  if (const std::vector<std::string> errors = validate(at_first); !errors.empty()) refuse("of its scene, " + errors.front());
  WorldFile file{std::make_shared<const SceneDesc>(std::move(at_first)), World(scene), {}};
  file.world.restore(bytes.read_text());
  // Names and counts are in the numbers of cables and nets, too.
  const SceneStructure wanted = structure_of(scene);
  if (structure_of(*file.scene_at_first) != wanted || structure_of(file.world.scene()) != wanted)
    refuse("it is not of one scene");
  file.frames = bytes.read_text();
  return file;
}

}  // namespace

std::string write_world(const SceneDesc& scene_at_first, const World& world, const std::string& frames) {
  ByteWriter bytes;
  bytes.write_text(VERLET_CABLE_VERSION);
  write_structure(scene_at_first, bytes);
  bytes.write_text(numbers_of(scene_at_first));
  bytes.write_text(world.save());
  bytes.write_text(frames);
  return sealed(bytes.take());
}

std::string sealed(const std::string& parts) {
  ByteWriter end;
  end(checksum(parts));
  return std::string(mark) + parts + end.take();
}

WorldFile read_world(const SceneDesc& scene, const std::string& data) {
  std::string_view rest(data);
  if (rest.substr(0, mark.size()) != mark) refuse("it is not a saved world");
  rest.remove_prefix(mark.size());
  std::uint64_t sum = 0;
  if (rest.size() < sizeof sum) refuse("it ends too early");
  const std::string_view parts = rest.substr(0, rest.size() - sizeof sum);
  ByteReader end(rest.substr(parts.size()));
  end(sum);
  if (sum != checksum(parts)) refuse("it is cut off or damaged");
  try {
    ByteReader bytes(parts);
    return read_parts(scene, bytes);
  } catch (const std::invalid_argument& error) {
    const std::string reason = error.what();
    if (reason.rfind("data: ", 0) == 0) throw;
    refuse(reason);
  }
}

}  // namespace verlet_cable
