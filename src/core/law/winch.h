#pragma once

#include <algorithm>
#include <cmath>

#include "law/resistance.h"
#include "law/stretch.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// By how much more than planned a winch lets the rest length of the segment beside it grow in a substep: growth as a function of
/// the tension of what leaves it. Below `tension` it is the least, above it the most, and at it anything between.
struct WinchLaw {
  double tension = infinity;   ///< [N] not negative
  double least = 0, most = 0;  ///< [m]
  double guess = 0;            ///< [m] likely growth, between them
  /// [m/s] of the rest length at the end of the substep, beyond what is planned, where its growth is the least and the most
  double least_rate = 0, most_rate = 0;

  bool gives() const { return most > least; }
};

enum class WinchMode { least, keeps, most };

/// `wanted` [m]: the growth that would leave the tension.
inline WinchMode mode_of(const WinchLaw& law, double wanted) {
  return wanted <= law.least ? WinchMode::least : wanted >= law.most ? WinchMode::most : WinchMode::keeps;
}

inline double growth_in(const WinchLaw& law, WinchMode mode, double wanted) {
  return mode == WinchMode::least ? law.least : mode == WinchMode::most ? law.most : std::clamp(wanted, law.least, law.most);
}

/// An elastic segment at a winch: its rest lengths [m] as planned, and how long it is at the start of the substep [m].
struct WoundLength {
  double start_rest = 0, rest = 0, end_rest = 0;  ///< at the start, where forces are taken, at the end
  double start_length = 0;
};

/// [m] Of an elastic segment whose length at the end is `length` [m]. Its strain is then that which leaves the tension at the
/// end, its damping included. A mean over the substep would let the strain alternate. `resistance` [N]: of strains, as in draw().
inline double wanted_growth(const Resistance<double>& resistance, const WoundLength& wound, double tension, double length) {
  const double start_strain = wound.start_length / wound.start_rest - 1;
  const double strain = (tension + resistance.damping * start_strain) / (resistance.stiffness + resistance.damping);
  return length / (1 + strain) - wound.end_rest;
}

/// Its tension where forces are taken [N], and how that rises with the length at the end [N/m].
struct WoundTension {
  double tension = 0, rise = 0;
};

/// `growth` [m]: beyond what is planned; `part`: where in the substep forces are taken, 1/2 or 1.
inline WoundTension wound_tension(const Resistance<double>& resistance, const WoundLength& wound, WinchMode mode, double growth,
                                  double length, double part) {
  const double rest = wound.rest + part * growth, end_rest = wound.end_rest + growth;
  const double mean = wound.start_length + part * (length - wound.start_length);
  const double strain_at_start = wound.start_length / wound.start_rest - 1, strain_at_end = length / end_rest - 1;
  WoundTension found;
  found.tension = resistance.stress(mean / rest - 1, strain_at_end - strain_at_start);
  // The rest length follows the length, in proportion, where the strain at the end stays.
  found.rise = mode == WinchMode::keeps ? resistance.stiffness * part / rest * (1 - mean / rest * end_rest / length)
                                        : resistance.stiffness * part / rest + resistance.damping / end_rest;
  return found;
}

/// [m] Of a segment that cannot stretch, beyond the planned `rest` [m]: where it differs from how long the segment is, its
/// tension does from the law's. `mobility` [m/N] weighs one against the other.
inline double wanted_growth(double rest, double law_tension, double tension, double length, double mobility) {
  return length - rest + mobility * (tension - law_tension);
}

/// Of a segment whose tension hardly changes with its length, see elastic_row(): its own stiffness may just outweigh that of its
/// direction. `least_stiffness` [N/m]: where they are the same, any would do.
inline LengthRow<double> kept_row(const WoundTension& wound, double density, double mean, double end, double part,
                                  double least_stiffness) {
  double stiffness = wound.rise - part * density;
  if (std::abs(stiffness) < least_stiffness) stiffness = least_stiffness;
  return elastic_row(wound.tension, stiffness + part * density, density, mean, end, part);
}

}  // namespace verlet_cable
