#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "verlet_cable/core/bytes.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What acts on a cable or body from a time on, until the next row of that name.
struct LoadRow {
  double time = 0;  ///< [s]
  std::string name;
  std::string on;                    ///< name of the cable or body
  int node = -1;                     ///< of a cable; -1: a body, at its center of mass
  Vector3 force = Vector3::Zero();   ///< [N] axes of the fixed frame
  Vector3 torque = Vector3::Zero();  ///< [N m] of a body, likewise
  std::size_t line = 0;              ///< of the file
};

/// Loads over time, ascending.
using Loads = std::vector<LoadRow>;

/// Reads a CSV file with the header `t,name,on,node,fx,fy,fz,tx,ty,tz` [s, N, N m]: loads in any order, times ascending per name,
/// at most ten million rows. Throws SceneError with all errors (at most 100), each with its line.
Loads read_loads_file(const std::string& path);

/// Errors, one line each with that of the file: rows on what the scene does not have, or on nodes that its cables do not have.
std::vector<std::string> validate_loads(const Loads& loads, const SceneDesc& scene);

/// A row that cannot be applied any more: its cable has become shorter.
struct RefusedLoad {
  std::string name, on, message;
};

/// Whether what starts at `start` acts in the step that begins at `time` and takes `time_step` [s].
bool is_due(double start, double time, double time_step);

/// Applies loads to a world as their times come. A value, as the world is.
class LoadPlayer {
 public:
  LoadPlayer() = default;
  explicit LoadPlayer(Loads loads) : loads_(std::make_shared<const Loads>(std::move(loads))) {}

  /// As one that was written. Throws std::invalid_argument where the bytes end too early.
  explicit LoadPlayer(ByteReader& bytes);
  void write(ByteWriter& bytes) const;
  LoadPlayer from_the_start() const;

  /// Those that act from the world's time on. Returns those of them that cannot be.
  std::vector<RefusedLoad> apply_due(World& world);

 private:
  std::shared_ptr<const Loads> loads_;  ///< none: there are none
  std::size_t next_ = 0;
};

}  // namespace verlet_cable
