#include "binding/batch_arguments.h"

#include <algorithm>
#include <cstdint>

namespace verlet_cable {
namespace {

std::string indices_text(std::size_t count) {
  return "; allowed: -" + std::to_string(count) + " to " + std::to_string(count - 1);
}

/// Unsigned ones may be too large for what they are read as.
void check_unsigned(const py::array& integers, std::size_t count) {
  if (integers.dtype().kind() != 'u' || integers.size() == 0) return;
  const auto largest = integers.attr("max")().cast<std::uint64_t>();
  if (largest >= count) throw py::index_error("index: " + std::to_string(largest) + indices_text(count));
}

}  // namespace

std::vector<BendingStiffness> read_values(const std::string& name, const Numbers& numbers, std::size_t count) {
  const auto worlds = static_cast<py::ssize_t>(count);
  std::vector<BendingStiffness> values;
  if (numbers.ndim() == 0) {
    values.assign(count, BendingStiffness(*numbers.data()));
  } else if (numbers.ndim() == 1 && numbers.shape(0) == worlds) {
    for (py::ssize_t i = 0; i < worlds; ++i) values.emplace_back(numbers.at(i));
  } else if (name == "bending_stiffness" && numbers.ndim() == 2 && numbers.shape(0) == worlds && numbers.shape(1) == 2) {
    for (py::ssize_t i = 0; i < worlds; ++i) values.emplace_back(numbers.at(i, 0), numbers.at(i, 1));
  } else {
    throw py::value_error(name + ": shape " + shape_text(numbers) + "; allowed: (" + std::to_string(count) + ",)" +
                          (name == "bending_stiffness" ? ", (" + std::to_string(count) + ", 2)" : "") + " or a number");
  }
  return values;
}

std::vector<Pose> read_poses(const Numbers& poses, const Batch& batch) {
  const auto worlds = static_cast<py::ssize_t>(batch.size());
  const bool rollout = poses.ndim() == 3;
  if ((poses.ndim() != 2 && !rollout) || poses.shape(0) != worlds || poses.shape(poses.ndim() - 1) != 7 ||
      (rollout && poses.shape(1) == 0))
    throw py::value_error("poses: shape " + shape_text(poses) + "; allowed: (" + std::to_string(worlds) + ", 7) or (" +
                          std::to_string(worlds) + ", steps, 7)");
  const std::size_t steps = rollout ? static_cast<std::size_t>(poses.shape(1)) : 1;
  std::vector<Pose> read(batch.size() * steps);
  std::vector<char> is_sound(batch.size(), 1);
  const double* const numbers = poses.data();
  batch.share_out([&](std::size_t first, std::size_t last) {
    for (std::size_t i = first * steps; i < last * steps; ++i) {
      const std::optional<Pose> pose = sound_pose(numbers + 7 * i);
      if (pose)
        read[i] = *pose;
      else
        is_sound[i / steps] = 0;
    }
  });
  const auto wrong = static_cast<std::size_t>(std::find(is_sound.begin(), is_sound.end(), 0) - is_sound.begin());
  for (std::size_t k = 0; k < steps && wrong < batch.size(); ++k)
    read_pose(numbers + 7 * (wrong * steps + k),
              "poses[" + std::to_string(wrong) + (rollout ? ", " + std::to_string(k) : "") + "]");
  return read;
}

std::vector<Vector3> read_vectors(const char* name, const Numbers& numbers, std::size_t count) {
  const bool is_one = numbers.ndim() == 1 && numbers.shape(0) == 3;
  if (!is_one && (numbers.ndim() != 2 || numbers.shape(0) != static_cast<py::ssize_t>(count) || numbers.shape(1) != 3))
    throw py::value_error(std::string(name) + ": shape " + shape_text(numbers) + "; allowed: (" + std::to_string(count) +
                          ", 3), or (3,) for all");
  std::vector<Vector3> vectors(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double* v = numbers.data() + (is_one ? 0 : 3 * i);
    vectors[i] = {v[0], v[1], v[2]};
  }
  return vectors;
}

std::size_t read_world_index(std::int64_t index, std::size_t count) {
  const auto size = static_cast<std::int64_t>(count);
  if (index < -size || index >= size) throw py::index_error("index: " + std::to_string(index) + indices_text(count));
  return static_cast<std::size_t>(index < 0 ? index + size : index);
}

std::vector<std::size_t> read_world_indices(const py::object& index, std::size_t count) {
  const std::string allowed = "; allowed: an integer, a sequence of integers, or a bool mask (" + std::to_string(count) + ",)";
  const py::array given = py::array::ensure(index);
  if (!given) throw py::value_error("index: " + py::repr(index).cast<std::string>() + allowed);
  const char kind = given.dtype().kind();
  std::vector<std::size_t> indices;
  if (kind == 'b' && given.ndim() == 1 && given.shape(0) == static_cast<py::ssize_t>(count)) {
    const py::array_t<bool> mask(given);
    for (std::size_t i = 0; i < count; ++i)
      if (mask.at(i)) indices.push_back(i);
  } else if ((kind == 'i' || kind == 'u') && given.ndim() <= 1) {
    check_unsigned(given, count);
    const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> integers(given);
    for (py::ssize_t i = 0; i < integers.size(); ++i) indices.push_back(read_world_index(integers.data()[i], count));
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  } else if (given.ndim() != 1 || given.size() != 0 || kind == 'b') {
    throw py::value_error("index: shape " + shape_text(given) + " of " + py::str(given.dtype()).cast<std::string>() + allowed);
  }
  return indices;
}

}  // namespace verlet_cable
