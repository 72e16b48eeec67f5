#include "verlet_cable/view/render.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "depth_sensor.h"
#include "error_lines.h"
#include "shading.h"
#include "stage_implementation.h"

namespace verlet_cable::view {
namespace {

constexpr int side = 4;  // of the squares of pixels whose rays Embree follows together
constexpr int rays = side * side;
// [m] and of the depth: by so much a surface is left before its shadow is looked for, so that rounding casts none.
constexpr double least_gap = 2e-5, gap_of_depth = 1e-5;
constexpr double shadow_reach = 1e6;  // [m]

/// What is known of the pixels of a square.
struct Square {
  std::array<std::size_t, rays> pixels;
  std::array<Ray, rays> lines;
  std::array<Sighting, rays> seen;
  std::array<Stage::Implementation::PlaneMeeting, rays> planes;
  alignas(64) int valid[rays];  // -1 where there is a pixel, 0 where the image has ended
};

template <class Ray16>
void set_ray(Ray16& ray, int i, const Vector3& start, const Vector3& direction, double lowest, double highest) {
  ray.org_x[i] = static_cast<float>(start.x());
  ray.org_y[i] = static_cast<float>(start.y());
  ray.org_z[i] = static_cast<float>(start.z());
  ray.dir_x[i] = static_cast<float>(direction.x());
  ray.dir_y[i] = static_cast<float>(direction.y());
  ray.dir_z[i] = static_cast<float>(direction.z());
  ray.tnear[i] = static_cast<float>(lowest);
  ray.tfar[i] = static_cast<float>(highest);
  ray.time[i] = 0;
  ray.mask[i] = 0xffffffff;
  ray.id[i] = 0;
  ray.flags[i] = 0;
}

/// Makes one image, square by square.
class Painter {
 public:
  Painter(const Stage& stage, const Lens& lens, const Pose& pose, const SensorModel& sensor, const NoiseSeed& noise,
          const ImageBuffers& images)
      : stage_(stage.implementation()),
        lens_(lens),
        model_(lens.model()),
        axes_(pose.orientation.normalized().toRotationMatrix()),
        eye_(pose.position),
        second_eye_(pose.position + sensor.baseline * axes_.col(0)),
        housing_(stage_.around(eye_)),
        sensor_(sensor),
        noise_(noise),
        images_(images),
        wants_depth_(images.depth || images.points),
        measures_(wants_depth_ && !is_perfect(sensor)),
        footprint_(images.rgb ? 1 / std::min(model_.fx, model_.fy) : 0) {
    if (sensor.baseline != 0) {
      const auto around_second = stage_.around(second_eye_);
      housing_.insert(housing_.end(), around_second.begin(), around_second.end());
    }
    const std::size_t pixels = static_cast<std::size_t>(model_.width) * model_.height;
    if (measures_) cosine_.resize(pixels);
    if (measures_ || (wants_depth_ && !images.depth)) depth_.resize(pixels);
    true_depth_ = depth_.empty() ? images.depth : depth_.data();
  }

  void paint() {
    const auto for_all = [](int count, const auto& visit) {
      tbb::parallel_for(tbb::blocked_range<int>(0, count), [&](const tbb::blocked_range<int>& range) {
        for (int i = range.begin(); i < range.end(); ++i) visit(i);
      });
    };
    for_all((model_.height + side - 1) / side, [this](int band) {
      for (int column = 0; column < model_.width; column += side) paint_square(column, side * band);
    });
    if (wants_depth_ && (measures_ || images_.points)) for_all(model_.height, [this](int row) { finish_row(row); });
  }

 private:
  void paint_square(int first_column, int first_row) const {
    Square square;
    find_lines(first_column, first_row, square);
    find_seen(square);
    if (wants_depth_) write_depth(square);
    if (measures_ && sensor_.baseline != 0) note_shadows_of_projector(square);
    if (images_.mask)
      for_each(square, [&](int i) { images_.mask[square.pixels[i]] = static_cast<std::uint16_t>(square.seen[i].thing + 1); });
    if (images_.rgb) write_colors(square);
  }

  template <class Visit>
  static void for_each(const Square& square, const Visit& visit) {
    for (int i = 0; i < rays; ++i)
      if (square.valid[i]) visit(i);
  }

  void find_lines(int first_column, int first_row, Square& square) const {
    for (int i = 0; i < rays; ++i) {
      const int column = first_column + i % side, row = first_row + i / side;
      square.valid[i] = column < model_.width && row < model_.height ? -1 : 0;
      if (!square.valid[i]) continue;
      const auto& [x, y] = lens_.sight(column, row);
      square.pixels[i] = static_cast<std::size_t>(row) * model_.width + column;
      square.lines[i] = {eye_, axes_ * Vector3(x, y, 1)};
      square.planes[i] = stage_.meet_planes(square.lines[i], model_.far);
    }
  }

