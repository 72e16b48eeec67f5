#include "net/wind.h"

#include <cmath>

#include "geometry/vector_code.h"

namespace verlet_cable {

namespace {

struct Components {
  const double *x, *y, *z;
  Components(const VectorArray& array, int first)
      : x(array.x.data() + first), y(array.y.data() + first), z(array.z.data() + first) {}
};

struct DragLaw {
  double wind_x, wind_y, wind_z;  ///< [m/s]
  double pressure;  ///< 1/4 density normal_drag / 3 [kg/m^3]: with N = 2 A n, 1/2 A |v_n| v_n n = 1/4 |v.N| v.N N / |N|^2
  double surface;   ///< [m] no fluid above
  double damping;   ///< h over the nodes' mass, and three triangles' share [s/kg]
};

/// The force on each of `count` triangles in a row, a third of it.
VERLET_CABLE_VECTOR_CODE void drag_row(int count, DragLaw law, Components a, Components b, Components c, Components va,
                                       Components vb, Components vc, double* __restrict x, double* __restrict y,
                                       double* __restrict z) {
  for (int k = 0; k < count; ++k) {
    const double px = b.x[k] - a.x[k], py = b.y[k] - a.y[k], pz = b.z[k] - a.z[k];
    const double qx = c.x[k] - a.x[k], qy = c.y[k] - a.y[k], qz = c.z[k] - a.z[k];
    const double nx = py * qz - pz * qy, ny = pz * qx - px * qz, nz = px * qy - py * qx;
    const double square = nx * nx + ny * ny + nz * nz + 1e-300;
    constexpr double third = 1.0 / 3;
    const double flow = (law.wind_x - third * (va.x[k] + vb.x[k] + vc.x[k])) * nx +
                        (law.wind_y - third * (va.y[k] + vb.y[k] + vc.y[k])) * ny +
                        (law.wind_z - third * (va.z[k] + vb.z[k] + vc.z[k])) * nz;
    const double per_flow = law.pressure * std::fabs(flow) / square;
    const double brake = law.damping * per_flow * square;
    const double limit = brake > 1 ? 1 / brake : 1.0;
    const double wet = third * (a.z[k] + b.z[k] + c.z[k]) < law.surface ? 1.0 : 0.0;
    const double scale = wet * limit * per_flow * flow;
    x[k] = scale * nx;
    y[k] = scale * ny;
    z[k] = scale * nz;
  }
}

VERLET_CABLE_VECTOR_CODE void add_row(int count, const double* __restrict from, double* __restrict to) {
  for (int k = 0; k < count; ++k) to[k] += from[k];
}

}  // namespace

void NetWind::resize(const NetModel& model) {
  force_.assign(model.masses.size(), 0.0);
  triangle_.assign(static_cast<std::size_t>(model.columns), 0.0);
}

void NetWind::evaluate(const NetModel& model, const FluidDesc& fluid, double h, const VectorArray& position,
                       const VectorArray& velocity) {
  active_ = fluid.density > 0 && fluid.normal_drag > 0 && model.is_grid();
  if (!active_) return;
  force_.assign(model.masses.size(), 0.0);
  DragLaw law{};
  law.wind_x = fluid.velocity.x();
  law.wind_y = fluid.velocity.y();
  law.wind_z = fluid.velocity.z();
  law.pressure = 0.25 * fluid.density * fluid.normal_drag / 3;
  law.surface = fluid.surface;
  const int count = model.columns - 1;
  // Six triangles meet at a node.
  law.damping = 6 * h / model.masses.front();
  for (int row = 0; row + 1 < model.rows; ++row) {
    const int upper = row * model.columns, lower = upper + model.columns;
    const int triangles[2][3] = {{upper, lower, upper + 1}, {lower + 1, upper + 1, lower}};
    for (const auto& corner : triangles) {
      drag_row(count, law, {position, corner[0]}, {position, corner[1]}, {position, corner[2]}, {velocity, corner[0]},
               {velocity, corner[1]}, {velocity, corner[2]}, triangle_.x.data(), triangle_.y.data(), triangle_.z.data());
      for (const int node : corner) {
        add_row(count, triangle_.x.data(), force_.x.data() + node);
        add_row(count, triangle_.y.data(), force_.y.data() + node);
        add_row(count, triangle_.z.data(), force_.z.data() + node);
      }
    }
  }
}

}  // namespace verlet_cable
