#include "world_file.h"

#include <cstdint>
#include <string_view>
#include <utility>

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

template <class Items>
std::string names_of(const std::string& kind, const Items& items) {
  NameList names;
  for (const auto& item : items) names.add(item.name);
  return kind + " " + names.text("none");
}

/// What may not differ.
std::string outline_of(const SceneDesc& scene) {
  return names_of("cables", scene.cables) + ", " + names_of("nets", scene.nets) + ", " + names_of("bodies", scene.bodies) + ", " +
         names_of("junctions", scene.junctions) + ", " + names_of("guides", scene.guides);
}

[[noreturn]] void refuse(const std::string& reason) {
  throw std::invalid_argument("data: " + reason + "; allowed: what a world with such a scene has saved");
}

WorldFile read_parts(const SceneDesc& scene, ByteReader& bytes) {
  const std::string version = bytes.read_text();
  if (version != VERLET_CABLE_VERSION)
    refuse("version " + quoted(version) + " of the package has saved it, and this is " + VERLET_CABLE_VERSION);
  const std::string outline = bytes.read_text(), here = outline_of(scene);
  if (outline != here) refuse("it is of a scene with " + outline + ", and this one has " + here);
  SceneDesc at_first = scene;
  set_numbers(bytes.read_text(), at_first);
  WorldFile file{std::make_shared<const SceneDesc>(std::move(at_first)), World(scene), {}};
  file.world.restore(bytes.read_text());
  file.frames = bytes.read_text();
  return file;
}

}  // namespace

std::string write_world(const SceneDesc& scene_at_first, const World& world, const std::string& frames) {
  ByteWriter bytes;
  bytes.write_text(VERLET_CABLE_VERSION);
  bytes.write_text(outline_of(scene_at_first));
  bytes.write_text(numbers_of(scene_at_first));
  bytes.write_text(world.save());
  bytes.write_text(frames);
  std::string parts = bytes.take();
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
