#pragma once

#include <optional>
#include <string>
#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_sim {

/// Why no such directory can be written, or made; empty if it seems that it can.
std::string why_no_directory(const std::string& path);
/// An error for `why_no_directory`'s answer: with the path, and what is allowed.
std::string cannot_write_directory(const std::string& path, const std::string& why);

/// Whether a file of a name is one that a VtkWriter may write into its directory.
bool is_vtk_name(const std::string& name);

/// A run as files of VTK's XML format (polygonal data) in a directory: cables_NNNN.vtp for each time, likewise bodies and
/// obstacles where there are any, and cables.pvd, bodies.pvd and obstacles.pvd, which say when each is. Those that an earlier run
/// has left, and this one has not, are removed.
class VtkWriter {
 public:
  /// Makes the directory if it is not there; then see `problem`.
  VtkWriter(const World& world, const std::string& directory);

  /// Writes what there is now. Does nothing after an error.
  void add(const World& world);
  /// Writes which file is when.
  void finish();
  /// What could not be written, and why; empty if nothing.
  const std::string& problem() const { return problem_; }

 private:
  /// Files of one kind.
  struct Series {
    const char* name;
    std::string index{};  ///< the lines of its .pvd file
  };

  /// No content: there is nothing of that kind now.
  void add_file(const World& world, Series& series, const std::optional<std::string>& content);
  bool remove(const std::string& name) const;
  void write(const std::string& name, const std::string& text);

  std::string directory_;
  double plane_reach_;
  std::size_t times_ = 0;
  Series cables_{"cables"}, bodies_{"bodies"}, obstacles_{"obstacles"};
  std::string problem_;
};

}  // namespace verlet_cable::cable_sim
