#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "closed_forms.h"
#include "verlet_cable/view/stage.h"

namespace verlet_cable::view {

/// A look, with its colors in proportion to light.
struct Paint {
  explicit Paint(const Look& of);

  Look look;
  Vector3 color, second_color;
};

/// What a ray meets.
struct Sighting {
  int thing = -1;  ///< index into Drawing::things; -1: nothing
  double t = 0;    ///< of the ray
  Vector3 normal = Vector3::UnitZ();
  const Paint* paint = nullptr;
  double second_color = 0;  ///< 0 to 1: how much of the paint's second color there is

  explicit operator bool() const { return thing >= 0; }
};

/// A segment of a tube, as rays meet it.
struct TubeSegment {
  int thing = 0;
  RoundLine line;  ///< fixed frame
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
  Vector3 to_sun = Vector3::UnitZ();  ///< unit
  Vector3 background;                 ///< in proportion to light
  std::deque<Paint> paints;           ///< where others point to
  std::vector<TubeSegment> segments;
  std::vector<PlacedPart> planes;  ///< which have no bounds
  std::vector<PlacedPart> boxes;
  std::vector<PlacedPart> solids;  ///< round ones
  std::vector<PlacedPart> meshes;
  std::map<const TriangleMesh*, std::shared_ptr<const MeshTree>> trees;
  RTCScene scene = nullptr;

  /// By which Embree names what it has hit: the geometry's id.
  static constexpr unsigned tubes_id = 0, boxes_id = 1, solids_id = 2, first_mesh_id = 3;

  /// The nearest plane that a ray meets before t = `highest`. Its index, or -1, and where.
  struct PlaneMeeting {
    int plane = -1;
    double t;
  };
  PlaneMeeting meet_planes(const Ray& ray, double highest) const;
  /// What a ray meets there.
  Sighting plane_sighting(const Ray& ray, const PlaneMeeting& meeting, double footprint) const;
  /// What a ray meets where Embree has hit something at about `t`, in double precision. `lowest`: as of the ray; `footprint` [1]:
  /// the size of a pixel at t = 1, by which patterns are blurred; 0 where colors are not asked for.
  Sighting sighting(const Ray& ray, double lowest, const RTCHit& hit, double t, double footprint) const;

  /// Parts, but for planes, that rays pass through.
  using Housing = std::vector<const PlacedPart*>;
  /// Those that a point is in, or on.
  Housing around(const Vector3& point) const;
  /// Whether it is one of them that Embree has hit.
  bool is_of(const Housing& housing, const RTCHit& hit) const {
    return !housing.empty() && std::find(housing.begin(), housing.end(), part_hit(hit)) != housing.end();
  }
  /// Whether a ray meets anything but planes before t = `highest`.
  bool is_blocked(const Ray& ray, double highest, const Housing& housing) const;
  /// What one ray meets first, before t = `highest`.
  Sighting look(const Ray& ray, double highest, const Housing& housing, double footprint) const;

 private:
  /// Null for tubes.
  const PlacedPart* part_hit(const RTCHit& hit) const;
  /// Where a ray meets something else than planes, from t = `lowest` on; that is raised past what rays pass through.
  RTCRayHit cast(const Ray& ray, double& lowest, double highest, const Housing& housing) const;
  std::vector<PlacedPart>& group_of(const Shape& shape);
  void place(const Thing& thing, int index);
  void place(const Tube& tube, const Paint& paint, int index);
  void find_origin();
  void build(const Implementation* before);
  void add_tubes();
  void add_boxes();
  void add_solids();
  void add_meshes(const Implementation* before);
};

}  // namespace verlet_cable::view
