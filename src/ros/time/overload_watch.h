#pragma once

#include <optional>

#include "time/time_grid.h"

namespace verlet_cable {

/// Finds out whether the machine cannot keep up, from the time that the pacer leaves out. Knows no clock.
class OverloadWatch {
 public:
  struct Report {
    double real_time_factor;  ///< of the cables, over the last seconds
    double left_out;          ///< [s] in these
  };

  /// `target`: the time to be at; `left_out`: Pacer::left_out(); `wall`: wall time [s]. A report some seconds after an overload
  /// began, and every ten while it lasts.
  std::optional<Report> look(Nanoseconds target, Nanoseconds left_out, double wall);

 private:
  Nanoseconds target_ = 0;  ///< all three: when the present window began
  Nanoseconds left_out_ = 0;
  double wall_ = 0;
  bool overloaded_ = false;
};

}  // namespace verlet_cable
