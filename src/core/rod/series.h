#pragma once

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// Lengths of cable one after the other that one moment bends, or one torque twists: springs in series, each with a damper beside
/// it. Angles are as in equilibrium, in proportion to length over stiffness; damping then takes the energy that the dampers of
/// the lengths take together. Of what resists nothing all of the angle is where the least resists.
class Series {
 public:
  /// `length` [m]; `stiffness` [N m^2]: EI or GJ; `damping` [N m^2 s].
  void add(double length, double stiffness, double damping) {
    if (stiffness > 0) {
      compliance_ += length / stiffness;
      dissipation_ += damping * length / (stiffness * stiffness);
    } else if (damping > 0) {
      fluidity_ += length / damping;
    } else {
      free_length_ += length;
    }
  }

  /// [N m] Of the whole angle.
  double stiffness() const { return fluidity_ > 0 || free_length_ > 0 ? 0 : 1 / compliance_; }
  double damping() const {  ///< [N m s]
    if (free_length_ > 0) return 0;
    return fluidity_ > 0 ? 1 / fluidity_ : dissipation_ / (compliance_ * compliance_);
  }
  /// What part of the angle is in a length that was added.
  double share(double length, double stiffness, double damping) const {
    if (free_length_ > 0) return stiffness > 0 || damping > 0 ? 0 : length / free_length_;
    if (fluidity_ > 0) return stiffness > 0 ? 0 : length / damping / fluidity_;
    return length / stiffness / compliance_;
  }

 private:
  double compliance_ = 0;   // of springs [1/(N m)]
  double dissipation_ = 0;  // of the dampers beside them, for one N m
  double fluidity_ = 0;     // of dampers without springs [1/(N m s)]
  double free_length_ = 0;  // [m]
};

}  // namespace verlet_cable
