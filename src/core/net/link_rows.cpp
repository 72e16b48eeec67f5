#include "net/link_rows.h"

#include <algorithm>
#include <cmath>

#include "geometry/vector_code.h"
#include "net/link_law.h"

namespace verlet_cable {

namespace {

template <int stride>
inline __attribute__((always_inline)) void start(const LinkPointers& p) {
  const double *x = p.x, *y = p.y, *z = p.z, *w = p.w;
  double *u = p.u, *v = p.v, *s = p.s, *inverse = p.inverse_length;
  const double* impulse = p.impulse;
  const int step = stride > 0 ? stride : p.stride;
#pragma GCC ivdep
  for (int k = 0; k < p.count; ++k) {
    const int i = p.i + k * step, j = p.j + k * step, link = p.link + k * step;
    const double dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i];
    const double e = 1 / std::sqrt(dx * dx + dy * dy + dz * dz + 1e-300);
    inverse[link] = e;
    const double size = impulse[link] * e, of_i = size * w[i], of_j = size * w[j];
    u[i] -= of_i * dx;
    v[i] -= of_i * dy;
    s[i] -= of_i * dz;
    u[j] += of_j * dx;
    v[j] += of_j * dy;
    s[j] += of_j * dz;
  }
}

template <int stride>
inline __attribute__((always_inline)) void sweep(const LinkPointers& p, const LawOfRun& law) {
  const double *x = p.x, *y = p.y, *z = p.z, *inverse_length = p.inverse_length;
  double *u = p.u, *v = p.v, *s = p.s, *impulse = p.impulse;
  const int step = stride > 0 ? stride : p.stride;
  const double h = law.h;
#pragma GCC ivdep
  for (int k = 0; k < p.count; ++k) {
    const int i = p.i + k * step, j = p.j + k * step, link = p.link + k * step;
    const double dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i];
    const double ex = dx + h * (u[j] - u[i]), ey = dy + h * (v[j] - v[i]), ez = dz + h * (s[j] - s[i]);
    const double length = std::sqrt(ex * ex + ey * ey + ez * ez);
    const double e = inverse_length[link], before = impulse[link];
    const double after = impulse_of(law, length - law.mobility * before, e * (dx * dx + dy * dy + dz * dz));
    impulse[link] = after;
    const double size = (after - before) * e, of_i = size * law.of_i, of_j = size * law.of_j;
    u[i] -= of_i * dx;
    v[i] -= of_i * dy;
    s[i] -= of_i * dz;
    u[j] += of_j * dx;
    v[j] += of_j * dy;
    s[j] += of_j * dz;
  }
}

VERLET_CABLE_VECTOR_CODE void start_by_one(LinkPointers p) {
  start<1>(p);
}
VERLET_CABLE_VECTOR_CODE void start_by_two(LinkPointers p) {
  start<2>(p);
}
VERLET_CABLE_VECTOR_CODE void sweep_by_one(LinkPointers p, LawOfRun law) {
  sweep<1>(p, law);
}
VERLET_CABLE_VECTOR_CODE void sweep_by_two(LinkPointers p, LawOfRun law) {
  sweep<2>(p, law);
}

constexpr int lanes = 8;

/// Largest and least of each place in lanes: what a compiler makes vector code of without reordering anything.
template <int stride>
inline __attribute__((always_inline)) void measure(const LinkPointers& p, double h, double* __restrict least,
                                                   double* __restrict largest) {
  const auto square_of = [&](int k) __attribute__((always_inline)) {
    const int i = p.i + k * stride, j = p.j + k * stride;
    const double ex = p.x[j] - p.x[i] + h * (p.u[j] - p.u[i]);
    const double ey = p.y[j] - p.y[i] + h * (p.v[j] - p.v[i]);
    const double ez = p.z[j] - p.z[i] + h * (p.s[j] - p.s[i]);
    return ex * ex + ey * ey + ez * ez;
  };
  const auto include = [&](double square, int lane) __attribute__((always_inline)) {
    least[lane] = square < least[lane] ? square : least[lane];
    largest[lane] = square > largest[lane] ? square : largest[lane];
  };
  int start = 0;
  for (; start + lanes <= p.count; start += lanes)
#pragma GCC ivdep
    for (int lane = 0; lane < lanes; ++lane) include(square_of(start + lane), lane);
  for (; start < p.count; ++start) include(square_of(start), 0);
}
VERLET_CABLE_VECTOR_CODE void measure_by_one(LinkPointers p, double h, double* __restrict least, double* __restrict largest) {
  measure<1>(p, h, least, largest);
}
VERLET_CABLE_VECTOR_CODE void measure_by_two(LinkPointers p, double h, double* __restrict least, double* __restrict largest) {
  measure<2>(p, h, least, largest);
}

}  // namespace

void start_links(const LinkRun& run, LinkArrays& arrays) {
  if (run.stride == 1)
    start_by_one({run, arrays});
  else
    start_by_two({run, arrays});
}

void sweep_links(const LinkRun& run, const LinkLaw& law, double h, LinkArrays& arrays) {
  if (run.stride == 1)
    sweep_by_one({run, arrays}, {run, law, h, arrays});
  else
    sweep_by_two({run, arrays}, {run, law, h, arrays});
}

SquareRange measure_links(const LinkRun& run, double rest_length, double h, const LinkArrays& arrays) {
  double least[lanes], largest[lanes];
  std::fill(least, least + lanes, 1e300);
  std::fill(largest, largest + lanes, 0.0);
  if (run.stride == 1)
    measure_by_one({run, arrays}, h, least, largest);
  else
    measure_by_two({run, arrays}, h, least, largest);
  const double scale = 1 / (rest_length * rest_length);
  return {scale * *std::min_element(least, least + lanes), scale * *std::max_element(largest, largest + lanes)};
}

double end_length(int i, int j, double h, const LinkArrays& a) {
  return (get(a.position, j) - get(a.position, i) + h * (get(a.velocity, j) - get(a.velocity, i))).norm();
}

Vector3 set_length(int link, int i, int j, double length, bool along_end, double h, LinkArrays& a) {
  // A link that turns round within a step is not shortened by what pulls along its direction at the start.
  constexpr double turned = 0.5;
  const Vector3 start = (get(a.position, j) - get(a.position, i)) * a.inverse_length[link];
  const Vector3 end = get(a.position, j) - get(a.position, i) + h * (get(a.velocity, j) - get(a.velocity, i));
  const double before = end.norm();
  if (before > 0 && start.dot(end) < turned * before) along_end = true;
  const Vector3 direction = along_end && before > 0 ? Vector3(end / before) : start;
  const double change = (length - before) / (h * (a.inverse_mass[i] + a.inverse_mass[j]));
  set(a.velocity, i, get(a.velocity, i) - change * a.inverse_mass[i] * direction);
  set(a.velocity, j, get(a.velocity, j) + change * a.inverse_mass[j] * direction);
  if (along_end) return change * direction;
  a.impulse[link] += change;
  return Vector3::Zero();
}

}  // namespace verlet_cable
