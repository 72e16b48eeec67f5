#include "verlet_cable/view/camera_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "error_lines.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable::view {
namespace {

constexpr double not_seen = std::numeric_limits<double>::quiet_NaN();
constexpr Range fov_range{0.01, 3.12, "any number above 0 and below pi"};
constexpr Range near_range{1e-4, 1e6, "any number above 0"};
constexpr Range focal_range{1e-3, 1e9, "any number above 0"};
constexpr Range center_range{-1e6, 1e6, "finite numbers"};
constexpr Range distortion_range{-1e3, 1e3, "five numbers k1, k2, t1, t2, k3"};

void check_common(int width, int height, const std::array<double, 5>& distortion, double near, double far, ErrorLines& errors) {
  const std::string size_words = "an integer [pixels] (from 1 to " + std::to_string(most_pixels) + ")";
  errors.require(width >= 1 && width <= most_pixels, "width", std::to_string(width), size_words);
  errors.require(height >= 1 && height <= most_pixels, "height", std::to_string(height), size_words);
  const bool are_sound =
      std::all_of(distortion.begin(), distortion.end(), [](double number) { return distortion_range.contains(number); });
  errors.require(are_sound, "distortion", list_text(distortion), distortion_range.text());
  errors.require(near_range.contains(near), "near", number_text(near), near_range.text("m"));
  errors.require(near_range.contains(far), "far", number_text(far), near_range.text("m"));
  errors.require(!near_range.contains(near) || !near_range.contains(far) || near < far, "far", number_text(far),
                 "any number above near, " + number_text(near) + " [m]");
}

/// The law of plumb_bob (Brown, Decentering Distortion of Lenses, 1966) from x and y without a lens to those with it, and its
/// derivatives.
struct Distorted {
  double x, y;
  double dx_dx, dx_dy, dy_dy;  // dy_dx is dx_dy

  double determinant() const { return dx_dx * dy_dy - dx_dy * dx_dy; }
  /// Whether what is further out is seen further out: beyond the place where it is not, the law means nothing.
  bool is_sound() const { return dx_dx > 0 && determinant() > 0; }
};

Distorted distort(const std::array<double, 5>& distortion, double x, double y) {
  const auto& [k1, k2, t1, t2, k3] = distortion;
  const double rr = x * x + y * y;
  const double radial = 1 + rr * (k1 + rr * (k2 + rr * k3));
  const double slope = k1 + rr * (2 * k2 + rr * 3 * k3);  // of `radial` by rr
  Distorted result;
  result.x = x * radial + 2 * t1 * x * y + t2 * (rr + 2 * x * x);
  result.y = y * radial + t1 * (rr + 2 * y * y) + 2 * t2 * x * y;
  result.dx_dx = radial + 2 * x * x * slope + 2 * t1 * y + 6 * t2 * x;
  result.dx_dy = 2 * x * y * slope + 2 * t1 * x + 2 * t2 * y;
  result.dy_dy = radial + 2 * y * y * slope + 6 * t1 * y + 2 * t2 * x;
  return result;
}

bool is_distorted(const CameraModel& model) {
  return std::any_of(model.distortion.begin(), model.distortion.end(), [](double number) { return number != 0; });
}

/// Newton's method from `start` to the point that the lens shows at (x, y); not a number where there is none.
std::array<double, 2> undistort(const std::array<double, 5>& distortion, double x, double y, std::array<double, 2> start) {
  constexpr int most_iterations = 30;
  constexpr double tolerance = 1e-13;
  auto [a, b] = start;
  for (int k = 0; k < most_iterations; ++k) {
    const Distorted at = distort(distortion, a, b);
    if (!at.is_sound()) break;
    const double ex = x - at.x, ey = y - at.y;
    if (std::abs(ex) + std::abs(ey) < tolerance * (1 + std::abs(x) + std::abs(y))) return {a, b};
    a += (at.dy_dy * ex - at.dx_dy * ey) / at.determinant();
    b += (at.dx_dx * ey - at.dx_dy * ex) / at.determinant();
  }
  return {not_seen, not_seen};
}

/// Along every row from the middle outwards, as each pixel's neighbour is where to begin from.
std::vector<std::array<double, 2>> find_sights(const CameraModel& model) {
  const int width = model.width, height = model.height;
  std::vector<std::array<double, 2>> sights(static_cast<std::size_t>(width) * height);
  const auto at = [&](int column, int row) -> std::array<double, 2>& {
    return sights[static_cast<std::size_t>(row) * width + column];
  };
  const bool distorted = is_distorted(model);
  const auto find = [&](int column, int row, const std::array<double, 2>& start) {
    const double x = (column - model.cx) / model.fx, y = (row - model.cy) / model.fy;
    at(column, row) = distorted ? undistort(model.distortion, x, y, start) : std::array<double, 2>{x, y};
  };
  const int middle_column = std::clamp(static_cast<int>(std::lround(std::clamp(model.cx, 0.0, 1.0 * width))), 0, width - 1);
  const int middle_row = std::clamp(static_cast<int>(std::lround(std::clamp(model.cy, 0.0, 1.0 * height))), 0, height - 1);
  find(middle_column, middle_row, {0, 0});
  for (int row = middle_row + 1; row < height; ++row) find(middle_column, row, at(middle_column, row - 1));
  for (int row = middle_row - 1; row >= 0; --row) find(middle_column, row, at(middle_column, row + 1));
  for (int row = 0; row < height; ++row) {
    for (int column = middle_column + 1; column < width; ++column) find(column, row, at(column - 1, row));
    for (int column = middle_column - 1; column >= 0; --column) find(column, row, at(column + 1, row));
  }
  return sights;
}

/// Unit.
Vector3 line_of_sight(const Vector3& eye, const Vector3& target) {
  const Vector3 way = target - eye;
  const double distance = way.norm();
  if (!(distance > 0 && distance < infinity)) throw std::invalid_argument("target: the place of eye; allowed: any other");
  return way / distance;
}

/// Whether `up` says how a camera that looks along z is turned about that.
bool is_across(const Vector3& z, const Vector3& up) {
  const double across = z.cross(up).norm();
  return across > 1e-9 * up.norm() && across < infinity;
}

}  // namespace

