#pragma once

#include <array>
#include <string>
#include <vector>

#include "sensitivity/parameter.h"
#include "sensitivity/plain_equations.h"
#include "world/state.h"

namespace verlet_cable {

/// Derivatives of one cable's state with respect to constants, carried from step to step. What a step has done is retraced from
/// the state before it, with the solution that it has found; where that does not lead to the state after it, the derivatives
/// would not be its own, and are lost.
class CableSensitivity {
 public:
  /// Of a state that does not depend on them.
  CableSensitivity(int cable, const State& state, const std::vector<SensitivityColumn>& columns);

  int cable() const { return cable_; }
  /// Why there are no derivatives of this cable; empty if there are.
  static std::string unsupported(int cable, const State& state);
  /// Takes the state for the equilibrium that depends on the constants. Returns why it is none, else nothing.
  std::string settle(const State& state);
  /// Why derivatives are not those of the state: it is not as the last step has left it. Else nothing.
  std::string changed(const State& state) const;
  /// Takes over the state before a step; returns why derivatives are lost, else nothing.
  std::string begin_step(const State& state);
  /// The state after it.
  std::string end_step(const State& state);

  // One number a row and column, rows first
  void read_positions(double* to) const;
  void read_velocities(double* to) const;
  void read_tension(double* to) const;
  /// Of an attachment of this cable: force and torque.
  void read_wrench(int attachment, double* to) const;

 private:
  struct Wrench {
    int attachment = 0;
    ColumnVector force, torque;
  };
  /// So many columns.
  struct Columns {
    std::vector<SensitivityColumn> parameters;  ///< up to columns_at_once
    std::vector<ColumnVector> positions, velocities, accelerations, changes, turns;
    std::vector<Column> multipliers, last_tensions, tensions;
    std::vector<ColumnVector> holder_velocities, holder_means;  ///< one a held node
    std::vector<Wrench> wrenches;
    PlainEquations equations;
  };
  /// What a cable is made of.
  struct Numbers {
    std::vector<Column> rest_lengths, masses;
    Column axial_stiffness, axial_damping, bending_stiffness, bending_damping, drag;
    ColumnVector gravity, wind;
  };

  // cable_constants.cpp
  template <class Change>
  void each_column(const Columns& columns, SensitivityColumn::Kind kind, const Change& change) const;
  Numbers numbers_of(const Columns& columns, const State& state) const;
  ColumnVector wanted_place(const Columns& columns, const State& state, const KinematicTarget& target,
                            const Vector3& place) const;
  ColumnVector wanted_axis(const Columns& columns, const State& state, const DirectionTarget& target,
                           const Quaternion& orientation) const;
  static bool is_finite(const Columns& columns);
  void take_values(const CableState& state, Columns& columns) const;
  void set_equations(const State& state, const Numbers& numbers, const KinematicTargets& targets, double h, bool is_static,
                     Columns& columns) const;
  void set_clamps(const State& state, const Numbers& numbers, const KinematicTargets& targets, double h, bool is_static,
                  Columns& columns) const;
  void set_spin(const Numbers& numbers, double h, Columns& columns) const;
  // cable_step.cpp
  /// That is retraced.
  struct Step {
    const State& state;  ///< after it
    Numbers numbers;
    double h = 0;  ///< [s]
    int segments = 0;
    std::vector<ColumnVector> wanted = {}, means = {};  ///< holders: places at the end [m], mean velocities [m/s]
    std::vector<Column> mobility = {};                  ///< nodes [1/kg]; 0 where held
    std::vector<ColumnVector> velocities = {};          ///< nodes, at the end [m/s]
    std::vector<ColumnVector> ends = {};                ///< segments, at the end [m]
    std::vector<ColumnVector> forces = {};              ///< nodes: on their holders [N]
  };
  std::string follow(const State& state, Columns& first, Columns& columns);
  std::string follow_holders(Columns& columns, Step& step) const;
  void start_with_holders(Columns& columns, const Step& step) const;
  std::string find_solution(Columns& first, Columns& columns, const Step& step) const;
  void find_velocities(const Columns& columns, Step& step) const;
  void project(const Columns& columns, Step& step) const;
  bool advance(Columns& columns, const Step& step) const;
  std::string clean(const Numbers& numbers, const std::vector<Column>& start_multipliers, double h,
                    std::vector<ColumnVector>& forces, Columns& columns) const;
  void set_wrenches(const State& state, const std::vector<ColumnVector>& forces, const KinematicTargets& targets,
                    Columns& columns) const;
  template <class Number>
  void read(int rows, const Number& number, double* to) const;

  int cable_;
  std::vector<Columns> columns_;
  // After the last step, or before that which is done
  SimulatedCable before_;
  KinematicTargets targets_;
  std::shared_ptr<const SceneDesc> scene_;
};

}  // namespace verlet_cable
