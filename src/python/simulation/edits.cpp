#include "simulation/edits.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include "edit_requests/error_text.h"
#include "simulation/quantity.h"
#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/obstacle_of.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

[[noreturn]] void refuse(const std::string& message, bool only_unknown_name) {
  if (only_unknown_name) throw UnknownName(message);
  throw std::invalid_argument(message);
}

void require(const EditResult& result, bool only_unknown_name = false) {
  if (!result.ok) refuse(result.message, only_unknown_name);
}

void require_none(const std::vector<std::string>& errors, bool unknown_name) {
  if (!errors.empty()) refuse(join(errors), unknown_name && errors.size() == 1);
}

/// Whether a place names a cable, or a frame of its point, that is not there. `bodies`: whether it may name those, too.
bool names_nothing(const RequestedPlace& place, const DrivenWorld& driven, bool bodies) {
  const World& world = driven.world();
  if (place.mode == RequestedPlace::nearest) {
    if (!place.point_frame.empty() && !driven.frame_pose(place.point_frame)) return true;
    if (place.cable.empty()) return false;
  }
  return find(world.cables(), place.cable) < 0 && find(world.nets(), place.cable) < 0 &&
         !(bodies && find(world.bodies(), place.cable) >= 0);
}

const LoadWords& python_load_words() {
  static const LoadWords words{"cable", "force", "torque", "local"};
  return words;
}

edit::ApplyLoad checked(RequestedLoad request, const Location& place, const World& world) {
  request.words = &python_load_words();
  CheckedLoad checked = check_load(request, place, world, [](const std::string&) { return std::optional<Pose>(); });
  require_none(checked.errors, !place.errors.empty() && place.body.index < 0);
  return std::move(checked.load);
}

bool is_attached(const World& world, const std::string& name) {
  return find(world.attachments(), name) >= 0;
}

}  // namespace

const RequestWords& python_words() {
  static const RequestWords words{
      "cable", "node", "arc_length", "point", "point", "point_frame", "", {"node", "arc_length", "point"}, "", "frames", "=True"};
  return words;
}

PinAnswer pin(const RequestedPin& request, DrivenWorld& world, EventRecord& events) {
  const auto find_frame = [&](const std::string& name) {
    const std::optional<Pose> pose = world.frame_pose(name);
    return pose || name != request.frame_id || !is_frame_name(name) ? pose : Pose{};
  };
  const CheckedPin pin = check_pin(request, world.world(), find_frame);
  require_none(pin.errors, names_nothing(request.place, world, true));
  const std::size_t frames = world.world().frames().size();
  const EditResult result =
      apply_pin(world.world(), request.name, pin, request.clamp ? AttachmentType::clamp : AttachmentType::hinge);
  require(result);
  world.follow_frames_from(frames);
  const World& changed = world.world();
  const Attachment& attachment = changed.attachments()[find(changed.attachments(), result.name)];
  events.add(changed.time(), {EventType::pinned, subject_of(changed, attachment), result.message});
  return {result.name, pin.node};
}

void unpin(const std::string& name, DrivenWorld& world, EventRecord& events) {
  const int index = find(world.world().attachments(), name);
  const EventSubject subject = index < 0 ? EventSubject{} : subject_of(world.world(), world.world().attachments()[index]);
  const EditResult result = apply_unpin(world.world(), name);
  require(result, index < 0);
  events.add(world.world().time(), {EventType::unpinned, subject, result.message});
}

CutAnswer cut(const RequestedPlace& place, DrivenWorld& world, EventRecord& events) {
  const auto find_frame = [&](const std::string& name) { return world.frame_pose(name); };
  const Location location = locate_cut(place, world.world(), find_frame);
  require_none(location.errors, names_nothing(place, world, false));
  const PlacedEdit cut = apply_cut(world.world(), location);
  require(cut.result);
  const CutAnswer answer{name_of(world.world(), location.body), cut.result.name};
  events.add(world.world().time(), {EventType::cut, {answer.first, {}, cut.node, answer.second}, cut.result.message});
  return answer;
}

