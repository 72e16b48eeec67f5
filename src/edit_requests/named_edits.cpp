#include "edit_requests/named_edits.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "edit_requests/error_text.h"
#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {

EditResult apply_pin(World& world, const std::string& name, const CheckedPin& pin, AttachmentType type) {
  World trial = world;  // a frame cannot be taken back
  const EditResult result =
      trial.apply(edit::Pin{name, pin.body, pin.node, trial.add_frame(pin.frame, pin.frame_pose), pin.offset, type});
  if (!result.ok) return result;
  world = std::move(trial);
  return {true,
          "node " + std::to_string(pin.node) + " of " + kind_and_name(world, pin.body) + " is pinned to frame " +
              in_quotes(pin.frame) + " as " + in_quotes(result.name),
          result.name};
}

EditResult apply_unpin(World& world, const std::string& name) {
  if (find(world.attachments(), name) < 0) return refused_attachment(world, name);
  const EditResult result = world.apply(edit::Unpin{name});
  if (!result.ok) return result;
  return {true, "attachment " + in_quotes(name) + " is released", {}};
}

EditResult apply_move(World& world, const std::string& name, const Pose& offset) {
  if (find(world.attachments(), name) < 0) return refused_attachment(world, name);
  std::vector<std::string> errors;
  const Pose pose = read_pose("offset", offset, errors);
  if (!errors.empty()) return refused(errors);
  const EditResult result = world.apply(edit::MoveAttachment{name, pose});
  if (!result.ok) return result;
  return {true, "attachment " + in_quotes(name) + " is moved in its frame", {}};
}

PlacedEdit apply_cut(World& world, const Location& place) {
  const std::vector<int>& elements = place.elements;
  const std::string what = kind_and_name(world, place.body);
  EditResult result;
  for (auto element = elements.rbegin(); element != elements.rend(); ++element) {
    result = world.apply(edit::Cut{place.body, *element});
    if (!result.ok) return {result, place.node};
  }
  result.message = place.body.is_net()
                       ? std::to_string(elements.size()) + (elements.size() == 1 ? " link" : " links") + " of " + what + " cut"
                       : "segment " + std::to_string(place.node) + " of " + what +
                             " is cut out: the part from there to its end is now cable " + verlet_cable::in_quotes(result.name);
  return {result, place.node};
}

EditResult apply_set_length(World& world, const std::string& cable, bool at_end, double length, double speed, double max_tension,
                            const RequestWords& words) {
  if (const auto reason = why_no_cable(world, "cable", cable, words)) return refused({*reason});
  const int index = find(world.cables(), cable);
  const double before = world.cables()[index].state.length();
  const EditResult result = world.apply(edit::SetLength{index, at_end, length, speed, max_tension});
  if (!result.ok) return result;
  return {true,
          "cable " + in_quotes(cable) + (length < before ? " is taken in from " : " is paid out from ") + rounded_text(before) +
              " m to " + number_text(length) + " m, which takes at least " + rounded_text(std::abs(length - before) / speed, 3) +
              " s" + (max_tension > 0 ? ", with at most " + number_text(max_tension) + " N" : ""),
          {}};
}

EditResult apply_set_tension(World& world, const std::string& cable, edit::SetTension change, const RequestWords& words) {
  if (const auto reason = why_no_cable(world, "cable", cable, words)) return refused({*reason});
  change.cable = find(world.cables(), cable);
  const EditResult result = world.apply(change);
  if (!result.ok) return result;
  const std::string winch =
      std::string("the winch at the ") + (change.at_end ? "end" : "start") + " of cable " + in_quotes(cable);
  return {true,
          change.tension > 0
              ? winch + " keeps " + number_text(change.tension) + " N, at up to " + number_text(change.max_speed) + " m/s"
              : winch + " turns freely, at up to " + number_text(change.max_speed) + " m/s",
          {}};
}

