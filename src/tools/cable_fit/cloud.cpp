#include "cloud.h"

#include <array>
#include <cmath>
#include <optional>

#include "common/messages.h"
#include "core/geometry/segment_geometry.h"
#include "scene/csv_rows.h"
#include "scene/text.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr const char* clouds_header = "t,x,y,z";
constexpr std::array<const char*, 4> clouds_columns{"t", "x", "y", "z"};
/// A fit looks at all of them hundreds of times.
constexpr std::size_t fewest_cloud_points = 2, most_cloud_points = 2'000'000;

class CloudsReader {
 public:
  explicit CloudsReader(std::istream& stream) : rows_(stream, clouds_header) {}

  Clouds read() {
    rows_.read([this](const CsvRows::Cells& cells) { add_row(cells); });
    if (count_ < fewest_cloud_points || count_ > most_cloud_points)
      throw SceneError({std::to_string(count_) + " points; allowed: " + std::to_string(fewest_cloud_points) + " to " +
                        std::to_string(most_cloud_points)});
    return std::move(clouds_);
  }

 private:
  void add_row(const CsvRows::Cells& cells) {
    const std::size_t errors_before = rows_.errors();
    std::array<double, clouds_columns.size()> numbers{};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::optional<double> number = parse_number(cells[i]);
      if (number && coordinate.contains(*number))
        numbers[i] = *number;
      else
        rows_.add_error(std::string(clouds_columns[i]) + " " + in_quotes(cells[i]), coordinate.text(i == 0 ? "s" : "m"));
    }
    if (rows_.errors() != errors_before) return;
    const double before = clouds_.times.empty() ? 0 : clouds_.times.back();
    if (numbers[0] < before)
      return rows_.add_error("t " + cells[0], clouds_.times.empty()
                                                  ? "times from 0, at which the motion begins"
                                                  : "times that do not descend, the last one is " + number_text(before));
    if (++count_ > most_cloud_points) return;
    if (clouds_.times.empty() || numbers[0] > before) {
      clouds_.times.push_back(numbers[0]);
      clouds_.points.emplace_back();
    }
    clouds_.points.back().emplace_back(numbers[1], numbers[2], numbers[3]);
  }

  CsvRows rows_;
  Clouds clouds_;
  std::size_t count_ = 0;
};

}  // namespace

std::size_t Clouds::point_count() const {
  std::size_t count = 0;
  for (const std::vector<Vector3>& cloud : points) count += cloud.size();
  return count;
}

Clouds read_clouds(const std::string& path, std::vector<std::string>& errors) {
  try {
    std::ifstream file = open_file(path);
    return CloudsReader(file).read();
  } catch (const SceneError& error) {
    for (const std::string& line : error.errors()) errors.push_back(tools::path_text(path) + ": " + line);
    return {};
  }
}

std::vector<double> distances_from_tube(const std::vector<Vector3>& points, const std::vector<Vector3>& nodes, double radius) {
  std::vector<double> distances;
  distances.reserve(points.size());
  for (const Vector3& point : points) {
    double squared = (point - nodes.front()).squaredNorm();
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const double fraction = closest_fraction(nodes[i], nodes[i + 1], point);
      squared = std::min(squared, (nodes[i] + fraction * (nodes[i + 1] - nodes[i]) - point).squaredNorm());
    }
    distances.push_back(std::sqrt(squared) - radius);
  }
  return distances;
}

}  // namespace verlet_cable::cable_fit
