#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "binding/arguments.h"
#include "simulation/batch.h"

namespace verlet_cable {

/// A number for all worlds, one a world, or of a stiffness two a world. Throws ValueError.
std::vector<BendingStiffness> read_values(const std::string& name, const Numbers& numbers, std::size_t count);

/// Poses of world after world, (count, 7) or (count, steps, 7), read on the batch's threads. Throws ValueError.
std::vector<Pose> read_poses(const Numbers& poses, const Batch& batch);

/// A vector a world, (count, 3), or one for all, (3,). Throws ValueError.
std::vector<Vector3> read_vectors(const char* name, const Numbers& numbers, std::size_t count);

/// The index of a world, from the end where it is negative. Throws IndexError.
std::size_t read_world_index(std::int64_t index, std::size_t count);

/// Which worlds are meant, each once, ascending: an integer, a sequence of them, or a mask (count,). Throws IndexError,
/// ValueError.
std::vector<std::size_t> read_world_indices(const py::object& index, std::size_t count);

}  // namespace verlet_cable
