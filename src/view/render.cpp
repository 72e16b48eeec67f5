#include "verlet_cable/view/render.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "depth_sensor.h"
#include "error_lines.h"
#include "packets/passes.h"
#include "pattern.h"
#include "shading.h"
#include "stage_implementation.h"

namespace verlet_cable::view {
namespace {

// [m] and of the depth: by so much a surface is left before its shadow is looked for, so that rounding casts none.
constexpr double least_gap = 2e-5, gap_of_depth = 1e-5;

/// A surface of each ray of a square.
struct SurfaceLanes {
  std::array<Surface, rays> all;  ///< those that there are, each once
  int count = 0;
  alignas(64) std::int64_t of_ray[rays];  ///< index into them; -1: nothing is seen

  const Surface& operator[](int i) const { return all[static_cast<std::size_t>(of_ray[i])]; }
  bool is_seen(int i) const { return of_ray[i] >= 0; }
  Viewers viewers(int index) const { return {of_ray, index}; }
};

/// What is known of the pixels of a square.
struct Square {
  std::size_t first_pixel;
  bool is_whole;                // it is all in the image
  alignas(64) int valid[rays];  // -1 where there is a pixel, 0 where the image has ended
  VectorLanes direction;
  SurfaceLanes surfaces;
  Lanes t;
  VectorLanes normal;
  Lanes cosine;
};

void set(VectorLanes& lanes, int i, const Vector3& vector) {
  lanes.x[i] = vector.x();
  lanes.y[i] = vector.y();
  lanes.z[i] = vector.z();
}

Vector3 vector_of(const VectorLanes& lanes, int i) {
  return {lanes.x[i], lanes.y[i], lanes.z[i]};
}

bool is_same(const RTCHit16& hits, int i, int k) {
  return hits.geomID[i] == hits.geomID[k] && hits.primID[i] == hits.primID[k] && hits.instID[0][i] == hits.instID[0][k];
}

/// How much of the stripe is seen of a tube.
double stripe_of(const Surface& surface, const Ray& ray, double t, const Vector3& normal, double width) {
  const TubeSegment& segment = *surface.segment;
  const double part = std::clamp(surface.line->part(ray.at(t)), 0.0, 1.0);
  const double roll = segment.roll_at_start + part * (segment.roll_at_end - segment.roll_at_start);
  const double angle = std::atan2(normal.dot(segment.third), normal.dot(segment.second)) - roll;
  return stripes_at(surface.paint->look, angle, width / surface.line->radius());
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
        start_(eye_ - stage_.origin),
        second_eye_(sensor.baseline * axes_.col(0)),
        housing_(stage_.around(eye_)),
        sensor_(sensor),
        noise_(noise),
        images_(images),
        wants_depth_(images.depth || images.points),
        measures_(wants_depth_ && !is_perfect(sensor)),
        footprint_(1 / std::min(model_.fx, model_.fy)) {
    if (sensor.baseline != 0) {
      const auto around_second = stage_.around(eye_ + second_eye_);
      housing_.insert(housing_.end(), around_second.begin(), around_second.end());
    }
    for (std::size_t i = 0; i < stage_.planes.size(); ++i) {
      const PlaneNumbers numbers = stage_.numbers_of(stage_.planes[i], eye_);
      // From their outside only.
      if (numbers.height <= 0) planes_.push_back({static_cast<int>(i), numbers});
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
      Square square;
      for (int column = 0; column < model_.width; column += side) paint_square(column, side * band, square);
    });
    if (wants_depth_ && (measures_ || images_.points)) for_all(model_.height, [this](int row) { finish_row(row); });
  }

 private:
  struct SeenPlane {
    int index;
    PlaneNumbers numbers;
  };

  void paint_square(int first_column, int first_row, Square& square) const {
    find_lines(first_column, first_row, square);
    find_seen(square);
    if (measures_ || images_.rgb) passes_.find_cosines(square.direction, square.normal, square.cosine);
    if (wants_depth_) write_depth(square);
    if (measures_ && sensor_.baseline != 0) note_shadows_of_projector(square);
    if (images_.mask) write_mask(square);
    if (images_.rgb) write_colors(square);
  }

  template <class Visit>
  static void for_each(const Square& square, const Visit& visit) {
    for (int i = 0; i < rays; ++i)
      if (square.valid[i]) visit(i);
  }

  template <class Visit>
  static void for_each_seen(const Square& square, const Visit& visit) {
    for (int i = 0; i < rays; ++i)
      if (square.surfaces.is_seen(i)) visit(i);
  }