  void find_seen(Square& square) const {
    alignas(64) RTCRayHit16 query = {};
    const Vector3 start = eye_ - stage_.origin;
    for_each(square, [&](int i) {
      set_ray(query.ray, i, start, square.lines[i].direction, 0, square.planes[i].t);
      query.hit.geomID[i] = query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    });
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(square.valid, stage_.scene, &context, &query);
    for_each(square, [&](int i) {
      RTCHit hit;
      hit.geomID = query.hit.geomID[i];
      hit.primID = query.hit.primID[i];
      hit.instID[0] = query.hit.instID[0][i];
      if (hit.geomID != RTC_INVALID_GEOMETRY_ID)
        square.seen[i] = stage_.is_of(housing_, hit) ? stage_.look(square.lines[i], model_.far, housing_, footprint_)
                                                     : stage_.sighting(square.lines[i], 0, hit, query.ray.tfar[i], footprint_);
      else if (square.planes[i].plane >= 0)
        square.seen[i] = stage_.plane_sighting(square.lines[i], square.planes[i], footprint_);
    });
  }

  void write_depth(const Square& square) const {
    for_each(square, [&](int i) {
      const Sighting& seen = square.seen[i];
      const bool has_depth = seen && (measures_ || seen.t >= model_.near);
      true_depth_[square.pixels[i]] = has_depth ? static_cast<float>(seen.t) : std::numeric_limits<float>::quiet_NaN();
      if (!measures_ || !seen) return;
      const Vector3& direction = square.lines[i].direction;
      cosine_[square.pixels[i]] = static_cast<float>(std::abs(direction.dot(seen.normal)) / direction.norm());
    });
  }

  /// A place just in front of what is seen.
  static Vector3 before(const Square& square, int i) {
    const Sighting& seen = square.seen[i];
    const Vector3 outwards = seen.normal.dot(square.lines[i].direction) < 0 ? seen.normal : Vector3(-seen.normal);
    return square.lines[i].at(seen.t) + (least_gap + gap_of_depth * seen.t) * outwards;
  }

  /// Where something is between a surface and a place, `aim(i)` further on than where a pixel's line ends. `wanted`: -1 for those
  /// that are asked for.
  template <class Aim>
  void find_hidden(const Square& square, const int* wanted, const Aim& aim, double highest, bool* hidden) const {
    alignas(64) RTCRay16 query = {};
    for (int i = 0; i < rays; ++i) {
      if (!wanted[i]) continue;
      const Vector3 start = before(square, i);
      set_ray(query, i, start - stage_.origin, aim(start), 0, highest);
    }
    RTCIntersectContext context;
    // Not as coherent rays: with instances, Embree 3.13 then does not come back.
    rtcInitIntersectContext(&context);
    rtcOccluded16(wanted, stage_.scene, &context, &query);
    for (int i = 0; i < rays; ++i) hidden[i] = wanted[i] && query.tfar[i] < 0;
  }

  /// The second imager, or the projector, sees nothing of what something else is in front of, or that faces away from it.
  void note_shadows_of_projector(const Square& square) const {
    alignas(64) int wanted[rays] = {};
    for_each(square, [&](int i) {
      const Sighting& seen = square.seen[i];
      if (!seen) return;
      const Vector3& direction = square.lines[i].direction;
      const double towards = (second_eye_ - square.lines[i].at(seen.t)).dot(seen.normal) * -direction.dot(seen.normal);
      if (towards > 0)
        wanted[i] = -1;
      else
        cosine_[square.pixels[i]] = -1;
    });
    bool hidden[rays];
    find_hidden(
        square, wanted, [&](const Vector3& start) -> Vector3 { return second_eye_ - start; }, 1, hidden);
    for_each(square, [&](int i) {
      if (!hidden[i]) return;
      const Vector3 start = before(square, i);
      if (housing_.empty() || stage_.is_blocked({start, second_eye_ - start}, 1, housing_)) cosine_[square.pixels[i]] = -1;
    });
  }

