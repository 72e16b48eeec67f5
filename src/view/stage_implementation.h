#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "closed_forms.h"
#include "packets/passes.h"
#include "verlet_cable/view/stage.h"

namespace verlet_cable::view {

/// A look, with its colors in proportion to light.
struct Paint {
  explicit Paint(const Look& of);

  Look look;
  PaintNumbers numbers;
};

/// A segment of a tube.
struct TubeSegment {
  int thing = 0;
  const Paint* paint = nullptr;
  // Where the stripes are. None where there are none.
  bool is_striped = false;
  Vector3 second = Vector3::Zero(), third = Vector3::Zero();  ///< axes of the material across the segment
  double roll_at_start = 0, roll_at_end = 0;  ///< [rad] by which stripes are turned there, so that they meet the neighbours'
};

/// A part of a thing in the fixed frame.
struct PlacedPart {
  PlacedPart(int of_thing, const Pose& place, const Shape& form, const Paint& painted)
      : thing(of_thing), pose(place), shape(form), paint(&painted), axes(place.orientation.normalized().toRotationMatrix()) {}

  int thing;
  Pose pose;
  Shape shape;
  const Paint* paint;
  Eigen::Matrix3d axes;  ///< of its frame

  Vector3 inside(const Vector3& point) const { return axes.transpose() * (point - pose.position); }
  Ray inside(const Ray& ray) const { return {inside(ray.origin), axes.transpose() * ray.direction}; }
};

/// A surface that a ray meets, as it is seen from the eye.
struct Surface {
  enum class Form { flat, round, cylinder };

  int thing = -1;  ///< index into Drawing::things
  const Paint* paint = nullptr;
  const PlacedPart* part = nullptr;      ///< null for tubes
  const TubeSegment* segment = nullptr;  ///< of tubes
  Form form = Form::flat;
  PlaneNumbers numbers{};           ///< of flat ones, which face the eye
  const RoundLine* line = nullptr;  ///< of round ones
};

/// What a ray meets.
struct Sighting {
  int thing = -1;  ///< index into Drawing::things; -1: nothing
  double t = 0;    ///< of the ray
};

/// Of a color as in an image (IEC 61966-2-1), in proportion to light.
Vector3 in_proportion_to_light(const Color& color);

/// A tree of a mesh's triangles, in the mesh's own frame.
class MeshTree {
 public:
  MeshTree(RTCDevice device, std::shared_ptr<const TriangleMesh> mesh);
  ~MeshTree();
  MeshTree(const MeshTree&) = delete;
  MeshTree& operator=(const MeshTree&) = delete;

  RTCScene scene() const { return scene_; }

 private:
  std::shared_ptr<const TriangleMesh> mesh_;  ///< lives as long as the tree of it that others find by its address
  RTCScene scene_;
};

struct Stage::Implementation {
  Implementation(Drawing shown, const Implementation* before);
  ~Implementation();
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  Drawing drawing;
  /// [m] Of what Embree sees, which has single precision, in the fixed frame: amid what there is.
  Vector3 origin = Vector3::Zero();
  Vector3 to_sun = Vector3::UnitZ();       ///< unit
  std::array<std::uint8_t, 3> background;  ///< as images have it
  std::deque<Paint> paints;                ///< where others point to
  /// What is round: first the tubes' segments, then spheres and capsules. Each as rays meet it, in the fixed frame.
  std::vector<RoundLine> lines;
  std::vector<TubeSegment> segments;
  std::vector<PlacedPart> rounds;
  std::vector<PlacedPart> planes;  ///< which have no bounds
  std::vector<PlacedPart> boxes;
  std::vector<PlacedPart> cylinders;
  std::vector<PlacedPart> meshes;
  std::map<const TriangleMesh*, std::shared_ptr<const MeshTree>> trees;
  RTCScene scene = nullptr;

  /// By which Embree names what it has hit: the geometry's id.
  static constexpr unsigned lines_id = 0, boxes_id = 1, cylinders_id = 2, first_mesh_id = 3;

  /// The plane, above the eye along its normal.
  PlaneNumbers numbers_of(const PlacedPart& plane, const Vector3& eye) const;
  Surface surface_of_plane(int index, const Vector3& eye) const;
  /// Of what Embree has hit. Not with housings.
  Surface surface_of(const RTCHit& hit, const Vector3& eye) const;

  /// Parts, but for planes, that rays pass through.
  using Housing = std::vector<const PlacedPart*>;
  /// Those that a point is in, or on.
  Housing around(const Vector3& point) const;
  /// Whether it is one of them that Embree has hit.
  bool is_of(const Housing& housing, const RTCHit& hit) const {
    return !housing.empty() && std::find(housing.begin(), housing.end(), part_hit(hit)) != housing.end();
  }
  /// Where a ray meets anything but planes, before t = `highest`; geomID: RTC_INVALID_GEOMETRY_ID where it does not.
  RTCRayHit cast(const Ray& ray, double highest, const Housing& housing) const;
  /// What one ray meets first, before t = `highest`, in single precision.
  Sighting look(const Ray& ray, double highest, const Housing& housing) const;

 private:
  /// Null for tubes.
  const PlacedPart* part_hit(const RTCHit& hit) const;
  std::vector<PlacedPart>& group_of(const Shape& shape);
  void place(const Thing& thing, int index);
  void place(const Tube& tube, const Paint& paint, int index);
  void collect_rounds();
  void find_origin();
  void build(const Implementation* before);
  void add_lines();
  void add_boxes();
  void add_cylinders();
  void add_meshes(const Implementation* before);
};

}  // namespace verlet_cable::view
