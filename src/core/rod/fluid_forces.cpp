#include "rod/fluid_forces.h"

#include <algorithm>
#include <cmath>

#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

void FluidForces::resize(int nodes) {
  force_.assign(nodes, 0.0);
  drag_.assign(nodes, 0.0);
  stiffness_.assign(nodes, 0.0);
  flow_.assign(nodes, 0.0);
  acceleration_.assign(nodes, 0.0);
  surface_.assign(nodes, 0.0);
  radius_.assign(nodes, 0.0);
  area_radius_.assign(nodes, 0.0);
}

void FluidForces::start(const Substep& s, const CableState& state) {
  active_ = s.environment.fluid.density > 0;
  if (!active_) return;
  fluid_ = &s.environment.fluid;
  gravity_ = &s.environment.gravity;
  damping_time_ = s.damping_time();
  start_water(s, state);
  const CableMaterials materials(s.model, state);
  if (!materials.vary()) {
    std::fill(radius_.begin(), radius_.end(), s.model.material.radius);
    std::fill(area_radius_.begin(), area_radius_.end(), s.model.material.radius);
    return;
  }
  for (int i = 0; i < state.nodes(); ++i) {
    const auto square = [](const MaterialDesc& material) { return material.radius * material.radius; };
    radius_[i] = materials.mean_at(i, [](const MaterialDesc& material) { return material.radius; });
    area_radius_[i] = std::sqrt(materials.mean_at(i, square));
  }
}

void FluidForces::start_water(const Substep& s, const CableState& state) {
  any_waves_ = !s.statics && !s.environment.waves.empty();
  for (int i = 0; i < state.nodes(); ++i) {
    WaterMotion water{fluid_->surface, fluid_->velocity, Vector3::Zero()};
    if (any_waves_) water = s.environment.water_at(state.positions[i] + 0.5 * s.h * state.velocities[i], s.middle);
    set(flow_, i, water.velocity);
    set(acceleration_, i, water.acceleration);
    surface_[i] = water.surface;
  }
}

void FluidForces::add_loads(const std::vector<double>& rest_lengths, const VectorArray& middle, const VectorArray& position,
                            const VectorArray& displacement, VectorArray& load) {
  const int n = static_cast<int>(rest_lengths.size());
  for (int i = 0; i <= n; ++i) {
    Vector3 along = Vector3::Zero();
    double length = 0;
    if (i > 0) along += get(middle, i - 1), length += 0.5 * rest_lengths[i - 1];
    if (i < n) along += get(middle, i), length += 0.5 * rest_lengths[i];
    const double norm = along.norm();
    const double radius = radius_[i];
    const Vector3 tangent = norm > 0 ? Vector3(along / norm) : Vector3(Vector3::Zero());
    // A node dips in over its diameter.
    const double depth = surface_[i] - position.z[i] - 0.5 * displacement.z[i];
    const double immersed = std::clamp(0.5 + 0.5 * depth / radius, 0.0, 1.0);
    const Vector3 flow = get(flow_, i) - get(displacement, i) / damping_time_;
    const Vector3 flow_along = flow.dot(tangent) * tangent, flow_across = flow - flow_along;
    const double width = immersed * fluid_->density * radius * length;
    const double across = width * fluid_->normal_drag * flow_across.norm();
    const double tangential = width * fluid_->tangential_drag * flow_along.norm();
    const double displaced = immersed * fluid_->density * M_PI * area_radius_[i] * area_radius_[i] * length;
    const Vector3 drag = across * flow_across + tangential * flow_along;
    Vector3 force = drag - displaced * gravity_->at(get(position, i));
    if (any_waves_) force += displaced * get(acceleration_, i);
    stiffness_[i] = 2 * across / damping_time_;
    set(drag_, i, drag);
    set(force_, i, force);
    set(load, i, get(load, i) + force);
  }
}

void FluidForces::add_work(const VectorArray& displacement, double h, EnergyBalance& balance) const {
  const int nodes = static_cast<int>(stiffness_.size());
  for (int i = 0; i < nodes; ++i) {
    const Vector3 u = get(displacement, i);
    const double lost = get(drag_, i).dot(h * get(flow_, i) - u);
    balance.dissipated.drag += lost;
    balance.work.applied += get(force_, i).dot(u) + lost;
  }
}

void FluidForces::add_stiffness(std::vector<double>& diagonal) const {
  for (std::size_t i = 0; i < stiffness_.size(); ++i) diagonal[i] += stiffness_[i];
}

}  // namespace verlet_cable
