#pragma once

#include <memory>
#include <string>
#include <variant>

#include "verlet_cable/core/shape_desc.h"
#include "verlet_cable/core/surface_point.h"
#include "verlet_cable/core/triangle_mesh.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// The half space z < 0; its normal is +z.
struct PlaneShape {};

/// Around the origin.
struct SphereShape {
  double radius;  ///< [m]
};

/// Along z, around the origin.
struct CapsuleShape {
  double radius;  ///< [m]
  double length;  ///< [m] of the cylindrical part
};

/// Along z, around the origin.
struct CylinderShape {
  double radius;  ///< [m]
  double length;  ///< [m]
};

/// Around the origin.
struct BoxShape {
  Vector3 size;  ///< [m] along x, y and z
};

/// A mesh, and the file from which it was read, for displays that read the file themselves.
struct MeshShape {
  std::shared_ptr<const TriangleMesh> mesh;  ///< never null; scaled
  std::string uri{};
  Vector3 scale = Vector3::Ones();
  Sheet sheet = Sheet::automatic;
  double thickness = 0;  ///< [m] of a sheet

  /// Without where a display finds it, which takes memory.
  MeshShape solid() const { return {mesh, {}, Vector3::Ones(), sheet, thickness}; }
  bool is_sheet() const { return sheet == Sheet::automatic ? mesh->is_sheet() : sheet == Sheet::yes; }
};

using Shape = std::variant<PlaneShape, SphereShape, CapsuleShape, CylinderShape, BoxShape, MeshShape>;

/// The solid that a scene describes, in its own frame. The file of a mesh must have been read.
Shape shape_of(const ShapeDesc& desc);

/// The point of the surface that is nearest to `point` [m], both in the shape's frame. Where several are equally near (on an
/// axis, in the middle), one of them; the normal has unit length everywhere. The search ends early for points that are `reach` or
/// further outside: for these, only `distance >= reach` is guaranteed.
SurfacePoint closest_point(const Shape& shape, const Vector3& point, double reach = infinity);

/// The point of the segment from `start` to `end` [m], in the shape's frame, that is deepest in the shape or nearest to it. If it
/// is not unique, one of them. The search ends early for segments that are `reach` or further outside: for these, only
/// `surface.distance >= reach` is guaranteed.
SegmentSurfacePoint deepest_point(const Shape& shape, const Vector3& start, const Vector3& end, double reach = infinity);

/// A box around the shape at `pose`; a plane's is infinite in all directions.
Aabb bounds(const Shape& shape, const Pose& pose);

}  // namespace verlet_cable