  void find_lines(int first_column, int first_row, Square& square) const {
    square.first_pixel = static_cast<std::size_t>(first_row) * model_.width + first_column;
    square.is_whole = first_column + side <= model_.width && first_row + side <= model_.height;
    Lanes x, y;
    for (int i = 0; i < rays; ++i) {
      const int column = first_column + i % side, row = first_row + i / side;
      square.valid[i] = column < model_.width && row < model_.height ? -1 : 0;
      const auto& sight = lens_.sight(std::min(column, model_.width - 1), std::min(row, model_.height - 1));
      x[i] = sight[0];
      y[i] = sight[1];
    }
    passes_.turn(axes_.data(), x, y, square.direction);
  }

  std::size_t pixel(const Square& square, int i) const {
    return square.first_pixel + static_cast<std::size_t>(i / side) * model_.width + i % side;
  }

  /// Writes `value(i)` of each pixel into an image.
  template <class Pixel, class Value>
  void write(const Square& square, Pixel* image, const Value& value) const {
    for (int i = 0; i < rays; ++i)
      if (square.is_whole || square.valid[i]) image[pixel(square, i)] = value(i);
  }

  void find_seen(Square& square) const {
    Lanes highest, nearest_plane;
    for (int i = 0; i < rays; ++i) highest[i] = model_.far, nearest_plane[i] = -1;
    for (const SeenPlane& plane : planes_)
      passes_.meet_plane(plane.numbers, plane.index, square.direction, highest, nearest_plane);
    alignas(64) RTCRayHit16 query;
    passes_.ask(start_.data(), square.direction, highest, query);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(square.valid, stage_.scene, &context, &query);
    if (!housing_.empty()) look_out_of_housing(square, highest, query);
    collect_surfaces(square, query, nearest_plane);
    meet_surfaces(square, query);
  }

  void look_out_of_housing(const Square& square, const Lanes& highest, RTCRayHit16& query) const {
    for_each(square, [&](int i) {
      RTCHit hit;
      hit.geomID = query.hit.geomID[i];
      hit.primID = query.hit.primID[i];
      hit.instID[0] = query.hit.instID[0][i];
      if (hit.geomID == RTC_INVALID_GEOMETRY_ID || !stage_.is_of(housing_, hit)) return;
      const RTCRayHit found = stage_.cast({eye_, vector_of(square.direction, i)}, highest[i], housing_);
      query.ray.tfar[i] = found.ray.tfar;
      query.hit.geomID[i] = found.hit.geomID;
      query.hit.primID[i] = found.hit.primID;
      query.hit.instID[0][i] = found.hit.instID[0];
    });
  }

  /// Most neighbours show the same.
  void collect_surfaces(Square& square, const RTCRayHit16& query, const Lanes& nearest_plane) const {
    SurfaceLanes& surfaces = square.surfaces;
    surfaces.count = 0;
    std::fill_n(surfaces.of_ray, rays, -1);
    const auto is_plane = [&](int i) { return query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID; };
    for_each(square, [&](int i) {
      if (is_plane(i) && nearest_plane[i] < 0) return;
      for (const int k : {i - 1, i - side}) {
        if (k < 0 || !square.surfaces.is_seen(k) || is_plane(i) != is_plane(k)) continue;
        if (is_plane(i) ? nearest_plane[i] == nearest_plane[k] : is_same(query.hit, i, k)) {
          surfaces.of_ray[i] = surfaces.of_ray[k];
          return;
        }
      }
      RTCHit hit;
      hit.geomID = query.hit.geomID[i];
      hit.primID = query.hit.primID[i];
      hit.instID[0] = query.hit.instID[0][i];
      surfaces.all[surfaces.count] =
          is_plane(i) ? stage_.surface_of_plane(static_cast<int>(nearest_plane[i]), eye_) : stage_.surface_of(hit, eye_);
      surfaces.of_ray[i] = surfaces.count++;
    });
  }