std::vector<std::string> validate(const CameraDesc& desc) {
  ErrorLines errors;
  check_common(desc.width, desc.height, desc.distortion, desc.near, desc.far, errors);
  errors.require(fov_range.contains(desc.horizontal_fov), "horizontal_fov", number_text(desc.horizontal_fov),
                 fov_range.text("rad"));
  return errors.lines().empty() ? validate(camera_model(desc)) : errors.lines();
}

std::vector<std::string> validate(const CameraModel& model) {
  ErrorLines errors;
  check_common(model.width, model.height, model.distortion, model.near, model.far, errors);
  errors.require(focal_range.contains(model.fx), "fx", number_text(model.fx), focal_range.text("pixels"));
  errors.require(focal_range.contains(model.fy), "fy", number_text(model.fy), focal_range.text("pixels"));
  errors.require(center_range.contains(model.cx), "cx", number_text(model.cx), center_range.text("pixels"));
  errors.require(center_range.contains(model.cy), "cy", number_text(model.cy), center_range.text("pixels"));
  if (errors.lines().empty() && is_distorted(model)) {
    const std::vector<std::array<double, 2>> sights = find_sights(model);
    const bool can_be_undone = std::none_of(sights.begin(), sights.end(), [](const auto& sight) { return std::isnan(sight[0]); });
    errors.require(can_be_undone, "distortion", list_text(model.distortion),
                   "k1, k2, t1, t2, k3 with which each pixel of the image shows one direction");
  }
  return errors.lines();
}

CameraModel camera_model(const CameraDesc& desc) {
  CameraModel model;
  model.width = desc.width;
  model.height = desc.height;
  model.fx = model.fy = 0.5 * desc.width / std::tan(0.5 * desc.horizontal_fov);
  model.cx = 0.5 * (desc.width - 1);
  model.cy = 0.5 * (desc.height - 1);
  model.distortion = desc.distortion;
  model.near = desc.near;
  model.far = desc.far;
  return model;
}

Pose look_at(const Vector3& eye, const Vector3& target, const Vector3& up) {
  const Vector3 z = line_of_sight(eye, target);
  if (!is_across(z, up))
    throw std::invalid_argument("up: " + list_text(up) +
                                ", along the line of sight, or without length; allowed: any other direction, such as " +
                                (is_across(z, Vector3::UnitZ()) ? "[0, 0, 1]" : "[0, 1, 0] for what is seen from above"));
  const Vector3 across = z.cross(up);
  const Vector3 x = across.normalized();
  Eigen::Matrix3d axes;
  axes << x, z.cross(x), z;
  return {eye, Quaternion(axes).normalized()};
}

Pose look_at(const Vector3& eye, const Vector3& target) {
  const Vector3 z = line_of_sight(eye, target);
  return look_at(eye, target, is_across(z, Vector3::UnitZ()) ? Vector3::UnitZ() : Vector3::UnitY());
}

std::array<double, 2> project(const CameraModel& model, const Vector3& point) {
  if (!(point.z() > 0)) return {not_seen, not_seen};
  const double x = point.x() / point.z(), y = point.y() / point.z();
  if (!is_distorted(model)) return {model.fx * x + model.cx, model.fy * y + model.cy};
  // Sound all the way from the line of sight on: the law may be so again further out, where it shows nothing that there is.
  constexpr int parts = 16;
  for (int k = 1; k <= parts; ++k)
    if (!distort(model.distortion, x * k / parts, y * k / parts).is_sound()) return {not_seen, not_seen};
  const Distorted at = distort(model.distortion, x, y);
  return {model.fx * at.x + model.cx, model.fy * at.y + model.cy};
}

Lens::Lens(const CameraModel& model) : model_(model) {
  throw_errors(validate(model));
  sights_ = find_sights(model);
}

}  // namespace verlet_cable::view
