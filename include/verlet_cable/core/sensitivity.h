#pragma once

#include <memory>
#include <string>
#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Derivatives of the state of a world's cables with respect to constants: found by implicit differentiation of the equations
/// that the steps have solved, not by differences. Beside the world, which goes on the same whether it has any or not.
///
/// Parameters:
///   KEY:CABLE    of a material's keys axial_stiffness, axial_damping, bending_stiffness, bending_damping, drag and
///                linear_density, in their units; of that cable alone, whichever share the material
///   length:CABLE [m] at rest, all segments growing alike
///   pose:FRAME   six columns: a translation of the frame along the axes of the fixed frame [m], and a rotation about its origin,
///                about these axes [rad]; the frame is displaced so all the time, however it moves
///   gravity      three columns [m/s^2]
///
/// For plain cables, each by itself: held by frames, straight unloaded, and alike about both axes. For others there are none.
class Sensitivity {
 public:
  /// What the state at the start is.
  enum class Start {
    given,   ///< the same whatever the parameters are; not for lengths and poses, with which it would not go together
    settled  ///< the equilibrium that it is at, which depends on them
  };
  /// What parameters there are, in words.
  static const char* const parameter_words;

  /// Throws std::invalid_argument, one line for each error.
  Sensitivity(const World& world, const std::vector<std::string>& parameters, Start start);
  Sensitivity(Sensitivity&&) noexcept;
  Sensitivity& operator=(Sensitivity&&) noexcept;
  ~Sensitivity();

  const std::vector<std::string>& parameters() const;
  int columns() const;  ///< of all parameters, in their order

  /// World::step of the world that it was made of; what is found of it is the same as of the step alone.
  StepResult step(World& world, const BoundaryInputs& inputs);
  /// Why there are no derivatives of a cable any longer, or none of the state that the world has now; empty if there are.
  std::string lost(const World& world, int cable) const;

  // Of cables that are not lost, one number a row and column, rows first. By their index: [m], [m/s] of nodes, three rows each;
  // [N] of segments; of an attachment: force [N] and torque [N m].
  void read_positions(const World& world, int cable, double* to) const;
  void read_velocities(const World& world, int cable, double* to) const;
  void read_tension(const World& world, int cable, double* to) const;
  void read_wrench(const World& world, int attachment, double* to) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace verlet_cable
