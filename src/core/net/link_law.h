#pragma once

#include "net/link_rows.h"

namespace verlet_cable {

/// The arrays of one run, as plain pointers: compilers make vector code of these only.
struct LinkPointers {
  const double *x, *y, *z, *w;
  double *u, *v, *s;
  double *impulse, *inverse_length, *px, *py, *pz;
  int i, j, link, stride, count;

  LinkPointers(const LinkRun& run, const LinkArrays& a)
      : x(a.position.x.data()),
        y(a.position.y.data()),
        z(a.position.z.data()),
        w(a.inverse_mass.data()),
        u(const_cast<double*>(a.velocity.x.data())),
        v(const_cast<double*>(a.velocity.y.data())),
        s(const_cast<double*>(a.velocity.z.data())),
        impulse(const_cast<double*>(a.impulse.data())),
        inverse_length(const_cast<double*>(a.inverse_length.data())),
        px(const_cast<double*>(a.turning_impulse.x.data())),
        py(const_cast<double*>(a.turning_impulse.y.data())),
        pz(const_cast<double*>(a.turning_impulse.z.data())),
        i(run.first_node),
        j(run.second_node),
        link(run.first),
        stride(run.stride),
        count(run.count) {}
};

/// Of all links of a run. With l = free + mobility P the spring's impulse is P = yielding (rest_stiffness + damping start_length
/// - total_stiffness free).
struct LawOfRun {
  double h, of_i, of_j;                                       ///< inverse masses [1/kg]
  double mobility, inverse_mobility;                          ///< m / (N s)
  double rest_stiffness, total_stiffness, damping, yielding;  ///< N, N/m, N/m, s
  double shortest, longest;                                   ///< [m]
  LawOfRun(const LinkRun& run, const LinkLaw& law, double step, const LinkArrays& a)
      : h(step),
        of_i(a.inverse_mass[run.first_node]),
        of_j(a.inverse_mass[run.second_node]),
        mobility(h * (of_i + of_j)),
        inverse_mobility(1 / mobility),
        rest_stiffness(law.stiffness * law.rest_length),
        total_stiffness(law.stiffness + law.damping / step),
        damping(law.damping / step),
        yielding(h / (1 + h * total_stiffness * mobility)),
        shortest(law.shortest),
        longest(law.longest) {}
};

/// The impulse of a link that is free [m] long without it.
inline __attribute__((always_inline)) double impulse_of(const LawOfRun& law, double free, double start_length) {
  double impulse = law.yielding * (law.rest_stiffness + law.damping * start_length - law.total_stiffness * free);
  const double most = (law.longest - free) * law.inverse_mobility, least = (law.shortest - free) * law.inverse_mobility;
  impulse = impulse < most ? impulse : most;
  return impulse > least ? impulse : least;
}

}  // namespace verlet_cable
