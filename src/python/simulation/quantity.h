#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// A name that a world does not have: what it should name, the name, and those that are allowed.
class UnknownName : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What can be read of a world, by the name of a cable, net, particle, body or attachment.
enum class Quantity {
  positions,          ///< [m] a node: of cables n + 1, of nets all, of particles 1; 3 columns
  velocities,         ///< [m/s] likewise
  tension,            ///< [N] a segment n, or a link of a net
  curvature,          ///< [1/m] an inner node of a cable, n - 1
  twist,              ///< [rad/m] an inner node of a cable, n - 1
  plastic_curvature,  ///< [1/m] likewise; 0 where nothing can yield
  orientations,       ///< a segment of a cable, n: x along it, roll of the material; 4 columns: x, y, z, w
  wrench,             ///< 6 numbers: force [N] and torque [N m] of an attachment on its holder, fixed frame's axes
  contact_force,      ///< 6 numbers: likewise of what touches an obstacle, link or body, torque about the origin of its frame
  body_pose,          ///< 7 numbers: place [m] and orientation x, y, z, w of a body's frame
  body_twist          ///< 6 numbers: velocity [m/s] of a body's center of mass, and angular velocity [rad/s], fixed frame's axes
};
constexpr std::array<const char*, 11> quantity_names{"positions",     "velocities",        "tension",      "curvature",
                                                     "twist",         "plastic_curvature", "orientations", "wrench",
                                                     "contact_force", "body_pose",         "body_twist"};

inline const char* name_of(Quantity quantity) {
  return quantity_names[static_cast<std::size_t>(quantity)];
}

/// Of an array: `columns` is 0 where it has one dimension.
struct QuantityShape {
  std::size_t rows = 0, columns = 0;
  std::size_t size() const { return columns == 0 ? rows : rows * columns; }
  bool operator==(const QuantityShape& other) const { return rows == other.rows && columns == other.columns; }
  bool operator!=(const QuantityShape& other) const { return !(*this == other); }
};

/// Throws UnknownName.
QuantityShape shape_of(const World& world, Quantity quantity, const std::string& name);

/// Writes as many numbers as `shape_of` says, row by row.
void copy_quantity(const World& world, Quantity quantity, const std::string& name, double* to);

/// Likewise where it has this shape; false, and nothing is written, where it has another one, or the world no such name.
bool try_copy_quantity(const World& world, Quantity quantity, const std::string& name, const QuantityShape& shape, double* to);

/// Of a cable, whose nodes may be any number: positions or velocities of so many points, at least 2, at even distances along it
/// at rest, from end to end; linear between nodes. Throws UnknownName.
void copy_points(const World& world, Quantity quantity, const std::string& name, std::size_t points, double* to);

}  // namespace verlet_cable
