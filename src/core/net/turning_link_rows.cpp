#include "net/turning_link_rows.h"

#include <cmath>

#include "geometry/vector_code.h"
#include "net/link_law.h"

namespace verlet_cable {

namespace {

/// [m^2] Keeps what has no length finite.
constexpr double least_square = 1e-300;

/// Changes the impulse of a link by (x, y, z).
inline __attribute__((always_inline)) void push(const LinkPointers& p, int i, int j, double of_i, double of_j, double x, double y,
                                                double z) {
  p.u[i] -= of_i * x;
  p.v[i] -= of_i * y;
  p.s[i] -= of_i * z;
  p.u[j] += of_j * x;
  p.v[j] += of_j * y;
  p.s[j] += of_j * z;
}

VERLET_CABLE_WIDE_VECTOR_CODE void start(LinkPointers p) {
#pragma GCC ivdep
  for (int k = 0; k < p.count; ++k) {
    const int i = p.i + k, j = p.j + k, link = p.link + k;
    const double dx = p.x[j] - p.x[i], dy = p.y[j] - p.y[i], dz = p.z[j] - p.z[i];
    const double e = 1 / std::sqrt(dx * dx + dy * dy + dz * dz + least_square), size = p.impulse[link] * e;
    p.inverse_length[link] = e;
    p.px[link] = size * dx;
    p.py[link] = size * dy;
    p.pz[link] = size * dz;
  }
}

/// Of links that may share nodes: first what all of them do to their first nodes, then what they do to their second ones.
VERLET_CABLE_WIDE_VECTOR_CODE void push_all(int count, double of_i, double of_j, const double* __restrict impulse, double* u_i,
                                            double* u_j) {
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) u_i[k] -= of_i * impulse[k];
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) u_j[k] += of_j * impulse[k];
}

/// How a link would be without its own impulse, and the direction [1] that its impulse has. What pulls turns with the link, so
/// that its direction is the same with it and without. What pushes would turn a link over: it acts along the direction at the
/// start.
struct FreeLink {
  double x, y, z, length, start_length;
};

inline __attribute__((always_inline)) FreeLink free_link(const LinkPointers& p, const LawOfRun& law, int i, int j, int link) {
  const double dx = p.x[j] - p.x[i], dy = p.y[j] - p.y[i], dz = p.z[j] - p.z[i];
  const double e = p.inverse_length[link], before = p.impulse[link];
  const double mobility = before > 0 ? 0.0 : law.mobility;
  const double x = dx + (law.h * (p.u[j] - p.u[i]) - mobility * p.px[link]);
  const double y = dy + (law.h * (p.v[j] - p.v[i]) - mobility * p.py[link]);
  const double z = dz + (law.h * (p.s[j] - p.s[i]) - mobility * p.pz[link]);
  const double length = std::sqrt(x * x + y * y + z * z + least_square);
  const double inverse = 1 / (before > 0 ? before : length);
  FreeLink f;
  f.length = length - (before > 0 ? law.mobility * before : 0.0);
  f.x = inverse * (before > 0 ? p.px[link] : x);
  f.y = inverse * (before > 0 ? p.py[link] : y);
  f.z = inverse * (before > 0 ? p.pz[link] : z);
  f.start_length = e * (dx * dx + dy * dy + dz * dz);
  return f;
}

template <int stride>
inline __attribute__((always_inline)) void sweep(const LinkPointers& p, const LawOfRun& law) {
#pragma GCC ivdep
  for (int k = 0; k < p.count; ++k) {
    const int i = p.i + k * stride, j = p.j + k * stride, link = p.link + k * stride;
    const FreeLink f = free_link(p, law, i, j, link);
    const double impulse = impulse_of(law, f.length, f.start_length);
    const double x = impulse * f.x, y = impulse * f.y, z = impulse * f.z;
    const double change_x = x - p.px[link], change_y = y - p.py[link], change_z = z - p.pz[link];
    p.impulse[link] = impulse;
    p.px[link] = x;
    p.py[link] = y;
    p.pz[link] = z;
    push(p, i, j, law.of_i, law.of_j, change_x, change_y, change_z);
  }
}

VERLET_CABLE_WIDE_VECTOR_CODE void find_lacking(LinkPointers p, LawOfRun law, double* __restrict lacking) {
  const double resistance = law.h / law.yielding;
#pragma GCC ivdep
  for (int k = 0; k < p.count; ++k) {
    const int i = p.i + k, j = p.j + k, link = p.link + k;
    const FreeLink f = free_link(p, law, i, j, link);
    lacking[link] = (impulse_of(law, f.length, f.start_length) - p.impulse[link]) * resistance;
  }
}

/// Impulses that are added are left in x, y and z.
VERLET_CABLE_WIDE_VECTOR_CODE void add(LinkPointers p, const double* __restrict added, double* __restrict x, double* __restrict y,
                                       double* __restrict z) {
#pragma GCC ivdep
  for (int k = 0; k < p.count; ++k) {
    const int i = p.i + k, j = p.j + k, link = p.link + k;
    const double size = added[link] * p.inverse_length[link];
    x[k] = size * (p.x[j] - p.x[i]);
    y[k] = size * (p.y[j] - p.y[i]);
    z[k] = size * (p.z[j] - p.z[i]);
    p.impulse[link] += added[link];
    p.px[link] += x[k];
    p.py[link] += y[k];
    p.pz[link] += z[k];
  }
}

VERLET_CABLE_WIDE_VECTOR_CODE void sweep_by_one(LinkPointers p, LawOfRun law) {
  sweep<1>(p, law);
}
VERLET_CABLE_WIDE_VECTOR_CODE void sweep_by_two(LinkPointers p, LawOfRun law) {
  sweep<2>(p, law);
}

void push_row(const LinkRun& run, LinkArrays& a, const double* x, const double* y, const double* z) {
  const double of_i = a.inverse_mass[run.first_node], of_j = a.inverse_mass[run.second_node];
  const auto push = [&](std::vector<double>& u, const double* impulse) {
    push_all(run.count, of_i, of_j, impulse, u.data() + run.first_node, u.data() + run.second_node);
  };
  push(a.velocity.x, x);
  push(a.velocity.y, y);
  push(a.velocity.z, z);
}

}  // namespace

void start_turning_links(const LinkRun& row, LinkArrays& a) {
  start({row, a});
  push_row(row, a, a.turning_impulse.x.data() + row.first, a.turning_impulse.y.data() + row.first,
           a.turning_impulse.z.data() + row.first);
}

void sweep_turning_links(const LinkRun& run, const LinkLaw& law, double h, LinkArrays& a) {
  if (run.stride == 1)
    sweep_by_one({run, a}, {run, law, h, a});
  else
    sweep_by_two({run, a}, {run, law, h, a});
}

void find_lacking(const LinkRun& row, const LinkLaw& law, double h, const LinkArrays& a, std::vector<double>& lacking) {
  find_lacking({row, a}, {row, law, h, a}, lacking.data());
}

void add_impulses(const LinkRun& row, const std::vector<double>& added, LinkArrays& a, VectorArray& scratch) {
  add({row, a}, added.data(), scratch.x.data(), scratch.y.data(), scratch.z.data());
  push_row(row, a, scratch.x.data(), scratch.y.data(), scratch.z.data());
}

}  // namespace verlet_cable
