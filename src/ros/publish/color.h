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

/// With the alpha of what nothing is seen through.
inline std::array<double, 4> opaque(const std::array<double, 3>& rgb) {
  return {rgb[0], rgb[1], rgb[2], 1};
}

/// From blue (0) over pale yellow to red (1), told apart by color-blind eyes, too; values outside are clamped. Opaque.
std_msgs::ColorRGBA color_of_load(double load);

/// Red, green and blue in the bytes of one float, as PointCloud2 consumers expect in a field `rgb`.
float packed_rgb(const std_msgs::ColorRGBA& color);

/// Gives every node of a cable its color, one scale for all cables: blue is slack, red the largest tension that there was of
/// late, and no less than that under which the scene's heaviest cable would hang from one end with all its payloads. By strain,
/// the largest strain, and no less than that weight would give one of the cables (without an elastic cable: 0.1 %). By contact,
/// the cube root of a segment's contact force, so that what lies on a floor shows beside what is pulled around a pole.
class ColorScale {
 public:
  explicit ColorScale(const SceneDesc& scene);

  /// Widens the range to what is largest now, at once and to a round number; narrows it to what has been the largest of late,
  /// which fades by a third in 4 s. `elapsed`: [s] since the last call. Whether the legend is another one now.
  bool follow(const World& world, double elapsed);

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
  double largest(const World& world) const;

  ColorBy color_by_;
  bool has_cables_;
  double full_tension_;
  double full_strain_;
  double least_;       ///< that is red
  double recent_ = 0;  ///< the largest of late
};

}  // namespace verlet_cable
