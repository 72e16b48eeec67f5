#include "edit_requests/checked_load.h"

#include <algorithm>
#include <cmath>

#include "edit_requests/error_text.h"
#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

void check_vector(const std::string& field, const Vector3& v, const Range& range, const char* unit,
                  std::vector<std::string>& errors) {
  if (!range.contains(v.x()) || !range.contains(v.y()) || !range.contains(v.z()))
    errors.push_back(field + ": " + point_text(v) + "; allowed: " + range.text(unit));
}

/// What a node of a cable cannot take.
void check_node(const RequestedLoad& request, const std::string& node, std::vector<std::string>& errors) {
  if (!(request.torque.array() == 0).all())
    errors.push_back(request.words->torque + ": " + point_text(request.torque) + " on " + node +
                     "; allowed: 0, it takes a force only");
  if (request.point) errors.push_back("point: " + point_text(*request.point) + " on " + node + "; allowed: 0, it is a point");
}

}  // namespace

const LoadWords& service_load_words() {
  static const LoadWords words{"location.cable", "wrench.force", "wrench.torque", "frame_id"};
  return words;
}

std::string load_name(const World& world, const BodyId& body, int node) {
  const std::string name = name_of(world, body);
  if (!body.is_cable()) return name;
  const std::vector<Load>& loads = world.loads();
  // One that has no name of its own keeps what it was given where its node has another number now: no other load has brackets.
  const auto is_here = [&](const Load& load) {
    return load.body == body && load.node == node && load.name.find('[') != std::string::npos;
  };
  const auto here = std::find_if(loads.begin(), loads.end(), is_here);
  if (here != loads.end()) return here->name;
  const std::string first = name + "[" + std::to_string(node) + "]";
  const auto is_taken = [&](const std::string& wanted) {
    return std::any_of(loads.begin(), loads.end(), [&](const Load& load) { return load.name == wanted; });
  };
  std::string free = first;
  for (int k = 2; is_taken(free); ++k) free = first + "_" + std::to_string(k);
  return free;
}

CheckedLoad check_load(const RequestedLoad& request, const Location& place, const World& world, const FindFrame& find_frame) {
  CheckedLoad checked;
  // What ends a load by its name needs no place.
  const bool ends = !request.name.empty() && request.force.isZero(0) && request.torque.isZero(0);
  if (!ends) checked.errors = place.errors;
  if (!request.name.empty() && !is_name(request.name))
    checked.errors.push_back("name: " + in_quotes(request.name) + "; allowed: " + name_words);
  check_vector(request.words->force, request.force, applied_load, "N", checked.errors);
  check_vector(request.words->torque, request.torque, applied_load, "N m", checked.errors);
  if (request.point) check_vector("point", *request.point, coordinate, "m", checked.errors);
  if (!load_duration.contains(request.duration))
    checked.errors.push_back("duration: " + number_text(request.duration) + "; allowed: " + load_duration.text("s"));
  if (place.errors.empty() && place.body.is_net())
    checked.errors.push_back(request.words->on + ": " + in_quotes(name_of(world, place.body)) +
                             "; allowed: cables and bodies, it is a net");
  const bool is_found = place.errors.empty(), is_body = place.body.is_rigid_body();
  const bool is_own = is_found && is_body && request.frame_id == name_of(world, place.body);
  const std::optional<Pose> axes = is_own || request.frame_id.empty() ? Pose{} : find_frame(request.frame_id);
  if (!axes && is_found && !ends)
    checked.errors.push_back(request.words->axes + ": " + in_quotes(request.frame_id) +
                             "; allowed: empty for the fixed frame, the name of the body that it acts on, or a known frame");
  if (is_found && place.body.is_cable())
    check_node(request, "node " + std::to_string(place.node) + " of " + kind_and_name(world, place.body), checked.errors);
  if (!checked.errors.empty()) return checked;
  edit::ApplyLoad& load = checked.load;
  if (ends) {
    load.name = request.name;
    return checked;
  }
  load.name = request.name.empty() ? load_name(world, place.body, place.node) : request.name;
  load.body = place.body;
  load.node = place.node;
  load.point = request.point;
  load.force = axes->orientation * request.force;
  load.torque = axes->orientation * request.torque;
  load.is_local = is_own;
  load.duration = request.duration;
  return checked;
}

EditResult apply_load(World& world, const edit::ApplyLoad& load) {
  const auto has_name = [&](const Load& other) { return other.name == load.name; };
  const bool acted = std::any_of(world.loads().begin(), world.loads().end(), has_name);
  const EditResult result = world.apply(load);
  if (!result.ok) return result;
  if (load.force.isZero(0) && load.torque.isZero(0))
    return {true, "load " + in_quotes(result.name) + (acted ? " has ended" : " does not act"), result.name};
  const std::string where = load.body.is_cable() ? "node " + std::to_string(load.node) + " of " + kind_and_name(world, load.body)
                                                 : kind_and_name(world, load.body);
  const std::string until = load.duration > 0 ? " for " + number_text(load.duration) + " s" : " until it is changed";
  return {true, "load " + in_quotes(result.name) + " acts on " + where + until, result.name};
}

}  // namespace verlet_cable