namespace {

/// Names of the arguments that are given.
std::vector<const char*> given_of(const NamedState& state) {
  std::vector<const char*> given;
  if (state.positions) given.push_back("positions");
  if (state.velocities) given.push_back("velocities");
  if (state.pose) given.push_back("pose");
  if (state.twist) given.push_back("twist");
  if (state.arc_length) given.push_back("arc_length");
  return given;
}

/// Lines for what is given and is not of this kind of thing.
void check_kind(const NamedState& state, const char* kind, const std::vector<std::string>& allowed,
                std::vector<std::string>& errors) {
  for (const char* given : given_of(state))
    if (std::find(allowed.begin(), allowed.end(), given) == allowed.end())
      errors.push_back(std::string(given) + ": of the " + kind + " " + in_quotes(state.name) +
                       "; allowed: " + NameList(allowed).text());
}

int find_guide(const World& world, const std::string& name) {
  const auto& guides = world.guides();
  const auto found = std::find_if(guides.begin(), guides.end(), [&](const SimulatedGuide& guide) { return guide.name == name; });
  return found == guides.end() ? -1 : static_cast<int>(found - guides.begin());
}

int find_body(const World& world, const std::string& name) {
  const int body = find(world.bodies(), name);
  return body >= 0 && world.bodies()[body].is_junction ? -1 : body;
}

/// Names of what can be set.
NameList settable_names(const World& world) {
  NameList names;
  for (const SimulatedCable& cable : world.cables()) names.add(cable.model->name);
  for (const SimulatedBody& body : world.bodies())
    if (!body.is_junction) names.add(body.name);
  for (const SimulatedGuide& guide : world.guides()) names.add(guide.name);
  return names;
}

}  // namespace

EditResult apply_set_state(World& world, const std::vector<NamedState>& states, bool& unknown, const RequestWords& words) {
  std::vector<std::string> errors, strangers;
  edit::SetState set;
  for (const NamedState& state : states) {
    if (const int cable = find(world.cables(), state.name); cable >= 0) {
      check_kind(state, "cable", {"positions", "velocities"}, errors);
      set.cables.push_back({cable, state.positions, state.velocities});
    } else if (const int body = find_body(world, state.name); body >= 0) {
      check_kind(state, "body", {"pose", "twist"}, errors);
      set.bodies.push_back({body, state.pose, {}, {}});
      if (state.twist)
        std::tie(set.bodies.back().velocity, set.bodies.back().angular_velocity) = std::tie((*state.twist)[0], (*state.twist)[1]);
    } else if (const int guide = find_guide(world, state.name); guide >= 0) {
      check_kind(state, "guide", {"arc_length"}, errors);
      if (state.arc_length) set.guides.push_back({guide, *state.arc_length});
    } else if (const auto waits = why_cable_waits(world, "cable", state.name, words)) {
      errors.push_back(*waits);
    } else {
      strangers.push_back("cable: " + in_quotes(state.name) +
                          "; allowed: " + settable_names(world).text("none, there are no cables, bodies and guides"));
    }
  }
  unknown = errors.empty() && !strangers.empty();
  errors.insert(errors.end(), strangers.begin(), strangers.end());
  if (!errors.empty()) return refused(errors);
  return world.apply(set);
}

PlacedEdit apply_join(World& world, const std::string& first, bool first_at_end, const std::string& second, bool second_at_end,
                      const RequestWords& words) {
  if (const auto reason = why_no_cable(world, "first", first, words)) return {refused({*reason})};
  if (const auto reason = why_no_cable(world, "second", second, words)) return {refused({*reason})};
  const int node = world.cables()[find(world.cables(), first_at_end ? first : second)].state.nodes() - 1;
  const EditResult result =
      world.apply(edit::Join{find(world.cables(), first), first_at_end, find(world.cables(), second), second_at_end});
  if (!result.ok) return {result, node};
  return {{true, "cable " + in_quotes(second) + " is joined to " + in_quotes(first), result.name}, node};
}

EditResult refused_attachment(const World& world, const std::string& name) {
  NameList names;
  for (const Attachment& attachment : world.attachments())
    if (is_named(attachment)) names.add(attachment.name);
  const std::string waiting = world.findings().waiting.empty() ? "" : "; what still waits for its frames has none yet";
  return refused(
      {"name: " + in_quotes(name) + " is no attachment; allowed: " + names.text("none, nothing is attached") + waiting});
}

}  // namespace verlet_cable
