#pragma once

#include <string>

namespace verlet_cable::cable_sim {

/// Draws with matplotlib, in a process of its own: src/python/verlet_cable/plot.py, which is part of this program.
class Painter {
 public:
  /// Looks for a python3 that has matplotlib, numpy and Pillow, as PATH has it or in /usr/bin. `needs_mp4`: and whether that
  /// finds ffmpeg.
  explicit Painter(bool needs_mp4);

  /// Why there is none, and what to do; empty if there is one.
  const std::string& problem() const { return problem_; }

  /// Likewise for MP4 files.
  const std::string& movie_problem() const { return movie_problem_; }

  struct Picture {
    std::string bytes;
    std::string problem;  ///< why there is none, empty if there is
  };
  /// `kind`: png, gif or mp4. `record`: of a PictureRecord.
  Picture draw(const std::string& kind, const std::string& record) const;

 private:
  std::string python_;  ///< path
  std::string problem_;
  std::string movie_problem_;
};

}  // namespace verlet_cable::cable_sim
