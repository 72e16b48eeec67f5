#include <algorithm>
#include <string>

#include "guide/node_passing.h"
#include "rod/length_projection.h"
#include "rod/rod_frames.h"
#include "verlet_cable/core/scene_fields.h"
#include "world/implementation.h"

namespace verlet_cable {

namespace {

/// Of vectors for each node [m], [m/s]; empty if nothing is wrong.
std::string problem_of(const std::string& field, const std::optional<std::vector<Vector3>>& vectors, const CableState& cable) {
  if (!vectors) return "";
  if (static_cast<int>(vectors->size()) != cable.nodes())
    return field + ": " + std::to_string(vectors->size()) + "; must be " + std::to_string(cable.nodes()) + ", one a node";
  std::string problem;
  for (std::size_t node = 0; node < vectors->size() && problem.empty(); ++node)
    problem = vector_problem(field + "[" + std::to_string(node) + "]", (*vectors)[node], coordinate, "");
  return problem;
}

}  // namespace

EditResult World::Implementation::apply(const edit::SetState& set) {
  if (set.cable < 0 || set.cable >= static_cast<int>(state.cables.size()))
    return refused("cable: " + std::to_string(set.cable) + "; must be the index of a cable");
  SimulatedCable& cable = state.cables[set.cable];
  std::string problems = problem_of("positions", set.positions, cable.state);
  const std::string of_velocities = problem_of("velocities", set.velocities, cable.state);
  if (!problems.empty() && !of_velocities.empty()) problems += "\n";
  problems += of_velocities;
  if (!problems.empty()) return refused(problems);

  CableState next = cable.state;
  if (set.positions) {
    next.positions = *set.positions;
    const Boundary boundary = boundary_now(state.cable_progress[set.cable].targets);
    if (!project_positions(*cable.model, boundary.nodes, next))
      return refused("positions: no shape near them has the cable's lengths where its holders are");
    carry_frames(cable.state.positions, next);
  }
  if (set.velocities) next.velocities = *set.velocities;
  // What the steps before have found is of another motion.
  for (std::vector<double>* forces : {&next.tension, &next.last_tension, &next.axial_multiplier})
    std::fill(forces->begin(), forces->end(), 0.0);
  std::fill(next.accelerations.begin(), next.accelerations.end(), Vector3::Zero());
  next.yielding = next.taut_energy = 0;
  cable.state = std::move(next);
  after_remeshing(set.cable);
  if (set.positions) yield_to_shape(set.cable);
  move_with_holders(set.cable, state);
  return {true, "", cable.model->name};
}

}  // namespace verlet_cable
