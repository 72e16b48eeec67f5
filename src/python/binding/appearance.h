#pragma once

#include <map>
#include <optional>
#include <string>

#include "binding/arguments.h"
#include "verlet_cable/view/drawing.h"

namespace verlet_cable {

/// What camera.Camera.render says of how things look, beside what a world does.
class Appearance {
 public:
  /// The keys light, background, looks (by name), stripes, distinct_colors, least_radius; each may be left out. Throws ValueError
  /// with what is wrong.
  explicit Appearance(const py::dict& given);

  /// Throws ValueError where a look is of something that is not there.
  view::Drawing drawing_of(const World& world) const;

 private:
  view::DrawingOptions options_;
  std::optional<view::Light> light_;
  std::optional<view::Color> background_;
  std::map<std::string, py::dict> looks_;
};

}  // namespace verlet_cable