  /// Depth is found anew, in double precision.
  void meet_surfaces(Square& square, const RTCRayHit16& query) const {
    Lanes about;
    for (int i = 0; i < rays; ++i) about[i] = query.ray.tfar[i];
    square.t = about;
    square.normal = {};
    bool any_round = false;
    for (int k = 0; k < square.surfaces.count; ++k) {
      const Surface& surface = square.surfaces.all[k];
      const Viewers viewers = square.surfaces.viewers(k);
      switch (surface.form) {
        case Surface::Form::flat:
          passes_.meet_flat(surface.numbers, viewers, square.direction, about, square.t, square.normal);
          break;
        case Surface::Form::round:
          any_round = true;
          break;
        case Surface::Form::cylinder:
          for (int i = 0; i < rays; ++i)
            if (viewers.has(i)) meet_cylinder_of(*surface.part, i, square);
          break;
      }
    }
    if (any_round) meet_lines(square, about);
  }

  void meet_lines(Square& square, const Lanes& about) const {
    LineLanes lines = {};
    for (int i = 0; i < rays; ++i) {
      lines.radius[i] = 0;
      if (!square.surfaces.is_seen(i) || square.surfaces[i].form != Surface::Form::round) continue;
      const RoundLine& line = *square.surfaces[i].line;
      set(lines.start, i, line.start() - eye_);
      set(lines.axis, i, line.axis());
      lines.radius[i] = line.radius();
    }
    passes_.meet_round(lines, square.direction, about, square.t, square.normal);
  }

  void meet_cylinder_of(const PlacedPart& part, int i, Square& square) const {
    const auto& cylinder = std::get<CylinderShape>(part.shape);
    const Ray ray{eye_, vector_of(square.direction, i)};
    Vector3 normal = part.axes.transpose() * -ray.direction.normalized();
    square.t[i] = meet_cylinder(cylinder.radius, 0.5 * cylinder.length, part.inside(ray), 0, normal).value_or(square.t[i]);
    set(square.normal, i, part.axes * normal);
  }

  void write_depth(const Square& square) const {
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    const double nearest = measures_ ? 0 : model_.near;
    write(square, true_depth_,
          [&](int i) { return square.surfaces.is_seen(i) && square.t[i] >= nearest ? static_cast<float>(square.t[i]) : none; });
    if (measures_) write(square, cosine_.data(), [&](int i) { return static_cast<float>(square.cosine[i]); });
  }

  void write_mask(const Square& square) const {
    write(square, images_.mask,
          [&](int i) { return static_cast<std::uint16_t>(square.surfaces.is_seen(i) ? square.surfaces[i].thing + 1 : 0); });
  }