  void write_colors(const Square& square) const {
    bool hidden[rays] = {};
    if (stage_.drawing.light.shadows) {
      alignas(64) int wanted[rays] = {};
      bool any = false;
      for_each(square, [&](int i) {
        if (square.seen[i] && square.seen[i].normal.dot(stage_.to_sun) > 0) wanted[i] = -1, any = true;
      });
      if (any)
        find_hidden(
            square, wanted, [&](const Vector3&) { return stage_.to_sun; }, shadow_reach, hidden);
    }
    for_each(square, [&](int i) {
      const Sighting& seen = square.seen[i];
      const Vector3 direction = square.lines[i].direction.normalized();
      write_color(seen ? light_from(stage_, seen, direction, !hidden[i]) : stage_.background, images_.rgb + 3 * square.pixels[i]);
    });
  }

  void finish_row(int row) const {
    const std::size_t first = static_cast<std::size_t>(row) * model_.width;
    std::vector<float> own;
    float* depth = images_.depth ? images_.depth + first : true_depth_ + first;
    if (measures_) {
      if (!images_.depth) {
        own.resize(model_.width);  // neighbours' edges are those of true depth
        depth = own.data();
      }
      measure_row(model_, sensor_, noise_, {true_depth_, cosine_.data()}, row, depth);
    }
    if (!images_.points) return;
    for (int column = 0; column < model_.width; ++column) {
      const auto& [x, y] = lens_.sight(column, row);
      float* point = images_.points + 3 * (first + column);
      point[0] = static_cast<float>(x * depth[column]);
      point[1] = static_cast<float>(y * depth[column]);
      point[2] = depth[column];
    }
  }

  const Stage::Implementation& stage_;
  const Lens& lens_;
  const CameraModel& model_;
  Eigen::Matrix3d axes_;  ///< of the optical frame in the fixed one
  Vector3 eye_;
  Vector3 second_eye_;                      ///< [m] the second imager, or the projector
  Stage::Implementation::Housing housing_;  ///< what they are in
  const SensorModel& sensor_;
  const NoiseSeed& noise_;
  const ImageBuffers& images_;
  bool wants_depth_;
  bool measures_;
  double footprint_;  ///< [1] size of a pixel at depth 1, where colors are wanted
  float* true_depth_ = nullptr;
  std::vector<float> depth_;  ///< where it is not the image
  mutable std::vector<float> cosine_;
};

/// [m] The larger of those beside a node.
double radius_at(const Tube& tube, std::size_t node) {
  if (tube.radii.size() == 1) return tube.radii.front();
  const std::size_t last = tube.radii.size() - 1;
  return std::max(tube.radii[node == 0 ? 0 : node - 1], tube.radii[std::min(node, last)]);
}

}  // namespace

void render(const Stage& stage, const Lens& lens, const Pose& pose, const SensorModel& sensor, const NoiseSeed& noise,
            const ImageBuffers& images) {
  throw_errors(validate(sensor, lens.model().near, lens.model().far));
  if (!verlet_cable::is_sound(pose))
    throw std::invalid_argument("pose: not a pose; allowed: finite numbers, and a unit quaternion");
  Painter(stage, lens, pose, sensor, noise, images).paint();
}

std::vector<CableTruth> find_truth(const Stage& stage, const CameraModel& model, const Pose& pose) {
  constexpr double reach = 2;  // of the radius, from a node to where the cable is met
  const Stage::Implementation& inside = stage.implementation();
  const Quaternion to_camera = pose.orientation.conjugate();
  const Stage::Implementation::Housing housing = inside.around(pose.position);
  std::vector<CableTruth> all;
  for (std::size_t thing = 0; thing < inside.drawing.things.size(); ++thing) {
    const Thing& cable = inside.drawing.things[thing];
    if (cable.kind != Thing::Kind::cable) continue;
    CableTruth truth;
    truth.name = cable.name;
    for (const Tube& tube : cable.tubes) {
      for (std::size_t node = 0; node < tube.centers.size(); ++node) {
        const Vector3 place = to_camera * (tube.centers[node] - pose.position);
        const auto [u, v] = project(model, place);
        truth.positions.push_back(place);
        truth.u.push_back(u);
        truth.v.push_back(v);
        const bool is_in_image = u >= -0.5 && u < model.width - 0.5 && v >= -0.5 && v < model.height - 0.5;
        bool is_visible = is_in_image && place.z() >= model.near && place.z() <= model.far;
        if (is_visible) {
          const Ray ray{pose.position, (tube.centers[node] - pose.position) / place.z()};
          const Sighting seen = inside.look(ray, model.far, housing, 0);
          is_visible = seen.thing == static_cast<int>(thing) &&
                       (ray.at(seen.t) - tube.centers[node]).norm() <= reach * radius_at(tube, node);
        }
        truth.visible.push_back(is_visible);
      }
    }
    all.push_back(std::move(truth));
  }
  return all;
}

}  // namespace verlet_cable::view
