#include "edit_requests/checked_load.h"

#include <cmath>

#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

std::string text(const Vector3& v) {
  return "(" + number_text(v.x()) + ", " + number_text(v.y()) + ", " + number_text(v.z()) + ")";
}

void check_vector(const std::string& field, const Vector3& v, const Range& range, const char* unit,
                  std::vector<std::string>& errors) {
  if (!range.contains(v.x()) || !range.contains(v.y()) || !range.contains(v.z()))
    errors.push_back(field + ": " + text(v) + "; allowed: " + range.text(unit));
}

/// What a node of a cable cannot take.
void check_node(const RequestedLoad& request, const std::string& node, std::vector<std::string>& errors) {
  if (!(request.torque.array() == 0).all())
    errors.push_back(request.words->torque + ": " + text(request.torque) + " on " + node + "; allowed: 0, it takes a force only");
  if (request.point) errors.push_back("point: " + text(*request.point) + " on " + node + "; allowed: 0, it is a point");
}

}  // namespace

const LoadWords& service_load_words() {
  static const LoadWords words{"location.cable", "wrench.force", "wrench.torque", "frame_id"};
  return words;
}

std::string load_name(const World& world, const BodyId& body, int node) {
  const std::string name = name_of(world, body);
  return body.is_cable() ? name + "[" + std::to_string(node) + "]" : name;
}

CheckedLoad check_load(const RequestedLoad& request, const Location& place, const World& world, const FindFrame& find_frame) {
  CheckedLoad checked;
  checked.errors = place.errors;
  if (!request.name.empty() && !is_name(request.name))
    checked.errors.push_back("name: " + quoted(request.name) + "; allowed: " + name_words);
  check_vector(request.words->force, request.force, applied_load, "N", checked.errors);
  check_vector(request.words->torque, request.torque, applied_load, "N m", checked.errors);
  if (request.point) check_vector("point", *request.point, coordinate, "m", checked.errors);
  if (!load_duration.contains(request.duration))
    checked.errors.push_back("duration: " + number_text(request.duration) + "; allowed: " + load_duration.text("s"));
  if (place.errors.empty() && place.body.is_net())
    checked.errors.push_back(request.words->on + ": " + quoted(name_of(world, place.body)) +
                             "; allowed: cables and bodies, it is a net");
  const bool is_found = place.errors.empty(), is_body = place.body.is_rigid_body();
  const bool is_own = is_found && is_body && request.frame_id == name_of(world, place.body);
  const std::optional<Pose> axes = is_own || request.frame_id.empty() ? Pose{} : find_frame(request.frame_id);
  if (!axes && is_found)
    checked.errors.push_back(request.words->axes + ": " + quoted(request.frame_id) +
                             "; allowed: empty for the fixed frame, the name of the body that it acts on, or a known frame");
  if (is_found && place.body.is_cable())
    check_node(request, "node " + std::to_string(place.node) + " of " + kind_and_name(world, place.body), checked.errors);
  if (!checked.errors.empty()) return checked;
  edit::ApplyLoad& load = checked.load;
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
  const EditResult result = world.apply(load);
  if (!result.ok) return result;
  const std::string where = load.body.is_cable() ? "node " + std::to_string(load.node) + " of " + kind_and_name(world, load.body)
                                                 : kind_and_name(world, load.body);
  const bool ends = load.force.isZero(0) && load.torque.isZero(0);
  const std::string until = load.duration > 0 ? " for " + number_text(load.duration) + " s" : " until it is changed";
  return {true, "load " + quoted(result.name) + (ends ? " has ended" : " acts on " + where + until), result.name};
}

}  // namespace verlet_cable
