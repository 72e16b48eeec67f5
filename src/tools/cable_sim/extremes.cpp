#include "extremes.h"

#include <cmath>

namespace verlet_cable::cable_sim {
namespace {

using tools::Json;

/// Smaller angles between segments are rounding [1/m], [rad/m].
constexpr double least_curvature = 1e-9, least_twist = 1e-12;

template <class Extreme, class Exceeds>
void take(double value, double time, double arc_length, const Exceeds& exceeds, Extreme& extreme) {
  if (extreme.value && !exceeds(value, *extreme.value)) return;
  extreme = {value, time, arc_length};
}

template <class Extreme>
Json extreme_json(const Extreme& extreme, const std::optional<double>& value) {
  return {{"value", value ? Json(*value) : Json(nullptr)}, {"time", extreme.time}, {"arc_length", extreme.arc_length}};
}

}  // namespace

void Extremes::add(const World& world) {
  const double time = world.time();
  const auto larger = [](double a, double b) { return a > b; };
  const auto smaller = [](double a, double b) { return a < b; };
  const auto stronger = [](double a, double b) { return std::abs(a) > std::abs(b); };
  for (std::size_t i = 0; i < world.cables().size(); ++i) {
    const SimulatedCable& cable = world.cables()[i];
    OfCable& extremes = cables_[cable.model->name];
    double place = 0;
    for (int k = 0; k < cable.state.segments(); ++k) {
      const double length = cable.state.rest_lengths[k], tension = cable.state.tension[k];
      take(tension, time, place + 0.5 * length, larger, extremes.max_tension);
      take(tension, time, place + 0.5 * length, smaller, extremes.min_tension);
      place += length;
    }
    world.view_joints(static_cast<int>(i), joints_);
    for (const JointView& joint : joints_) {
      if (joint.curvature > least_curvature) take(joint.curvature, time, joint.arc_length, larger, extremes.max_curvature);
      if (std::abs(joint.twist) > least_twist) take(joint.twist, time, joint.arc_length, stronger, extremes.max_twist);
    }
  }
}

Json Extremes::json() const {
  Json json = Json::object();
  for (const auto& [name, extremes] : cables_) {
    std::optional<double> radius;
    if (extremes.max_curvature.value) radius = 1 / *extremes.max_curvature.value;
    json[name] = {{"max_tension", extreme_json(extremes.max_tension, extremes.max_tension.value)},
                  {"min_tension", extreme_json(extremes.min_tension, extremes.min_tension.value)},
                  {"min_bend_radius", extreme_json(extremes.max_curvature, radius)},
                  {"max_twist", extreme_json(extremes.max_twist, extremes.max_twist.value)}};
  }
  return json;
}

}  // namespace verlet_cable::cable_sim
