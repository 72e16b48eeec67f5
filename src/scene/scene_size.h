#pragma once

#include <cstddef>
#include <string>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

// How large a scene may be, whatever it is read from.
constexpr std::size_t largest_scene_text = std::size_t{16} << 20;  ///< [byte] 10,000 cables are 3 MB
constexpr std::size_t most_scene_values = 1'000'000;
constexpr std::size_t deepest_scene_level = 32;

/// Counts what a scene that is no text consists of, before anything is built of it.
class SceneSize {
 public:
  /// A list, map or scalar so many levels down, with so many bytes of text. Throws SceneError where the scene becomes too large.
  void add(const std::string& key, std::size_t level, std::size_t bytes = 0) {
    check(key, level, deepest_scene_level, "nested deeper than ", " levels");
    check(key, ++values_, most_scene_values, "with it the scene has more than ", " values");
    check(key, bytes_ += bytes, largest_scene_text, "with it the scene has more than ", " bytes of text");
  }
  /// That so many values follow: the same, before they are there.
  void expect(const std::string& key, std::size_t values) const {
    check(key, values_ + values, most_scene_values, "with it the scene has more than ", " values");
  }

 private:
  static void check(const std::string& key, std::size_t number, std::size_t most, const char* before, const char* after) {
    if (number > most)
      throw SceneError({(key.empty() ? "scene" : key) + ": " + before + std::to_string(most) + after + "; allowed: less"});
  }

  std::size_t values_ = 0;
  std::size_t bytes_ = 0;
};

}  // namespace verlet_cable
