#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "csv_rows.h"
#include "text.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/scene/loads.h"

namespace verlet_cable {
namespace {

constexpr const char* header = "t,name,on,node,fx,fy,fz,tx,ty,tz";
constexpr std::array<const char*, 10> columns{"t", "name", "on", "node", "fx", "fy", "fz", "tx", "ty", "tz"};
constexpr std::size_t name_column = 1, on_column = 2, node_column = 3, force_column = 4, torque_column = 7;

class LoadsReader {
 public:
  explicit LoadsReader(std::istream& stream) : rows_(stream, header) {}

  Loads read() {
    rows_.read([this](const CsvRows::Cells& cells) { add_row(cells); });
    std::stable_sort(loads_.begin(), loads_.end(), [](const LoadRow& a, const LoadRow& b) { return a.time < b.time; });
    return std::move(loads_);
  }

 private:
  double read_number(const CsvRows::Cells& cells, std::size_t column, const Range& range, const char* unit) {
    const std::optional<double> number = parse_number(cells[column]);
    if (number && range.contains(*number)) return *number;
    rows_.add_error(std::string(columns[column]) + " " + in_quotes(cells[column]), range.text(unit));
    return 0;
  }

  Vector3 read_vector(const CsvRows::Cells& cells, std::size_t column, const char* unit) {
    Vector3 vector;
    for (std::size_t axis = 0; axis < 3; ++axis) vector[axis] = read_number(cells, column + axis, applied_load, unit);
    return vector;
  }

  int read_node(const std::string& cell) {
    const std::optional<double> node = parse_number(cell);
    if (node && *node >= -1 && *node <= largest_integer && *node == std::floor(*node)) return static_cast<int>(*node);
    rows_.add_error("node " + in_quotes(cell), "a node's number from 0 on, or -1 for a body");
    return -1;
  }

  void add_row(const CsvRows::Cells& cells) {
    const std::size_t errors_before = rows_.errors();
    LoadRow row;
    row.line = rows_.line();
    row.time = read_number(cells, 0, coordinate, "s");
    row.name = cells[name_column];
    if (!is_name(row.name)) rows_.add_error("name " + in_quotes(row.name), name_words);
    row.on = cells[on_column];
    row.node = read_node(cells[node_column]);
    row.force = read_vector(cells, force_column, "N");
    row.torque = read_vector(cells, torque_column, "N m");
    if (rows_.errors() != errors_before) return;
    if (row.node >= 0 && !row.torque.isZero(0))
      return rows_.add_error("tx, ty, tz " + cells[torque_column] + ", " + cells[torque_column + 1] + ", " +
                                 cells[torque_column + 2] + " on node " + cells[node_column],
                             "0, a node takes a force only");
    const auto [last, is_new] = last_times_.emplace(row.name, row.time);
    if (!is_new && row.time <= last->second)
      return rows_.add_error("t " + cells[0] + " of " + in_quotes(row.name),
                             "times that ascend, the load's last one is " + number_text(last->second));
    last->second = row.time;
    loads_.push_back(std::move(row));
  }

  CsvRows rows_;
  Loads loads_;
  std::map<std::string, double> last_times_;  // [s] by name
};

}  // namespace

Loads read_loads_file(const std::string& path) {
  std::ifstream file = open_file(path);
  return LoadsReader(file).read();
}

}  // namespace verlet_cable
