#pragma once

#include <array>
#include <cstdint>

namespace verlet_cable {

/// A field of a part of a balance: its name, as summaries and Python have it, and where it is [J].
template <class Part>
struct BalanceField {
  const char* name;
  double Part::*place;
};

/// Where energy comes from and where it goes [J]. What is dissipated never is negative for long: a contact gives back what it
/// stores while it is pressed.
struct EnergyBalance {
  /// On cables and bodies, positive into them.
  struct Work {
    double attachments = 0;  ///< by what holds them: force times way, torque times turn of the wrenches that are published
    double winches = 0;      ///< by lengths that are driven; the energy of the material that they pay out is part of it
    double obstacles = 0;    ///< by obstacles that move
    double applied = 0;      ///< by loads from outside: wind, current, buoyancy, edits that add energy

    static constexpr std::array<BalanceField<Work>, 4> fields{{{"attachments", &Work::attachments},
                                                               {"winches", &Work::winches},
                                                               {"obstacles", &Work::obstacles},
                                                               {"applied", &Work::applied}}};
    double total() const { return sum(*this); }
  };
  struct Dissipated {
    double axial = 0, bending = 0, torsional = 0;  ///< by the damping of materials
    double yielding = 0;                           ///< by bending that stays, and friction between strands as they bend
    double drag = 0;                               ///< by what is at rest with the fluid
    double contact = 0;                            ///< between surfaces, friction included
    double guides = 0;                             ///< by friction in guides and bearings
    double bodies = 0;                             ///< by the damping of bodies
    double unresolved = 0;                         ///< motion that steps do not resolve
    double edits = 0;                              ///< by cuts, joins, pins, jumps, overstretched spans

    static constexpr std::array<BalanceField<Dissipated>, 10> fields{{{"axial", &Dissipated::axial},
                                                                      {"bending", &Dissipated::bending},
                                                                      {"torsional", &Dissipated::torsional},
                                                                      {"yielding", &Dissipated::yielding},
                                                                      {"drag", &Dissipated::drag},
                                                                      {"contact", &Dissipated::contact},
                                                                      {"guides", &Dissipated::guides},
                                                                      {"bodies", &Dissipated::bodies},
                                                                      {"unresolved", &Dissipated::unresolved},
                                                                      {"edits", &Dissipated::edits}}};
    double total() const { return sum(*this); }
  };
  Work work;
  Dissipated dissipated;

  double net() const { return work.total() - dissipated.total(); }
  EnergyBalance& operator+=(const EnergyBalance& other) {
    add(other.work, work);
    add(other.dissipated, dissipated);
    return *this;
  }

 private:
  template <class Part>
  static double sum(const Part& part) {
    double sum = 0;
    for (const BalanceField<Part>& field : Part::fields) sum += part.*field.place;
    return sum;
  }
  template <class Part>
  static void add(const Part& other, Part& part) {
    for (const BalanceField<Part>& field : Part::fields) part.*field.place += other.*field.place;
  }
};

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
