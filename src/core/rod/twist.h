#pragma once

#include <vector>

#include "geometry/vector_array.h"
#include "law/resistance.h"
#include "rod/series.h"
#include "target/boundary.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

/// A piece of cable between two clamps. Twist spreads along it at the speed of sound: its torque is taken to be the same
/// everywhere.
struct TwistSpan {
  int first_holder = 0, last_holder = 0;  ///< indices into Boundary::directions
  int first_node = 0, last_node = 0;
  double angle = 0;   ///< [rad] by which the material is twisted, any number of turns
  double origin = 0;  ///< [rad] roll of the last clamp against the first one's, carried along the cable, that would be no twist
  int age = 0;        ///< substeps since the angle was measured; in between its changes are added up
};

/// [N m^2] GJ of a segment of a cable of several materials: what does not resist bending gives way to any torque.
double torsional_stiffness_at(const CableMaterials& materials, int segment);
/// How the segments from node `first` to node `last` resist twist together.
Series torsion_of(const CableMaterials& materials, const CableState& state, int first, int last);
/// What part of the twist of those in `series` is in a segment.
double twist_share(const Series& series, const CableMaterials& materials, const CableState& state, int segment);

/// Sets the twist of the segments: none outside the spans.
void spread_twist(const CableModel& model, const std::vector<TwistSpan>& spans, CableState& state);

/// Roll of one clamp's orientation against another's that is carried along segments without twist [rad]: `nodes`: positions of
/// the nodes between them.
double relative_roll(const Quaternion& first, const Quaternion& last, const Vector3* nodes, int count);

/// Measures the angles of the spans from the rolls of their clamps, each the one nearest to the angle it had.
void measure_twist(const std::vector<HeldDirection>& directions, const std::vector<Vector3>& positions,
                   std::vector<TwistSpan>& spans);

/// The spans between neighbouring held directions, as twisted as the cable is there now; none of a whole rod.
std::vector<TwistSpan> find_spans(const CableState& state, const std::vector<HeldDirection>& directions);

/// Twist and its forces on the centre line over a substep. Energy GJ angle² / (2 length); the angle depends on the centre line
/// through the holonomy of its directions (Bergou et al., Discrete Elastic Rods, 2008, eq. 9: curvature binormals).
class Twist {
 public:
  void resize(int segments);
  void start(const CableModel& model, const CableState& state, const std::vector<TwistSpan>& spans, double h, double part);
  bool active() const { return spans_ != nullptr; }
  /// Adds the forces of the segments on their first nodes [N]. `middle`: the segments where forces are taken, `displacement` of
  /// nodes [m].
  void add_segment_forces(const VectorArray& middle, const VectorArray& displacement, const Boundary& boundary,
                          VectorArray& pull);
  /// Adds the substep's changes to the angles; measures them now and then.
  void follow(const std::vector<HeldDirection>& directions, const std::vector<Vector3>& positions,
              std::vector<TwistSpan>& spans) const;
  /// What damping takes from the energy [J].
  double damping_work() const;
  /// Adds the torques on the holders [N m] to their `torque`.
  void react(Boundary& boundary) const;

 private:
  struct SpanState {
    double torque = 0;  ///< [N m]
    double change = 0;  ///< [rad] of the angle over the substep
    Vector3 first_axis, last_axis, first_binormal, last_binormal;
  };

  void set_tangents(const VectorArray& middle, const TwistSpan& span);
  void set_binormals(const TwistSpan& span, const SpanState& state);
  double add_slopes(const VectorArray& displacement, const TwistSpan& span, std::vector<double> VectorArray::*component);

  const std::vector<TwistSpan>* spans_ = nullptr;
  std::vector<SpanState> states_;
  std::vector<Resistance<double>> resistances_;  // of spans
  double part_ = 0.5;
  VectorArray tangent_;   // segments
  VectorArray slope_;     // segments: derivative of the angle [rad/m]
  VectorArray binormal_;  // nodes: curvature binormal
  std::vector<double> inverse_length_;
};

}  // namespace verlet_cable
