#pragma once

#include <string>

#include "output_file.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_sim {

/// Writes `t,cable,node,x,y,z,vx,vy,vz,tension`, a row a node; numbers that read back as the same doubles.
class CsvWriter {
 public:
  /// `file` is started and outlives this.
  explicit CsvWriter(OutputFile& file);

  void write_nodes(const World& world);
  /// Hands the file what is not written yet.
  void flush();

 private:
  void append(double number);

  OutputFile& file_;
  std::string buffer_;
};

}  // namespace verlet_cable::cable_sim
