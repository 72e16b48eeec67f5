#include "verlet_cable/view/stage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <variant>

#include "error_lines.h"
#include "stage_implementation.h"
#include "verlet_cable/core/rotation.h"

namespace verlet_cable::view {
namespace {

constexpr unsigned triangles_of_box = 12;
constexpr int face_axes[] = {2, 2, 1, 1, 0, 0};  // of a box, each with its lower face first

/// One for the process, and never released: stages may live until its end.
RTCDevice device() {
  static const RTCDevice made = rtcNewDevice("start_threads=0,set_affinity=0");
  if (!made)
    throw std::runtime_error("Embree cannot be used on this machine: error " + std::to_string(rtcGetDeviceError(nullptr)));
  return made;
}

void check(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (error != RTC_ERROR_NONE) throw std::runtime_error("Embree: error " + std::to_string(error));
}

/// [rad] By how much the material turns about a cable from one segment to the next, beyond what the bend does.
double turn_between(const Quaternion& first, const Quaternion& last) {
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), along = last * x;
  const Vector3 carried = smallest_rotation(first * x, along) * (first * y);
  const Vector3 turned = last * y;
  return std::atan2(carried.cross(turned).dot(along), carried.dot(turned));
}

std::array<Vector3, 3> corners(const PlacedPart& part, unsigned triangle) {
  const TriangleMesh& mesh = *std::get<MeshShape>(part.shape).mesh;
  const TriangleMesh::Triangle& indices = mesh.triangles()[triangle];
  std::array<Vector3, 3> corners;
  for (int k = 0; k < 3; ++k) corners[k] = part.axes * mesh.vertices()[indices[k]] + part.pose.position;
  return corners;
}

/// A surface through a point, with its normal to the side of the eye.
PlaneNumbers facing(const Vector3& normal, const Vector3& point, const Vector3& eye) {
  const double height = normal.dot(point - eye), sign = height > 0 ? -1 : 1;
  return {{sign * normal.x(), sign * normal.y(), sign * normal.z()}, sign * height};
}

RoundLine line_of(const PlacedPart& part) {
  if (const auto* sphere = std::get_if<SphereShape>(&part.shape))
    return RoundLine(part.pose.position, part.pose.position, sphere->radius);
  const auto& capsule = std::get<CapsuleShape>(part.shape);
  const Vector3 half = 0.5 * capsule.length * part.axes.col(2);
  return RoundLine(part.pose.position - half, part.pose.position + half, capsule.radius);
}

/// One of the rays that Embree has from the stage's origin on, in the fixed frame.
Ray ray_of(RTCRayN* rays, unsigned count, unsigned i, const Vector3& origin) {
  return {Vector3(RTCRayN_org_x(rays, count, i), RTCRayN_org_y(rays, count, i), RTCRayN_org_z(rays, count, i)) + origin,
          Vector3(RTCRayN_dir_x(rays, count, i), RTCRayN_dir_y(rays, count, i), RTCRayN_dir_z(rays, count, i))};
}

/// What Embree asks of round things. Its own round curves are in a tree of oriented boxes, as for hair, where rays take longer.
struct Lines {
  const Stage::Implementation& stage;

  std::optional<double> first(unsigned index, const Ray& ray, double lowest) const {
    return stage.lines[index].first(ray, lowest);
  }
  Aabb bounds(unsigned index) const {
    const RoundLine& line = stage.lines[index];
    const Vector3 end = line.start() + line.axis(), radius = Vector3::Constant(line.radius());
    return {line.start().cwiseMin(end) - radius, line.start().cwiseMax(end) + radius};
  }
  /// t of a packet's first meetings, `never` where there is none; false: nowhere.
  bool meet(unsigned index, RTCRayN* asked, unsigned count, double* t) const {
    static const PacketPasses& passes = packet_passes();
    const RoundLine& line = stage.lines[index];
    const Vector3 shift = stage.origin - line.start();
    if (!passes.meet_line(line.numbers(), shift.data(), asked, count, t)) return false;
    for (unsigned i = 0; i < count; ++i)
      if (t[i] == from_inside)
        t[i] = line.first(ray_of(asked, count, i, stage.origin), RTCRayN_tnear(asked, count, i)).value_or(never);
    return true;
  }
};

/// What it asks of cylinders.
struct Cylinders {
  const Stage::Implementation& stage;

