#include "binding/batch_arrays.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "binding/arguments.h"
#include "binding/text_arguments.h"

namespace verlet_cable {
namespace {

constexpr std::int64_t most_points = 100000;

std::string text_of_shape(const QuantityShape& shape) {
  return "(" + std::to_string(shape.rows) + (shape.columns > 0 ? ", " + std::to_string(shape.columns) + ")" : ",)");
}

/// `like`: what has that shape.
[[noreturn]] void refuse_odd_world(std::size_t world, Quantity quantity, const std::string& name, const QuantityShape& shape,
                                   const std::string& like) {
  const std::string index = std::to_string(world);
  throw py::value_error(std::string(name_of(quantity)) + " of " + name + ": world " + index + " has none of shape " +
                        text_of_shape(shape) + " as " + like + ": it was edited, or a cable broke, or slides through " +
                        "guides; allowed: quantities with the same shape in all worlds; missing=0.0, or another number in the "
                        "place of theirs; worlds[" +
                        index + "] has its own, and observations() reads points of cables with any number of nodes");
}

std::vector<std::size_t> sizes_of(const QuantityShape& shape, std::vector<std::size_t> first) {
  first.push_back(shape.rows);
  if (shape.columns > 0) first.push_back(shape.columns);
  return first;
}

py::array_t<double> recorded_array(const Record& record, std::size_t worlds, std::size_t records, std::optional<double> missing) {
  const auto changed = std::find(record.changed.begin(), record.changed.end(), 1);
  if (changed != record.changed.end() && !missing)
    refuse_odd_world(static_cast<std::size_t>(changed - record.changed.begin()) / records, record.quantity, record.name,
                     record.shape, "at first in every record");
  auto* owner = new std::shared_ptr<double>(record.numbers);
  const py::capsule capsule(owner, [](void* pointer) { delete static_cast<std::shared_ptr<double>*>(pointer); });
  const std::vector<std::size_t> sizes = sizes_of(record.shape, {worlds, records});
  if (changed == record.changed.end()) return read_only(py::array_t<double>(sizes, record.numbers.get(), capsule));
  py::array_t<double> array(sizes, record.numbers.get());
  const std::size_t size = record.shape.size();
  for (std::size_t i = 0; i < record.changed.size(); ++i)
    if (record.changed[i] != 0) std::fill_n(array.mutable_data() + i * size, size, *missing);
  return read_only(std::move(array));
}

void copy(const Batch& batch, const std::vector<Part>& parts, std::optional<double> missing, double* to) {
  std::optional<OddWorld> odd;
  {
    const py::gil_scoped_release release;
    odd = batch.copy(parts, missing, to);
  }
  if (!odd) return;
  const Part& part = parts[odd->part];
  refuse_odd_world(odd->world, part.quantity, part.name, part.shape, "world 0");
}

py::array_t<double> array_of_now(const Batch& batch, Quantity quantity, const std::string& name, std::optional<double> missing) {
  const QuantityShape shape = shape_of(batch[0].world(), quantity, name);
  py::array_t<double> array(sizes_of(shape, {batch.size()}));
  copy(batch, {{quantity, name, shape}}, missing, array.mutable_data());
  return read_only(std::move(array));
}

Part read_part(const World& world, const std::tuple<py::str, py::str>& given) {
  const auto& [quantity_name, name_text] = given;
  const std::string name = text_of(name_text, "parts");
  const Quantity quantity = read_quantities("parts", {quantity_name}).front();
  return {quantity, name, shape_of(world, quantity, name)};
}

Part read_part(const World& world, const std::tuple<py::str, py::str, std::int64_t>& given) {
  const auto& [quantity_name, name_text, points] = given;
  const Part nodes = read_part(world, {quantity_name, name_text});
  const std::string& name = nodes.name;
  if (find(world.cables(), name) < 0 || nodes.shape.columns != 3)
    throw py::value_error("parts: points of " + std::string(name_of(nodes.quantity)) + " of " + name +
                          "; allowed: points of positions and velocities of cables");
  if (points < 2 || points > most_points)
    throw py::value_error("parts: " + std::to_string(points) + " points of " + name + "; allowed: 2 to " +
                          std::to_string(most_points));
  return {nodes.quantity, name, {static_cast<std::size_t>(points), 3}, true};
}

/// ", positions, wrench"
std::string recorded_names(const Records& records) {
  std::string text;
  std::optional<Quantity> last;
  for (const Record& record : records.all()) {
    if (record.quantity == last) continue;
    text += std::string(last ? ", " : ": ") + name_of(record.quantity);
    last = record.quantity;
  }
  return text;
}

/// One number of each world.
template <class Number, class Read>
py::array_t<Number> array_of_numbers(const Batch& batch, const Read& read) {
  py::array_t<Number> array(static_cast<py::ssize_t>(batch.size()));
  for (std::size_t i = 0; i < batch.size(); ++i) array.mutable_data()[i] = read(i);
  return read_only(std::move(array));
}

}  // namespace

py::array_t<double> array_of(const Batch& batch, Quantity quantity, const std::string& name, std::optional<double> missing) {
  const Records* const records = batch.records();
  if (!records) return array_of_now(batch, quantity, name, missing);
  shape_of(batch[0].world(), quantity, name);  // throws for an unknown name
  const Record* record = records->find(quantity, name);
  if (!record)
    throw py::value_error(std::string(name_of(quantity)) + ": not recorded; allowed: what `fields` of the last step named" +
                          recorded_names(*records) + "; step(..., fields=['" + name_of(quantity) + "']) records it");
  return recorded_array(*record, batch.size(), records->count(), missing);
}

py::array_t<double> observations(const Batch& batch, const std::vector<GivenPart>& given, std::optional<double> missing) {
  std::vector<Part> parts;
  std::size_t row = 0;
  for (const GivenPart& one : given) {
    parts.push_back(std::visit([&](const auto& items) { return read_part(batch[0].world(), items); }, one));
    row += parts.back().shape.size();
  }
  py::array_t<double> array(std::vector<std::size_t>{batch.size(), row});
  copy(batch, parts, missing, array.mutable_data());
  return read_only(std::move(array));
}

py::array_t<double> times(const Batch& batch) {
  return array_of_numbers<double>(batch, [&](std::size_t i) { return batch[i].world().time(); });
}

py::array_t<std::int8_t> statuses(const Batch& batch) {
  return array_of_numbers<std::int8_t>(batch, [&](std::size_t i) { return static_cast<std::int8_t>(batch.status()[i]); });
}

py::dict energies(const Batch& batch) {
  std::vector<Energy> energies;
  for (std::size_t i = 0; i < batch.size(); ++i) energies.push_back(batch[i].world().energy());
  const auto all_of = [&](const auto& read) {
    return array_of_numbers<double>(batch, [&](std::size_t i) { return read(energies[i]); });
  };
  py::dict all;
  all["kinetic"] = all_of([](const Energy& energy) { return energy.kinetic; });
  all["gravity"] = all_of([](const Energy& energy) { return energy.gravity; });
  all["stretch"] = all_of([](const Energy& energy) { return energy.stretch; });
  all["bend"] = all_of([](const Energy& energy) { return energy.bend; });
  all["twist"] = all_of([](const Energy& energy) { return energy.twist; });
  all["total"] = all_of([](const Energy& energy) { return energy.total(); });
  return all;
}

std::vector<std::string> state_hashes(const Batch& batch) {
  std::vector<std::string> hashes;
  for (std::size_t i = 0; i < batch.size(); ++i) hashes.push_back(hash_text(batch[i].world().hash()));
  return hashes;
}

}  // namespace verlet_cable
