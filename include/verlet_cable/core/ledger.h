#pragma once

#include <array>
#include <cstdint>
#include <utility>

namespace verlet_cable {

/// Where energy comes from and where it goes [J]. What is dissipated never is negative for long: a contact gives back what it
/// stores while it is pressed.
struct EnergyBalance {
  /// On cables and bodies, positive into them.
  struct Work {
    double attachments = 0;  ///< by what holds them: force times way, torque times turn of the wrenches that are published
    double winches = 0;      ///< by lengths that are driven; the energy of the material that they pay out is part of it
    double obstacles = 0;    ///< by obstacles that move
    double applied = 0;      ///< by loads from outside: wind, current, buoyancy, edits that add energy
    double total() const { return attachments + winches + obstacles + applied; }
  };
  struct Dissipated {
    double axial = 0, bending = 0, torsional = 0;  ///< by the damping of materials
    double drag = 0;                               ///< by what is at rest with the fluid
    double contact = 0;                            ///< between surfaces, friction included
    double guides = 0;                             ///< by friction in guides and bearings
    double bodies = 0;                             ///< by the damping of bodies
    double unresolved = 0;                         ///< motion that steps do not resolve
    double edits = 0;                              ///< by cuts, joins, pins, jumps, overstretched spans
    double total() const { return axial + bending + torsional + drag + contact + guides + bodies + unresolved + edits; }
  };
  Work work;
  Dissipated dissipated;

  double net() const { return work.total() - dissipated.total(); }
  EnergyBalance& operator+=(const EnergyBalance& other) {
    work.attachments += other.work.attachments;
    work.winches += other.work.winches;
    work.obstacles += other.work.obstacles;
    work.applied += other.work.applied;
    dissipated.axial += other.dissipated.axial;
    dissipated.bending += other.dissipated.bending;
    dissipated.torsional += other.dissipated.torsional;
    dissipated.drag += other.dissipated.drag;
    dissipated.contact += other.dissipated.contact;
    dissipated.guides += other.dissipated.guides;
    dissipated.bodies += other.dissipated.bodies;
    dissipated.unresolved += other.dissipated.unresolved;
    dissipated.edits += other.dissipated.edits;
    return *this;
  }
};

/// Names, as summaries and Python have them, and values [J].
/// @{
inline std::array<std::pair<const char*, double>, 4> entries(const EnergyBalance::Work& work) {
  return {
      {{"attachments", work.attachments}, {"winches", work.winches}, {"obstacles", work.obstacles}, {"applied", work.applied}}};
}
inline std::array<std::pair<const char*, double>, 9> entries(const EnergyBalance::Dissipated& lost) {
  return {{{"axial", lost.axial},
           {"bending", lost.bending},
           {"torsional", lost.torsional},
           {"drag", lost.drag},
           {"contact", lost.contact},
           {"guides", lost.guides},
           {"bodies", lost.bodies},
           {"unresolved", lost.unresolved},
           {"edits", lost.edits}}};
}
/// @}

/// Every joule of a world, from its start on.
struct Ledger {
  EnergyBalance balance;
  double change = 0;  ///< [J] of World::energy() since the start
  /// Steps of a group of cables and bodies that left more than a ten-thousandth of its kinetic energy, of the work in the step,
  /// and of its weight lifted by a segment unaccounted for.
  std::int64_t unaccounted_steps = 0;

  double unaccounted() const { return change - balance.net(); }  ///< [J] rounding, and what iterations leave
};

}  // namespace verlet_cable