  std::optional<double> first(unsigned index, const Ray& ray, double lowest) const {
    const PlacedPart& part = stage.cylinders[index];
    const auto& cylinder = std::get<CylinderShape>(part.shape);
    Vector3 normal;
    return meet_cylinder(cylinder.radius, 0.5 * cylinder.length, part.inside(ray), lowest, normal);
  }
  Aabb bounds(unsigned index) const { return verlet_cable::bounds(stage.cylinders[index].shape, stage.cylinders[index].pose); }
  bool meet(unsigned index, RTCRayN* asked, unsigned count, double* t) const {
    for (unsigned i = 0; i < count; ++i)
      t[i] = first(index, ray_of(asked, count, i, stage.origin), RTCRayN_tnear(asked, count, i)).value_or(never);
    return true;
  }
};

template <class Things>
void find_bounds(const RTCBoundsFunctionArguments* arguments) {
  const auto& stage = *static_cast<const Stage::Implementation*>(arguments->geometryUserPtr);
  Aabb box = Things{stage}.bounds(arguments->primID);
  box.translate(-stage.origin);
  const double margin = 1e-6 * (1 + box.min().cwiseAbs().maxCoeff() + box.max().cwiseAbs().maxCoeff());
  RTCBounds& out = *arguments->bounds_o;
  out.lower_x = static_cast<float>(box.min().x() - margin);
  out.lower_y = static_cast<float>(box.min().y() - margin);
  out.lower_z = static_cast<float>(box.min().z() - margin);
  out.upper_x = static_cast<float>(box.max().x() + margin);
  out.upper_y = static_cast<float>(box.max().y() + margin);
  out.upper_z = static_cast<float>(box.max().z() + margin);
}

/// t at which the rays that Embree has meet a thing, `never` where they do not; false: nowhere.
template <class Things>
bool find_meetings(const Things& things, unsigned index, RTCRayN* asked, unsigned count, double* t) {
  if (count > 1) return things.meet(index, asked, count, t);
  const auto first = things.first(index, ray_of(asked, 1, 0, things.stage.origin), RTCRayN_tnear(asked, 1, 0));
  *t = first.value_or(never);
  return first.has_value();
}

template <class Things>
void intersect(const RTCIntersectFunctionNArguments* arguments) {
  const Things things{*static_cast<const Stage::Implementation*>(arguments->geometryUserPtr)};
  const unsigned count = arguments->N;
  RTCRayN* asked = RTCRayHitN_RayN(arguments->rayhit, count);
  RTCHitN* hits = RTCRayHitN_HitN(arguments->rayhit, count);
  alignas(64) double t[rays];
  if (!find_meetings(things, arguments->primID, asked, count, t)) return;
  for (unsigned i = 0; i < count; ++i) {
    if (arguments->valid[i] != -1 || !(static_cast<float>(t[i]) < RTCRayN_tfar(asked, count, i))) continue;
    RTCRayN_tfar(asked, count, i) = static_cast<float>(t[i]);
    RTCHitN_geomID(hits, count, i) = arguments->geomID;
    RTCHitN_primID(hits, count, i) = arguments->primID;
    RTCHitN_instID(hits, count, i, 0) = arguments->context->instID[0];
  }
}

template <class Things>
void occlude(const RTCOccludedFunctionNArguments* arguments) {
  const Things things{*static_cast<const Stage::Implementation*>(arguments->geometryUserPtr)};
  const unsigned count = arguments->N;
  alignas(64) double t[rays];
  if (!find_meetings(things, arguments->primID, arguments->ray, count, t)) return;
  for (unsigned i = 0; i < count; ++i)
    if (arguments->valid[i] == -1 && t[i] < never && t[i] <= RTCRayN_tfar(arguments->ray, count, i))
      RTCRayN_tfar(arguments->ray, count, i) = -std::numeric_limits<float>::infinity();
}

template <class Item>
Item* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
  auto* items = static_cast<Item*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Item), count));
  check(device());
  return items;
}

