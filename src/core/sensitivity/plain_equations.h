#pragma once

#include <vector>

#include "sensitivity/band_matrix.h"
#include "sensitivity/plain_elements.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// So many derivatives are found at once.
constexpr int columns_at_once = 8;
using Column = Dual<columns_at_once>;
using ColumnVector = VectorOf<Column>;

/// A vector's numbers, of which the derivatives stay.
inline void set_values(const Vector3& from, ColumnVector& to) {
  to.x.value = from.x();
  to.y.value = from.y();
  to.z.value = from.z();
}
inline Vector3 values_of(const ColumnVector& v) {
  return {v.x.value, v.y.value, v.z.value};
}
inline ColumnVector constant(const Vector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// Unknowns of a node: its place, and the density of the segment after it.
constexpr int unknowns_a_node = 4;
constexpr int density_place = 3;
/// By so many unknowns what a joint couples may be apart: a node and the one after the next.
constexpr int coupling_reach = 2 * unknowns_a_node + 2;

/// How much of what turns with the material is not damped, see BendDamping: none, some or all of it.
enum class TurnedShare { none, some, all };

/// The equations of a substep of a plain cable, or of its equilibrium, and their derivatives with respect to constants
/// (as columns) and to what they are solved for (the matrix). Written for the solution that the simulation has found: solves
///   equations(unknowns; constants) = 0
/// for the derivatives of the unknowns by the constants alone.
class PlainEquations {
 public:
  // To be set
  bool is_static = false;           ///< what is found are places where nothing moves, not displacements in a substep
  double part = 0.5;                ///< where in the substep forces are taken
  std::vector<char> movable;        ///< nodes
  std::vector<char> fixed_density;  ///< segments between two held nodes: their tension is not found
  std::vector<PlainSegment<Column>> segments;
  std::vector<PlainJoint<Column>> joints;  ///< nodes; without stiffness at ends and clamps
  std::vector<PlainClamp<Column>> clamps;
  std::vector<Column> inertia;      ///< nodes [kg/s^2]
  std::vector<ColumnVector> load;   ///< nodes: what no displacement changes [N]
  std::vector<ColumnVector> start;  ///< segments: d at the start [m]
  bool is_damped = false;           ///< bending is
  // The solution: numbers as the simulation has found them; derivatives of what is held as given, of the others out
  std::vector<ColumnVector> displacement;  ///< nodes [m]
  std::vector<Column> density;             ///< segments: 2 T / (s + s') [N/m]
  // Of the solution
  std::vector<ColumnVector> force;  ///< segments: on their first nodes [N]
  std::vector<Column> force_along;  ///< segments: of bending [N]
  std::vector<Column> mean_length;  ///< segments: which the density is multiplied with to give the tension [m]
  std::vector<ClampBend<Column>> clamp_bends;

  int nodes() const { return static_cast<int>(inertia.size()); }
  ColumnVector change_of(int segment) const { return displacement[segment + 1] - displacement[segment]; }
  /// Forces and rows of the present solution.
  void evaluate();
  /// The matrix, from the numbers of the present solution. False if it is singular.
  bool factor();
  /// After `evaluate`. Adds the derivatives that are found to those of displacements and densities; forces are then those of the
  /// solution, but in statics. Returns the largest correction that the numbers would need [m]; they stay. `factored`: has the
  /// matrix; equations that differ in the derivatives of their constants only.
  double solve(PlainEquations& factored);
  /// [m], [N/m] By which the numbers are to be corrected: of the last `solve`.
  const std::vector<Vector3>& correction() const { return correction_; }
  const std::vector<double>& density_correction() const { return density_correction_; }
  /// Of the loads on nodes, that nothing but holders bears [N].
  const std::vector<ColumnVector>& residual() const { return residual_; }

 private:
  void find_share();
  void assemble();

  BandMatrix matrix_;
  /// By the share that turns with the material, of the loads; and the square that it is relative to. Empty unless some of it is.
  struct Turned {
    std::vector<double> load, solution;
    double square = 0;
  };
  Turned turned_;
  TurnedShare mode_ = TurnedShare::none;
  Column share_, turned_square_;
  std::vector<ColumnVector> residual_;
  std::vector<Column> gap_;
  std::vector<Vector3> correction_;
  std::vector<double> density_correction_;
  std::vector<double> right_;
};

}  // namespace verlet_cable
