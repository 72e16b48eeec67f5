#pragma once

#include <array>
#include <vector>

#include "rod/block_elimination.h"
#include "target/boundary.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// The bending of a cable over a substep: moments between neighbouring segments, averaged so that energy and momentum are
/// conserved.
///
/// With e = d_i / l_i - d_(i-1) / l_(i-1), the change of direction at node i, and u = |e|² / 2 = 1 - cos(angle), the energy of a
/// node is
///   EI / l psi(u),   psi = angle² / 2 = u + u² / 6 + 2 u³ / 45 + u⁴ / 70 + ...
/// To first order in u it is quadratic (Bergou et al., A Quadratic Bending Model for Inextensible Surfaces, 2006); the higher
/// ones make the moment proportional to the angle. At a clamp the frame's axis stands for one of the two directions, half a
/// segment away.
class Bending {
 public:
  void resize(int segments);
  /// `segment`: the segments at the start of the substep [m]; `part`: where in the substep forces are taken, 1/2 or 1.
  void start(const CableModel& model, const CableState& state, const VectorArray& segment,
             const std::vector<HeldDirection>& directions, double h, double part);
  /// Takes the unloaded shape's directions from the material's: `middle`: segments [m], `director`: the material's y axis on
  /// each.
  void set_natural_shape(const CableState& state, const VectorArray& middle, const VectorArray& director);
  bool active() const { return active_; }
  /// Adds the forces of the segments on their first nodes [N], for displacements of the nodes [m].
  void add_segment_forces(const VectorArray& displacement, VectorArray& pull);
  /// Adds what `add_segment_forces` found last to the matrix.
  void add_stiffness(KktSystem& system) const;
  /// Adds the moments on the holders of directions [N m] to their `torque`.
  void react(const VectorArray& displacement, std::vector<HeldDirection>& directions);

 private:
  struct ClampJoint {
    int target = 0;   ///< index of the held direction
    int segment = 0;  ///< the segment next to the clamp
    double side = 1;  ///< 1: that after the clamp; -1: that before it
    double stiffness = 0, damping = 0;
    Vector3 start = Vector3::Zero(), axis_change = Vector3::Zero(), middle_axis = Vector3::Zero();
    double start_square = 0;
    Vector3 natural = Vector3::Zero();
    Vector3 moment = Vector3::Zero();  ///< force times length, on the side's direction
    double slope = 0;
  };

  void bend_clamps(const VectorArray& displacement);

  bool active_ = false;
  bool is_curved_ = false;  ///< `natural_` is set
  int segments_ = 0;
  double part_ = 0.5;
  std::vector<double> inverse_length_;       // segments [1/m]
  std::vector<double> stiffness_, damping_;  // nodes: EI / l and damping / (l h) [N m]; 0 at ends and clamps
  VectorArray start_, natural_;              // nodes: e at the start, and of the unloaded shape
  std::vector<double> start_square_;         // nodes: |e|² at the start
  VectorArray change_, moment_;              // nodes: change of e; moment along it [N m]
  std::vector<double> end_square_, slope_;   // nodes: |e|² at the end; d moment / d e at the end [N m]
  std::vector<ClampJoint> clamps_;
};

/// Change of direction of the unloaded shape over a length of cable [m]: curvature about the material's y and z axes, seen from
/// the segment with direction `segment` and y axis `director`.
inline Vector3 natural_change(const std::array<double, 2>& curvature, double length, const Vector3& segment,
                              const Vector3& director) {
  return length * (curvature[1] * director - curvature[0] * segment.normalized().cross(director));
}

/// [J], `directions` at their ends.
double bending_energy(const CableModel& model, const CableState& state, const std::vector<HeldDirection>& directions);

}  // namespace verlet_cable
