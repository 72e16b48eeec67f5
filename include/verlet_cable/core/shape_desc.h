#pragma once

#include <array>
#include <memory>
#include <string>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

class TriangleMesh;

/// Position and orientation of a frame, as written in a scene.
using InitialPose = std::array<double, 6>;  // x, y, z [m], roll, pitch, yaw [rad]

enum class ShapeType { plane, sphere, capsule, cylinder, box, mesh };

/// Whether a mesh is a sheet, which has no inside and is touched from both sides. `automatic`: see TriangleMesh::is_sheet.
enum class Sheet { automatic, no, yes };

/// A solid. Only the dimensions of its type are used; the others are ignored.
struct ShapeDesc {
  ShapeType type = ShapeType::plane;
  InitialPose pose{};               ///< in the frame or body that it belongs to
  double radius = 0;                ///< [m] sphere, capsule, cylinder: > 0
  double length = 0;                ///< [m] capsule: of the cylindrical part, cylinder: > 0
  Vector3 size = Vector3::Zero();   ///< [m] box: > 0
  std::string uri;                  ///< mesh: package:// or file://
  Vector3 scale = Vector3::Ones();  ///< mesh: not 0; mirrored along axes where it is below 0
  Sheet sheet = Sheet::automatic;   ///< mesh
  double thickness = 0;             ///< [m] mesh that is a sheet: >= 0
  /// mesh: the scaled mesh of `uri`; filled in when the file is read
  std::shared_ptr<const TriangleMesh> mesh;
};

}  // namespace verlet_cable