void attach(RTCScene scene, RTCGeometry geometry, unsigned id) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

/// Things whose rays' meetings are asked for.
template <class Things>
RTCGeometry new_geometry(std::size_t count, Stage::Implementation& stage) {
  RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
  rtcSetGeometryUserData(geometry, &stage);
  rtcSetGeometryBoundsFunction(geometry, find_bounds<Things>, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect<Things>);
  rtcSetGeometryOccludedFunction(geometry, occlude<Things>);
  return geometry;
}

}  // namespace

Paint::Paint(const Look& of) : look(of) {
  const Vector3 color = in_proportion_to_light(of.color), second_color = in_proportion_to_light(of.second_color);
  std::copy_n(color.data(), 3, numbers.color);
  std::copy_n(second_color.data(), 3, numbers.second_color);
  numbers.shininess = of.shininess;
}

Vector3 in_proportion_to_light(const Color& color) {
  const auto part = [](double value) { return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4); };
  return {part(color[0]), part(color[1]), part(color[2])};
}

MeshTree::MeshTree(RTCDevice device, std::shared_ptr<const TriangleMesh> mesh)
    : mesh_(std::move(mesh)), scene_(rtcNewScene(device)) {
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const auto& vertices = mesh_->vertices();
  auto* points = new_buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) points[i][axis] = static_cast<float>(vertices[i][axis]);
  const auto& triangles = mesh_->triangles();
  auto* indices = new_buffer<std::array<unsigned, 3>>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) indices[i][k] = static_cast<unsigned>(triangles[i][k]);
  attach(scene_, geometry, 0);
  rtcCommitScene(scene_);
  check(device);
}

MeshTree::~MeshTree() {
  rtcReleaseScene(scene_);
}

Stage::Implementation::Implementation(Drawing shown, const Implementation* before) : drawing(std::move(shown)) {
  to_sun = drawing.light.direction.normalized();
  for (int k = 0; k < 3; ++k)
    background[k] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(drawing.background[k], 0.0, 1.0)));
  for (std::size_t i = 0; i < drawing.things.size(); ++i) place(drawing.things[i], static_cast<int>(i));
  collect_rounds();
  find_origin();
  build(before);
}

Stage::Implementation::~Implementation() {
  rtcReleaseScene(scene);
}

std::vector<PlacedPart>& Stage::Implementation::group_of(const Shape& shape) {
  struct Group {
    Implementation& stage;

    std::vector<PlacedPart>& operator()(const PlaneShape&) const { return stage.planes; }
    std::vector<PlacedPart>& operator()(const SphereShape&) const { return stage.rounds; }
    std::vector<PlacedPart>& operator()(const CapsuleShape&) const { return stage.rounds; }
    std::vector<PlacedPart>& operator()(const CylinderShape&) const { return stage.cylinders; }
    std::vector<PlacedPart>& operator()(const BoxShape&) const { return stage.boxes; }
    std::vector<PlacedPart>& operator()(const MeshShape&) const { return stage.meshes; }
  };
  return std::visit(Group{*this}, shape);
}

void Stage::Implementation::place(const Thing& thing, int index) {
  const Paint* paint = &paints.emplace_back(thing.look);
  for (const Tube& tube : thing.tubes) place(tube, *paint, index);
  for (const Part& part : thing.parts) {
    group_of(part.shape)
        .emplace_back(index, thing.pose * part.pose, part.shape, part.look ? paints.emplace_back(*part.look) : *paint);
  }
}