  /// Where something is between what is seen and a place from the eye, or, otherwise, in that direction. `wanted`: -1 for those
  /// that are asked for.
  void find_hidden(const Square& square, const int* wanted, const Vector3& aim, bool is_place, bool* hidden) const {
    alignas(64) RTCRay16 query;
    passes_.ask_hidden(start_.data(), aim.data(), is_place, least_gap, gap_of_depth, square.direction, square.t, square.normal,
                       query);
    RTCIntersectContext context;
    // Not as coherent rays: with instances, Embree 3.13 then does not come back.
    rtcInitIntersectContext(&context);
    rtcOccluded16(wanted, stage_.scene, &context, &query);
    for (int i = 0; i < rays; ++i) hidden[i] = wanted[i] && query.tfar[i] < 0;
    if (!is_place || housing_.empty()) return;
    // What the lens is in casts no shadow of the projector.
    for (int i = 0; i < rays; ++i) {
      if (!hidden[i]) continue;
      const Ray ray{stage_.origin + Vector3(query.org_x[i], query.org_y[i], query.org_z[i]),
                    Vector3(query.dir_x[i], query.dir_y[i], query.dir_z[i])};
      hidden[i] = stage_.cast(ray, 1, housing_).hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
  }

  /// The second imager, or the projector, sees nothing of what something else is in front of, or that faces away from it.
  void note_shadows_of_projector(const Square& square) const {
    alignas(64) int wanted[rays] = {};
    for_each_seen(square, [&](int i) {
      const Vector3 direction = vector_of(square.direction, i), normal = vector_of(square.normal, i);
      const double towards = (second_eye_ - square.t[i] * direction).dot(normal) * -direction.dot(normal);
      if (towards > 0)
        wanted[i] = -1;
      else
        cosine_[pixel(square, i)] = -1;
    });
    bool hidden[rays];
    find_hidden(square, wanted, second_eye_, true, hidden);
    for_each(square, [&](int i) {
      if (hidden[i]) cosine_[pixel(square, i)] = -1;
    });
  }

  void write_colors(const Square& square) const {
    Lanes is_lit, second;
    find_lit(square, is_lit);
    find_patterns(square, second);
    int steps[3 * rays] = {};
    const LightNumbers light{{stage_.to_sun.x(), stage_.to_sun.y(), stage_.to_sun.z()}, stage_.drawing.light.ambient};
    // Segments of a cable have one paint.
    std::array<const Paint*, rays> paints;
    int count = 0;
    alignas(64) std::int64_t of_ray[rays];
    for (int i = 0; i < rays; ++i) {
      const Paint* paint = square.surfaces.is_seen(i) ? square.surfaces[i].paint : nullptr;
      of_ray[i] = -1;
      if (!paint) continue;
      of_ray[i] = std::find(paints.begin(), paints.begin() + count, paint) - paints.begin();
      if (of_ray[i] == count) paints[count++] = paint;
    }
    for (int k = 0; k < count; ++k)
      passes_.find_light(light, paints[k]->numbers, {of_ray, k}, second, is_lit, square.direction, square.normal, steps);
    for_each(square, [&](int i) {
      std::uint8_t* bytes = images_.rgb + 3 * pixel(square, i);
      for (int k = 0; k < 3; ++k)
        bytes[k] = square.surfaces.is_seen(i) ? bytes_of_light[steps[k * rays + i]] : stage_.background[k];
    });
  }

  void find_lit(const Square& square, Lanes& is_lit) const {
    for (int i = 0; i < rays; ++i) is_lit[i] = 1;
    if (!stage_.drawing.light.shadows) return;
    alignas(64) int wanted[rays];
    const double x = stage_.to_sun.x(), y = stage_.to_sun.y(), z = stage_.to_sun.z();
    int any = 0;
    for (int i = 0; i < rays; ++i) {
      const double towards = square.normal.x[i] * x + square.normal.y[i] * y + square.normal.z[i] * z;
      wanted[i] = square.surfaces.is_seen(i) && towards > 0 ? -1 : 0;
      any |= wanted[i];
    }
    if (!any) return;
    bool hidden[rays];
    find_hidden(square, wanted, stage_.to_sun, false, hidden);
    for (int i = 0; i < rays; ++i) is_lit[i] = hidden[i] ? 0 : 1;
  }

  /// How much of the second color there is.
  void find_patterns(const Square& square, Lanes& second) const {
    constexpr double least_cosine = 0.02;
    second = {};
    for (int k = 0; k < square.surfaces.count; ++k) {
      const Surface& surface = square.surfaces.all[k];
      const Viewers viewers = square.surfaces.viewers(k);
      if (surface.segment && surface.segment->is_striped) {
        for (int i = 0; i < rays; ++i) {
          if (!viewers.has(i)) continue;
          const Ray ray{eye_, vector_of(square.direction, i)};
          const double width = footprint_ * square.t[i] / std::max(square.cosine[i], least_cosine);
          second[i] = stripe_of(surface, ray, square.t[i], vector_of(square.normal, i), width);
        }
      } else if (surface.part && surface.paint->look.pattern == Look::Pattern::checks) {
        const Eigen::Matrix3d& axes = surface.part->axes;
        const Vector3 eye = surface.part->inside(eye_);
        const CheckNumbers checks{{axes(0, 0), axes(1, 0), axes(2, 0)},
                                  {axes(0, 1), axes(1, 1), axes(2, 1)},
                                  eye.x(),
                                  eye.y(),
                                  surface.paint->look.check_size,
                                  footprint_};
        passes_.find_checks(checks, viewers, square.direction, square.t, square.cosine, second);
      }
    }
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
    if (images_.points) passes_.find_points(lens_.sight(0, row).data(), depth, model_.width, images_.points + 3 * first);
  }

  const PacketPasses& passes_ = packet_passes();
  const Stage::Implementation& stage_;
  const Lens& lens_;
  const CameraModel& model_;
  Eigen::Matrix3d axes_;  ///< of the optical frame in the fixed one
  Vector3 eye_;
  Vector3 start_;                           ///< [m] of the eye, where Embree has it
  Vector3 second_eye_;                      ///< [m] the second imager, or the projector, from the eye
  Stage::Implementation::Housing housing_;  ///< what they are in
  std::vector<SeenPlane> planes_;           ///< from whose outside the eye looks
  const SensorModel& sensor_;
  const NoiseSeed& noise_;
  const ImageBuffers& images_;
  bool wants_depth_;
  bool measures_;
  double footprint_;  ///< [1] size of a pixel at depth 1
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
          const Sighting seen = inside.look(ray, model.far, housing);
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
