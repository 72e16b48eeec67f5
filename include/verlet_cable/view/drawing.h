#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "verlet_cable/core/shape.h"
#include "verlet_cable/core/types.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::view {

using Color = std::array<double, 3>;  ///< red, green, blue; 0 to 1, as in an image (sRGB)

/// How a surface is painted.
struct Look {
  enum class Pattern {
    plain,
    stripes,  ///< tubes: `stripes` lines of `second_color` along the material, by whose way around the tube its roll and twist
              ///< are seen
    checks,   ///< squares with edges of `check_size` in both colors, by the coordinates x and y of the shape
  };
  Color color{0.8, 0.8, 0.8};
  Color second_color{0.9, 0.9, 0.9};
  Pattern pattern = Pattern::plain;
  int stripes = 1;            ///< evenly around the tube
  double stripe_width = 0.7;  ///< [rad] of each, seen from the tube's axis
  double check_size = 0.1;    ///< [m]
  double shininess = 0.15;    ///< 0 (dull) to 1: how bright the reflection of the light is
};

/// A round tube along a line of straight segments, with half spheres at both ends and balls where segments meet: what contact has
/// of a cable.
struct Tube {
  std::vector<Vector3> centers;            ///< [m] n + 1, fixed frame; at least two
  std::vector<double> radii;               ///< [m] n: one a segment; or one for all of them
  std::vector<Quaternion> orientations{};  ///< n: x along the segment, roll of the material; none: without stripes
};

/// A solid or a mesh in the frame of the thing that it is part of. Meshes are seen from both sides, planes from outside only.
/// What the lens is in, such as the camera's housing, is not seen by it.
struct Part {
  Pose pose;
  Shape shape;
  std::optional<Look> look{};  ///< none: that of the thing
};

/// What has a number of its own in masks.
struct Thing {
  enum class Kind { cable, net, particle, body, other };
  std::string name;
  Kind kind = Kind::other;
  Look look;
  std::vector<Tube> tubes{};  ///< fixed frame; a cable has one
  Pose pose{};                ///< of its frame in the fixed frame
  std::vector<Part> parts{};
};

/// Light from far away, as of the sun, and from the sky.
struct Light {
  Vector3 direction{-0.4, -0.6, 0.9};  ///< towards the sun, in the fixed frame; of any length above 0
  double ambient = 0.45;               ///< 0 to 1: brightness of what the sun does not reach; the rest is the sun's
  bool shadows = true;
};

/// All that is seen at one moment. A plain value: whoever has nodes, poses and shapes can make one; `drawing_of` makes that of a
/// world.
struct Drawing {
  /// In the order of their kinds, and those of a kind in the order of their ids: `things[i]` has the number i + 1 in masks, which
  /// is 1 + `cable_id` of the node's topic `points` for cables, nets and particles; 0 is the background.
  std::vector<Thing> things;
  Light light{};
  Color background{0.86, 0.89, 0.93};
};

/// The names of all things, in the order of their numbers in masks from 1 on.
std::vector<std::string> labels(const Drawing& drawing);

/// All errors, one line each with its full name, value and what is allowed: numbers that are not finite, tubes with fewer than
/// two centers, things out of order, more than 65534 of them. Empty: `Stage` takes it.
std::vector<std::string> validate(const Drawing& drawing);

/// What is not in a world.
struct DrawingOptions {
  bool stripes = true;             ///< on cables, in a lighter or darker tone of their color
  bool distinct_colors = false;    ///< where cables or nets have the same color, all of them get colors that tell them apart
  bool checks = true;              ///< on planes
  double net_link_radius = 0.001;  ///< [m] of the cords that a net's links are drawn as
  double least_radius = 0;         ///< [m] thinner cables and cords are drawn so thick
};

/// What is seen of a world: its cables; its bodies, if they have shapes; nets, as cords along their links; particles; and
/// obstacles that are present, with the links of robots. What is no longer finite is left out, and keeps its number.
Drawing drawing_of(const World& world, const DrawingOptions& options = {});

/// A cable from what is known of it.
Thing cable(const std::string& name, Tube tube, const Color& color, bool stripes = true);

/// How bodies and obstacles look of which nobody has said it.
Look body_look();
Look obstacle_look();
/// Planes have checks, by which their perspective is seen.
Look plane_look(bool checks = true);

}  // namespace verlet_cable::view