void Stage::Implementation::place(const Tube& tube, const Paint& paint, int index) {
  const std::size_t count = tube.centers.size() - 1;
  const bool is_striped = paint.look.pattern == Look::Pattern::stripes && !tube.orientations.empty();
  const std::size_t first = segments.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double radius = tube.radii[tube.radii.size() == 1 ? 0 : i];
    lines.emplace_back(tube.centers[i], tube.centers[i + 1], radius);
    TubeSegment segment{index, &paint};
    if (is_striped) {
      const Eigen::Matrix3d axes = tube.orientations[i].normalized().toRotationMatrix();
      segment.is_striped = true;
      segment.second = axes.col(1);
      segment.third = axes.col(2);
    }
    segments.push_back(segment);
  }
  for (std::size_t i = 1; is_striped && i < count; ++i) {
    const double turn = turn_between(tube.orientations[i - 1].normalized(), tube.orientations[i].normalized());
    segments[first + i - 1].roll_at_end = 0.5 * turn;
    segments[first + i].roll_at_start = -0.5 * turn;
  }
}

void Stage::Implementation::collect_rounds() {
  for (const PlacedPart& part : rounds) lines.push_back(line_of(part));
}

void Stage::Implementation::find_origin() {
  Aabb box;
  for (const RoundLine& line : lines) box.extend(line.start()).extend(line.start() + line.axis());
  for (const auto* group : {&boxes, &cylinders, &meshes})
    for (const PlacedPart& part : *group) box.extend(part.pose.position);
  if (!box.isEmpty()) origin = box.center();
}

void Stage::Implementation::build(const Implementation* before) {
  scene = rtcNewScene(device());
  // Rays do not slip through between triangles.
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  add_lines();
  add_boxes();
  add_cylinders();
  add_meshes(before);
  rtcCommitScene(scene);
  check(device());
}

void Stage::Implementation::add_lines() {
  if (!lines.empty()) attach(scene, new_geometry<Lines>(lines.size(), *this), lines_id);
}

void Stage::Implementation::add_boxes() {
  if (boxes.empty()) return;
  constexpr int corners_of_box = 8;
  static constexpr unsigned corners[triangles_of_box][3]{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                                         {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points =
      new_buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, corners_of_box * boxes.size());
  auto* indices =
      new_buffer<std::array<unsigned, 3>>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles_of_box * boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Vector3 half = 0.5 * std::get<BoxShape>(boxes[i].shape).size;
    for (int k = 0; k < corners_of_box; ++k) {
      const Vector3 corner = half.cwiseProduct(Vector3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
      const Vector3 point = boxes[i].pose.position - origin + boxes[i].axes * corner;
      for (int axis = 0; axis < 3; ++axis) points[corners_of_box * i + k][axis] = static_cast<float>(point[axis]);
    }
    for (unsigned k = 0; k < triangles_of_box; ++k)
      for (int corner = 0; corner < 3; ++corner)
        indices[triangles_of_box * i + k][corner] = static_cast<unsigned>(corners_of_box * i) + corners[k][corner];
  }
  attach(scene, geometry, boxes_id);
}

void Stage::Implementation::add_cylinders() {
  if (!cylinders.empty()) attach(scene, new_geometry<Cylinders>(cylinders.size(), *this), cylinders_id);
}

void Stage::Implementation::add_meshes(const Implementation* before) {
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto& mesh = std::get<MeshShape>(meshes[i].shape).mesh;
    auto& tree = trees[mesh.get()];
    if (!tree && before && before->trees.count(mesh.get()) > 0) tree = before->trees.at(mesh.get());
    if (!tree) tree = std::make_shared<MeshTree>(device(), mesh);
    RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, tree->scene());
    Eigen::Matrix<float, 3, 4, Eigen::ColMajor> transform;
    transform << meshes[i].pose.orientation.toRotationMatrix().cast<float>(), (meshes[i].pose.position - origin).cast<float>();
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform.data());
    attach(scene, geometry, first_mesh_id + static_cast<unsigned>(i));
  }
}

PlaneNumbers Stage::Implementation::numbers_of(const PlacedPart& plane, const Vector3& eye) const {
  const Vector3 normal = plane.axes.col(2);
  return {{normal.x(), normal.y(), normal.z()}, normal.dot(plane.pose.position - eye)};
}

Surface Stage::Implementation::surface_of_plane(int index, const Vector3& eye) const {
  const PlacedPart& plane = planes[static_cast<std::size_t>(index)];
  Surface surface{plane.thing, plane.paint, &plane};
  surface.numbers = numbers_of(plane, eye);
  return surface;
}

