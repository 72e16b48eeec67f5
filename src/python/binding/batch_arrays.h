#pragma once

#include <string>
#include <utility>
#include <vector>

#include "binding/arguments.h"
#include "simulation/batch.h"

namespace verlet_cable {

/// A quantity of all worlds, with an axis of records where the last step recorded. Throws UnknownName, ValueError.
py::array_t<double> array_of(const Batch& batch, Quantity quantity, const std::string& name);

/// (count, k): of each world the numbers of all these quantities and names, one after the other. Throws UnknownName, ValueError.
py::array_t<double> observations(const Batch& batch, const std::vector<std::pair<std::string, std::string>>& parts);

/// (count,)
py::array_t<double> times(const Batch& batch);
py::array_t<std::int8_t> statuses(const Batch& batch);
py::dict energies(const Batch& batch);
std::vector<std::string> state_hashes(const Batch& batch);

}  // namespace verlet_cable
