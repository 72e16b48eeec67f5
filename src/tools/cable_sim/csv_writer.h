#pragma once

#include <cstddef>
#include <string>

#include "output_file.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_sim {

/// Writes `t,cable,node,x,y,z,vx,vy,vz,tension`, a row a node of cables and nets and
/// a row a particle; numbers that read back as the same doubles.
class CsvWriter {
 public:
  /// `file` is started and outlives this.
  explicit CsvWriter(OutputFile& file);

  void write_nodes(const World& world);
  /// Hands the file what is not written yet.
  void flush();

 private:
  void write_row(const std::string& start, std::size_t node, const Vector3& position, const Vector3& velocity, double tension);
  void append(double number);

  OutputFile& file_;
  std::string buffer_;
};

}  // namespace verlet_cable::cable_sim