const PlacedPart* Stage::Implementation::part_hit(const RTCHit& hit) const {
  if (hit.instID[0] != RTC_INVALID_GEOMETRY_ID) return &meshes[hit.instID[0] - first_mesh_id];
  switch (hit.geomID) {
    case lines_id:
      return hit.primID < segments.size() ? nullptr : &rounds[hit.primID - segments.size()];
    case boxes_id:
      return &boxes[hit.primID / triangles_of_box];
    default:
      return &cylinders[hit.primID];
  }
}

Surface Stage::Implementation::surface_of(const RTCHit& hit, const Vector3& eye) const {
  const PlacedPart* const part = part_hit(hit);
  if (!part) {
    const TubeSegment& segment = segments[hit.primID];
    Surface surface{segment.thing, segment.paint, nullptr, &segment, Surface::Form::round};
    surface.line = &lines[hit.primID];
    return surface;
  }
  Surface surface{part->thing, part->paint, part};
  if (hit.instID[0] != RTC_INVALID_GEOMETRY_ID) {
    const auto [a, b, c] = corners(*part, hit.primID);
    surface.numbers = facing((b - a).cross(c - a).normalized(), a, eye);
  } else if (hit.geomID == boxes_id) {
    const unsigned face = hit.primID % triangles_of_box / 2;
    const int axis = face_axes[face];
    const Vector3 outwards = face % 2 ? part->axes.col(axis) : Vector3(-part->axes.col(axis));
    const double half = 0.5 * std::get<BoxShape>(part->shape).size[axis];
    surface.numbers = facing(outwards, part->pose.position + half * outwards, eye);
  } else if (hit.geomID == lines_id) {
    surface.form = Surface::Form::round;
    surface.line = &lines[hit.primID];
  } else {
    surface.form = Surface::Form::cylinder;
  }
  return surface;
}

Stage::Implementation::Housing Stage::Implementation::around(const Vector3& point) const {
  constexpr double reach = 1e-6;  // [m]
  Housing found;
  for (const auto* group : {&boxes, &rounds, &cylinders, &meshes})
    for (const PlacedPart& part : *group)
      if (closest_point(part.shape, part.inside(point), reach).distance < reach) found.push_back(&part);
  return found;
}

RTCRayHit Stage::Implementation::cast(const Ray& ray, double highest, const Housing& housing) const {
  constexpr double onwards = 1e-6;  // of t, and [1]: by so much a surface is left that a ray passes through
  const Eigen::Vector3f start = (ray.origin - origin).cast<float>(), direction = ray.direction.cast<float>();
  double lowest = 0;
  for (;;) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query;
    query.ray = {start.x(),
                 start.y(),
                 start.z(),
                 static_cast<float>(lowest),
                 direction.x(),
                 direction.y(),
                 direction.z(),
                 0,
                 static_cast<float>(highest),
                 0xffffffff,
                 0,
                 0};
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID || !is_of(housing, query.hit)) return query;
    lowest = query.ray.tfar * (1 + onwards) + onwards;
  }
}

Sighting Stage::Implementation::look(const Ray& ray, double highest, const Housing& housing) const {
  int plane = -1;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const PlaneNumbers numbers = numbers_of(planes[i], ray.origin);
    const double slope = -Vector3(numbers.normal).dot(ray.direction), depth = -numbers.height;
    // From their outside only.
    if (slope > 0 && depth >= 0 && depth < slope * highest) plane = planes[i].thing, highest = depth / slope;
  }
  const RTCRayHit found = cast(ray, highest, housing);
  if (found.hit.geomID != RTC_INVALID_GEOMETRY_ID) return {surface_of(found.hit, ray.origin).thing, found.ray.tfar};
  return {plane, highest};
}

Stage::Stage(Drawing drawing, const Stage* before) {
  throw_errors(validate(drawing));
  implementation_ = std::make_unique<const Implementation>(std::move(drawing), before ? before->implementation_.get() : nullptr);
}

Stage::~Stage() = default;

const Drawing& Stage::drawing() const {
  return implementation_->drawing;
}

}  // namespace verlet_cable::view
