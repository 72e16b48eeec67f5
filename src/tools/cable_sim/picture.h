#pragma once

#include <string>

namespace verlet_cable::cable_sim {

/// Draws with matplotlib, in a process of its own: src/python/verlet_cable/plot.py, which is part of this program.
class Painter {
 public:
  /// Looks for a python3 that has matplotlib, numpy and Pillow, as PATH has it or in /usr/bin.
  Painter();

  /// Why there is none, and what to do; empty if there is one.
  const std::string& problem() const { return problem_; }

  struct Picture {
    std::string bytes;
    std::string problem;  ///< why there is none, empty if there is
  };
  /// `kind`: png or gif. `record`: of a PictureRecord.
  Picture draw(const std::string& kind, const std::string& record) const;

 private:
  std::string python_;  ///< path
  std::string problem_;
};

}  // namespace verlet_cable::cable_sim
