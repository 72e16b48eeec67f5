#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "binding/arguments.h"
#include "simulation/batch.h"

namespace verlet_cable {

/// A quantity of all worlds, with an axis of records where the last step recorded. `missing`: the numbers of worlds that have it
/// in another shape than the first one. Throws UnknownName; without `missing`, ValueError.
py::array_t<double> array_of(const Batch& batch, Quantity quantity, const std::string& name, std::optional<double> missing);

/// A quantity and a name; and how many points of a cable, where it is not its nodes.
using GivenPart = std::variant<std::tuple<py::str, py::str>, std::tuple<py::str, py::str, std::int64_t>>;

/// (count, k): of each world the numbers of all parts, one after the other. Throws UnknownName, ValueError.
py::array_t<double> observations(const Batch& batch, const std::vector<GivenPart>& parts, std::optional<double> missing);

/// (count,)
py::array_t<double> times(const Batch& batch);
py::array_t<std::int8_t> statuses(const Batch& batch);
py::dict energies(const Batch& batch);
std::vector<std::string> state_hashes(const Batch& batch);

}  // namespace verlet_cable
