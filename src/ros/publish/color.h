#pragma once

#include <std_msgs/ColorRGBA.h>
#include <verlet_cable/Legend.h>

#include <array>
#include <vector>

#include "verlet_cable/core/cable.h"
#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

std_msgs::ColorRGBA to_color(const std::array<double, 4>& rgba);

/// From blue (0) over pale yellow to red (1), told apart by color-blind eyes, too; values outside are clamped. Opaque.
std_msgs::ColorRGBA color_of_load(double load);

/// Red, green and blue in the bytes of one float, as PointCloud2 consumers expect in a field `rgb`.
float packed_rgb(const std_msgs::ColorRGBA& color);

/// Gives every node of a cable its color. The scale is fixed by the scene, one for all its cables, so that a color means the same
/// load everywhere and at any time: blue is slack, red is the tension under which the scene's heaviest cable would hang from one
/// end with all its payloads, or more; by strain, the largest strain that this weight would give one of the cables (without an
/// elastic cable: 0.1 %). By contact, the cube root of a segment's contact force over that tension: what lies on a floor shows
/// beside what is pulled around a pole.
class ColorScale {
 public:
  explicit ColorScale(const SceneDesc& scene);

  /// One color a node: the mean over the segments that meet there. `contact_forces` [N]: one a segment, or none where nothing
  /// touches.
  std::vector<std_msgs::ColorRGBA> node_colors(const SimulatedCable& cable, const std::vector<double>& contact_forces) const;
  /// The contact forces on the segments of each cable [N], for `node_colors`; none where they are not shown.
  std::vector<std::vector<double>> contact_forces(const World& world) const;

  /// What the colors mean, in numbers.
  Legend legend() const;

  double full_tension() const { return full_tension_; }  ///< [N] what is red
  double full_strain() const { return full_strain_; }    ///< what is red

 private:
  double load(const SimulatedCable& cable, int segment, const std::vector<double>& contact_forces) const;

  ColorBy color_by_;
  bool has_cables_;
  double full_tension_;
  double full_strain_;
};

}  // namespace verlet_cable
