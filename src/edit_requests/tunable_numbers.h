#pragma once

#include <functional>
#include <string>
#include <vector>

#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {

/// A number of a scene that can be changed while it runs.
struct TunableNumber {
  std::string name;  ///< `gravity_z`, `wind_x`, `<material>_bending_stiffness`; of one that bends unequally `..._y` and `..._z`
  std::string description;
  Range range;
  std::function<double(const SceneDesc&)> value;
  std::function<void(SceneDesc&, double)> set;
};

/// A number that is to be another, by its name.
struct NumberChange {
  std::string name;
  double value = 0;
};

/// What can be tuned of a scene: uniform gravity, wind (the fluid's velocity), and of each material the dampings, finite
/// stiffnesses and friction.
std::vector<TunableNumber> tunable_numbers(const SceneDesc& scene);

/// The scene with the changes, `numbers` being its tunable ones. Throws SceneError with everything that is wrong, after `errors`,
/// which were found already.
SceneDesc tuned_scene(SceneDesc scene, const std::vector<TunableNumber>& numbers, const std::vector<NumberChange>& changes,
                      std::vector<std::string> errors = {});

}  // namespace verlet_cable
