#include "net/link_rows.h"

#include <algorithm>
#include <cmath>

#include "geometry/vector_code.h"

namespace verlet_cable {

namespace {

/// Of the turn of a link within a step. An impulse along its direction at the start changes its length at the end by this part of
/// what it does to a link that does not turn, and the other way round where it is negative: sweeps would drive it without end.
constexpr double least_cosine = 0.5;
/// Square of the cosine of 30 degrees.
constexpr double turned_square = 0.75;

/// The arrays of one run, as plain pointers: compilers make vector code of these only.
struct Pointers {
  const double *x, *y, *z, *w;
  double *u, *v, *s;
  double *impulse, *inverse_length;
  int i, j, link, stride, count;

  Pointers(const LinkRun& run, const LinkArrays& a)
      : x(a.position.x.data()),
        y(a.position.y.data()),
        z(a.position.z.data()),
        w(a.inverse_mass.data()),
        u(const_cast<double*>(a.velocity.x.data())),
        v(const_cast<double*>(a.velocity.y.data())),
        s(const_cast<double*>(a.velocity.z.data())),
        impulse(const_cast<double*>(a.impulse.data())),
        inverse_length(const_cast<double*>(a.inverse_length.data())),
        i(run.first_node),
        j(run.second_node),
        link(run.first),
        stride(run.stride),
        count(run.count) {}
};

struct Law {
  double h, rest_stiffness, total_stiffness, damping, shortest, longest;
  Law(const LinkLaw& law, double step)
      : h(step),
        rest_stiffness(law.stiffness * law.rest_length),
        total_stiffness(law.stiffness + law.damping / step),
        damping(law.damping / step),
        shortest(law.shortest),
        longest(law.longest) {}
};

template <int stride>
inline __attribute__((always_inline)) void start(const Pointers& p) {
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
inline __attribute__((always_inline)) void sweep(const Pointers& p, const Law& law) {
  const double *x = p.x, *y = p.y, *z = p.z, *w = p.w, *inverse_length = p.inverse_length;
  double *u = p.u, *v = p.v, *s = p.s, *impulse = p.impulse;
  const int step = stride > 0 ? stride : p.stride;
  const double h = law.h;
#pragma GCC ivdep
  for (int k = 0; k < p.count; ++k) {
    const int i = p.i + k * step, j = p.j + k * step, link = p.link + k * step;
    const double dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i];
    const double ex = dx + h * (u[j] - u[i]), ey = dy + h * (v[j] - v[i]), ez = dz + h * (s[j] - s[i]);
    const double length = std::sqrt(ex * ex + ey * ey + ez * ez);
    const double e = inverse_length[link], mobility = h * (w[i] + w[j]), before = impulse[link];
    // The law is solved for P with l' = length + mobility (P - before). Divisions are dear: both are made of one.
    const double free = length - mobility * before, resistance = 1 + h * law.total_stiffness * mobility;
    const double inverse = 1 / (mobility * resistance);
    const double start_length = e * (dx * dx + dy * dy + dz * dz);
    const double pull = law.total_stiffness * free - law.rest_stiffness - law.damping * start_length;
    double next = free - h * mobility * mobility * inverse * pull;
    next = next < law.longest ? next : law.longest;
    next = next > law.shortest ? next : law.shortest;
    const bool follows = e * (dx * ex + dy * ey + dz * ez) > least_cosine * length;
    const double change = follows ? (next - length) * inverse * resistance : -before;
    impulse[link] = before + change;
    const double size = change * e, of_i = size * w[i], of_j = size * w[j];
    u[i] -= of_i * dx;
    v[i] -= of_i * dy;
    s[i] -= of_i * dz;
    u[j] += of_j * dx;
    v[j] += of_j * dy;
    s[j] += of_j * dz;
  }
}

VERLET_CABLE_VECTOR_CODE void start_by_one(Pointers p) {
  start<1>(p);
}
VERLET_CABLE_VECTOR_CODE void start_by_two(Pointers p) {
  start<2>(p);
}
VERLET_CABLE_VECTOR_CODE void sweep_by_one(Pointers p, Law law) {
  sweep<1>(p, law);
}
VERLET_CABLE_VECTOR_CODE void sweep_by_two(Pointers p, Law law) {
  sweep<2>(p, law);
}

constexpr int block = 64;

/// Largest and least of each place in blocks: what a compiler makes vector code of without reordering anything.
VERLET_CABLE_VECTOR_CODE void measure(Pointers p, double h, double* __restrict least, double* __restrict largest,
                                      double* __restrict turned) {
  for (int start = 0; start < p.count; start += block) {
    const int count = std::min(block, p.count - start);
#pragma GCC ivdep
    for (int k = 0; k < count; ++k) {
      const int i = p.i + (start + k) * p.stride, j = p.j + (start + k) * p.stride;
      const double dx = p.x[j] - p.x[i], dy = p.y[j] - p.y[i], dz = p.z[j] - p.z[i];
      const double ex = dx + h * (p.u[j] - p.u[i]);
      const double ey = dy + h * (p.v[j] - p.v[i]);
      const double ez = dz + h * (p.s[j] - p.s[i]);
      const double square = ex * ex + ey * ey + ez * ez;
      const double along = p.inverse_length[p.link + (start + k) * p.stride] * (dx * ex + dy * ey + dz * ez);
      const double kept = along * std::fabs(along) - turned_square * square;
      turned[k] = kept < turned[k] ? kept : turned[k];
      least[k] = square < least[k] ? square : least[k];
      largest[k] = square > largest[k] ? square : largest[k];
    }
  }
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
    sweep_by_one({run, arrays}, {law, h});
  else
    sweep_by_two({run, arrays}, {law, h});
}

SquareRange measure_links(const LinkRun& run, double rest_length, double h, const LinkArrays& arrays) {
  double least[block], largest[block], turned[block];
  std::fill(least, least + block, 1e300);
  std::fill(largest, largest + block, 0.0);
  std::fill(turned, turned + block, 0.0);
  measure({run, arrays}, h, least, largest, turned);
  const double scale = 1 / (rest_length * rest_length);
  return {scale * *std::min_element(least, least + block), scale * *std::max_element(largest, largest + block),
          *std::min_element(turned, turned + block) < 0};
}

Vector3 set_length(double length, const Vector3& end, double before, double inverse_length, bool along_end, double h,
                   LooseNode& i, LooseNode& j, double& impulse) {
  const Vector3 start = (j.position - i.position) * inverse_length;
  if (before > 0 && start.dot(end) < least_cosine * before) along_end = true;
  const Vector3 direction = along_end && before > 0 ? Vector3(end / before) : start;
  const double change = (length - before) / (h * (i.inverse_mass + j.inverse_mass));
  i.velocity -= change * i.inverse_mass * direction;
  j.velocity += change * j.inverse_mass * direction;
  if (along_end) return change * direction;
  impulse += change;
  return Vector3::Zero();
}

}  // namespace verlet_cable
