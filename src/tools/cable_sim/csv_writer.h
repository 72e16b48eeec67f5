#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/output_file.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_sim {

/// Writes `t,cable,node,x,y,z,vx,vy,vz,tension`, a row a node of cables and nets and
/// a row a particle; numbers that read back as the same doubles.
class CsvWriter {
 public:
  /// `file` is open and outlives this.
  explicit CsvWriter(tools::OutputFile& file);

  void write_nodes(const World& world);
  /// Hands the file what is not written yet.
  void flush();
  bool has_failed() const { return file_.has_failed(); }
  /// Where the disk became full, cuts the file after the last time that has all its rows. Returns what the error was, and until
  /// when the file goes; empty if there was none or not one time is whole.
  std::string keep_whole_times();

 private:
  void write_row(const std::string& start, std::size_t node, const Vector3& position, const Vector3& velocity, double tension);
  void append(double number);

  /// Where the rows of a time end.
  struct Whole {
    std::size_t size;  ///< [byte] of the file
    double time;
  };

  tools::OutputFile& file_;
  std::string buffer_;
  std::vector<Whole> whole_;  ///< the last one that is in the file, and those behind it
};

}  // namespace verlet_cable::cable_sim
