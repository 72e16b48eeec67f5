#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/output_file.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_sim {

/// Rows over time; numbers that read back as the same doubles.
class CsvWriter {
 public:
  /// `file` is open and outlives this. `header`: the names of the columns, with commas between.
  CsvWriter(tools::OutputFile& file, const std::string& header);

  void begin_row(const std::string& start) { buffer_ += start; }
  void append(double number);
  template <class Numbers>
  void append_all(const Numbers& numbers) {
    for (const double number : numbers) append(number);
  }
  void end_row();
  /// All rows of that time are there.
  void end_time(double time);
  /// Hands the file what is not written yet.
  void flush();
  bool has_failed() const { return file_.has_failed(); }
  /// Where the disk became full, cuts the file after the last time that has all its rows. Returns what the error was, and until
  /// when the file goes; empty if there was none or not one time is whole.
  std::string keep_whole_times();

 private:
  /// Where the rows of a time end.
  struct Whole {
    std::size_t size;  ///< [byte] of the file
    double time;
  };

  tools::OutputFile& file_;
  std::string buffer_;
  std::vector<Whole> whole_;  ///< the last one that is in the file, and those behind it
};

constexpr const char* node_columns = "t,cable,node,x,y,z,vx,vy,vz,tension";
constexpr const char* body_columns = "t,body,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz";

/// A row a node of cables and nets and a row a particle.
void write_nodes(const World& world, CsvWriter& csv);
/// A row a body.
void write_bodies(const World& world, CsvWriter& csv);

}  // namespace verlet_cable::cable_sim
