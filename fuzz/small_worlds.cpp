#include "small_worlds.h"

#include <algorithm>
#include <filesystem>
#include <string>

#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable::fuzz {

std::vector<SceneDesc> small_worlds() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(WORLDS_DIRECTORY)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<SceneDesc> scenes;
  for (const std::string& path : paths) scenes.push_back(read_scene_file(path));
  return scenes;
}

}  // namespace verlet_cable::fuzz