std::string join(const std::string& first, bool first_at_end, const std::string& second, bool second_at_end, DrivenWorld& world,
                 EventRecord& events) {
  const auto& cables = world.world().cables();
  const bool unknown = find(cables, first) < 0 || find(cables, second) < 0;
  const PlacedEdit joined = apply_join(world.world(), first, first_at_end, second, second_at_end, python_words());
  require(joined.result, unknown);
  events.add(world.world().time(), {EventType::joined, {joined.result.name, {}, joined.node, second}, joined.result.message});
  return joined.result.name;
}

void set_length(const std::string& cable, bool at_end, double length, double speed, double max_tension, DrivenWorld& world) {
  const bool unknown = find(world.world().cables(), cable) < 0;
  require(apply_set_length(world.world(), cable, at_end, length, speed, max_tension, python_words()), unknown);
}

void set_tension(const std::string& cable, const edit::SetTension& change, DrivenWorld& world) {
  const bool unknown = find(world.world().cables(), cable) < 0;
  require(apply_set_tension(world.world(), cable, change, python_words()), unknown);
}

void set_states(const std::vector<NamedState>& states, DrivenWorld& world) {
  bool unknown = false;
  const EditResult result = apply_set_state(world.world(), states, unknown, python_words());
  require(result, unknown);
}

void move_attachment(const std::string& name, const Pose& offset, DrivenWorld& world) {
  const bool unknown = !is_attached(world.world(), name);
  require(apply_move(world.world(), name, offset), unknown);
}

edit::ApplyLoad checked_force(const std::string& cable, std::int64_t node, RequestedLoad request, const World& world) {
  Location place;
  place.body = cable_id(find(world.cables(), cable));
  if (const auto reason = why_no_cable(world, "cable", cable, python_words())) {
    place.errors.push_back(*reason);
    return checked(std::move(request), place, world);
  }
  const std::int64_t segments = world.cables()[place.body.index].state.segments();
  if (node < 0 || node > segments)
    place.errors.push_back("node: " + std::to_string(node) + "; allowed: 0 to " + std::to_string(segments));
  else
    place.node = static_cast<int>(node);
  return checked(std::move(request), place, world);
}

edit::ApplyLoad checked_wrench(const std::string& body, bool turns, RequestedLoad request, const World& world) {
  Location place;
  place.body = rigid_body_id(find(world.bodies(), body));
  if (place.body.index < 0) {
    NameList names;
    for (const SimulatedBody& other : world.bodies())
      if (!other.is_junction) names.add(other.name);
    place.errors.push_back("body: " + in_quotes(body) + "; allowed: " + names.text("none, there are no bodies"));
  }
  if (turns) request.frame_id = body;
  return checked(std::move(request), place, world);
}

void set_obstacle(const ObstacleDesc& desc, DrivenWorld& world) {
  const std::vector<std::string>& names = world.world().frames();
  const std::size_t frames = names.size();
  Obstacle obstacle = obstacle_of(desc);
  const auto frame = desc.frame.empty() ? names.begin() : std::find(names.begin(), names.end(), desc.frame);
  obstacle.frame = static_cast<int>(frame - names.begin());
  if (frame != names.end()) return require(world.world().apply(edit::SetObstacle{std::move(obstacle)}));
  World trial = world.world();  // a frame cannot be taken back
  const std::optional<Pose> pose = world.frame_pose(desc.frame);
  trial.add_frame(desc.frame, pose ? *pose : desc.initial_pose ? pose_of(*desc.initial_pose) : Pose{});
  require(trial.apply(edit::SetObstacle{std::move(obstacle)}));
  world.world() = std::move(trial);
  world.follow_frames_from(frames);
}

void remove_obstacle(const std::string& name, DrivenWorld& world) {
  NameList names;
  for (const Obstacle& other : world.world().obstacles()) {
    if (other.name == name) return require(world.world().apply(edit::RemoveObstacle{name}));
    names.add(other.name);
  }
  throw UnknownName("name: " + in_quotes(name) + "; allowed: " + names.text("none, there is none"));
}

void tune(const std::vector<NumberChange>& changes, DrivenWorld& world) {
  if (changes.empty()) return;
  // A material that bends unequally may do so again after it was tuned to bend equally.
  const std::vector<TunableNumber> numbers = tunable_numbers(world.scene_at_first());
  world.tune(std::make_shared<SceneDesc>(tuned_scene(world.scene(), numbers, changes)));
}

}  // namespace verlet_cable
