#include "world/loads.h"

#include <algorithm>
#include <cmath>

#include "edit/numbered_name.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "world/implementation.h"

namespace verlet_cable {

namespace {

/// That act at once.
constexpr std::size_t most_loads = 10000;
/// Steps that begin within a duration, as it is rounded.
constexpr double rounding_of_duration = 1e-9;

/// What is wrong with a load, wherever it acts; empty if nothing is.
std::string problem_of(const edit::ApplyLoad& load) {
  if (const std::string problem = vector_problem("force", load.force, applied_load, "N"); !problem.empty()) return problem;
  if (const std::string problem = vector_problem("torque", load.torque, applied_load, "N m"); !problem.empty()) return problem;
  const Vector3 point = load.point.value_or(Vector3::Zero());
  if (const std::string problem = vector_problem("point", point, coordinate, "m"); !problem.empty()) return problem;
  if (!load_duration.contains(load.duration))
    return "duration: " + number_text(load.duration) + "; allowed: " + load_duration.text("s");
  if (load.body.is_rigid_body()) return "";
  if (!load.torque.isZero(0)) return "torque: a node of a cable takes a force only; must be 0";
  if (load.is_local || load.point) return "point and axes of a body: a node of a cable has none; must not be given";
  return "";
}

/// Whether the one in place of the other changes no force.
bool acts_alike(const Load& a, const Load& b) {
  return a.body == b.body && a.node == b.node && a.point == b.point && a.force == b.force && a.torque == b.torque &&
         a.is_local == b.is_local;
}

/// The node that goes with the material at a node: that of a guide stays, and the next one goes.
int material_node(int cable, int node, const State& state) {
  for (const Attachment& attachment : state.attachments)
    if (attachment.guide >= 0 && attachment.body == cable_id(cable) && (attachment.node == node || last_node(attachment) == node))
      return last_node(attachment) + 1;
  return node;
}

/// Of a cable or a rigid body.
const std::string& name_of(const State& state, const BodyId& body) {
  return body.is_cable() ? state.cables[body.index].model->name : state.bodies[body.index].name;
}

}  // namespace

EditResult World::Implementation::apply(const edit::ApplyLoad& request) {
  const auto named = [&](const std::string& name) {
    return std::find_if(state.loads.begin(), state.loads.end(), [&](const Load& load) { return load.name == name; });
  };
  const auto before = named(request.name);
  if (request.force.isZero(0) && request.torque.isZero(0)) {
    if (before == state.loads.end()) return {true, "", request.name};
    put_off_last_damped(before->body, state);
    state.loads.erase(before);
    return {true, "", request.name};
  }
  if (!request.body.is_cable() && !request.body.is_rigid_body()) return refused("body: must be a cable or a rigid body");
  if (const std::string problem = node_problem(state, request.body, request.node); !problem.empty()) return refused(problem);
  if (const std::string problem = problem_of(request); !problem.empty()) return refused(problem);
  if (before == state.loads.end() && state.loads.size() >= most_loads)
    return refused("name: " + request.name + "; " + std::to_string(most_loads) + " loads act already, no more can");
  Load load;
  load.name = request.name.empty() ? numbered("load", 1, [&](const std::string& n) { return named(n) != state.loads.end(); })
                                   : request.name;
  load.body = request.body;
  load.node = request.body.is_cable() ? material_node(request.body.index, request.node, state) : 0;
  if (request.body.is_rigid_body()) load.point = request.point.value_or(state.bodies[request.body.index].center_of_mass);
  load.force = request.force;
  load.torque = request.torque;
  load.is_local = request.is_local;
  if (request.duration > 0) {
    const double steps = std::ceil(request.duration / state.scene->time_step * (1 - rounding_of_duration));
    load.end_step = state.steps + std::max<std::int64_t>(1, static_cast<std::int64_t>(steps));
  }
  const EditResult result{true, "", load.name};
  if (before == state.loads.end() || !acts_alike(load, *before)) put_off_last_damped(load.body, state);
  if (before != state.loads.end() && before->body != load.body) put_off_last_damped(before->body, state);
  if (before == state.loads.end())
    state.loads.push_back(std::move(load));
  else
    *before = std::move(load);
  return result;
}

namespace {

/// Of those loads for which `ends` is true it is told.
template <class Ends>
void end_where(const Ends& ends, bool ran_out, State& state, std::vector<EndedLoad>& told) {
  for (const Load& load : state.loads) {
    if (!ends(load)) continue;
    told.push_back({load.name, name_of(state, load.body), ran_out});
    put_off_last_damped(load.body, state);
  }
  state.loads.erase(std::remove_if(state.loads.begin(), state.loads.end(), ends), state.loads.end());
}

}  // namespace

/// Those whose time has run out.
void World::Implementation::end_loads() {
  end_where([&](const Load& load) { return load.end_step > 0 && load.end_step <= state.steps; }, true, state,
            findings.ended_loads);
}

/// A winch takes the node in.
void World::Implementation::end_loads_of(int cable, int node) {
  end_where([&](const Load& load) { return load.body == cable_id(cable) && load.node == node; }, false, state,
            findings.ended_loads);
}

}  // namespace verlet_cable
