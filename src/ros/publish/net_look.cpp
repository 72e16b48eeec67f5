#include "publish/net_look.h"

namespace verlet_cable {
namespace {

constexpr double width_to_length = 0.04;      // of a link
constexpr double length_without_links = 0.1;  // [m]

}  // namespace

double link_length(const NetModel& model) {
  return model.rest_lengths.empty() ? length_without_links : model.rest_lengths.front();
}

double link_width(const NetModel& model) {
  return width_to_length * link_length(model);
}

std::vector<std::array<int, 3>> triangles_of(const NetModel& model) {
  std::vector<std::array<int, 3>> triangles;
  for (int row = 0; row + 1 < model.rows; ++row)
    for (int column = 0; column + 1 < model.columns; ++column) {
      const int a = row * model.columns + column, b = a + 1, c = a + model.columns, d = c + 1;
      triangles.push_back({a, c, b});
      triangles.push_back({b, c, d});
    }
  return triangles;
}

}  // namespace verlet_cable
