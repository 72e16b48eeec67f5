#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/simulation.h"
#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

EditResult done(const std::string& message) {
  return {true, message, {}};
}
EditResult refused(const std::string& message) {
  return {false, message, {}};
}

}  // namespace

EditResult Simulation::refused_before_start() const {
  const std::string what = "the simulation has not started: ";
  if (start_) return refused(what + "its scene is being built");
  return refused(what + (now() == 0 ? "there is no ROS time yet (use_sim_time without /clock?)"
                                    : "it waits for its tf frames, but no longer than tf_timeout"));
}

EditResult Simulation::set_paused(bool paused) {
  if (paused == paused_) return done(paused ? "it is paused already" : "it is running already");
  paused_ = paused;
  if (!paused) interrupt_steps("the pause has ended");
  if (started_ && !paused) skip_to(grid_.step_at_or_before(target()));
  return done(paused ? "paused" : "running");
}

EditResult Simulation::pin(const std::string& name, const CheckedPin& pin, AttachmentType type) {
  if (!started_) return refused_before_start();
  if (const auto reason = refused_frame(pin.frame)) return *reason;
  World trial = world_;  // a frame cannot be taken back
  const EditResult result =
      trial.apply(edit::Pin{name, pin.body, pin.node, trial.add_frame(pin.frame, pin.frame_pose), pin.offset, type});
  if (!result.ok) return result;
  world_ = std::move(trial);
  frames_.add(pin.frame, stamp_);
  const std::string message = "node " + std::to_string(pin.node) + " of " + kind_and_name(world_, pin.body) +
                              " is pinned to frame " + quoted(pin.frame) + " as " + quoted(result.name);
  announce(CableEvent::PINNED, subject_of(world_, world_.attachments()[find(world_.attachments(), result.name)]), message);
  return {true, message, result.name};
}

EditResult Simulation::unpin(const std::string& name) {
  if (!started_) return refused_before_start();
  const int index = find(world_.attachments(), name);
  if (index < 0) return refused_attachment(name);
  const EventSubject subject = subject_of(world_, world_.attachments()[index]);
  const EditResult result = world_.apply(edit::Unpin{name});
  if (!result.ok) return result;
  moves_.forget(name);
  const std::string message = "attachment " + quoted(name) + " is released";
  announce(CableEvent::UNPINNED, subject, message);
  return done(message);
}

EditResult Simulation::move_attachment(const std::string& name, const Pose& offset) {
  if (!started_) return refused_before_start();
  const int index = find(world_.attachments(), name);
  if (index < 0) return refused_attachment(name);
  moves_.send(name, world_.attachments()[index].pose, offset);
  return done("attachment " + quoted(name) + " moves to its new place");
}

EditResult Simulation::refused_attachment(const std::string& name) const {
  std::string names;
  for (const Attachment& attachment : world_.attachments())
    if (is_named(attachment)) names += (names.empty() ? "" : ", ") + attachment.name;
  return refused("name: " + quoted(name) +
                 " is no attachment; allowed: " + (names.empty() ? "none, nothing is attached" : names));
}

EditResult Simulation::cut(const BodyId& body, const std::vector<int>& elements) {
  if (!started_) return refused_before_start();
  const std::string what = kind_and_name(world_, body);
  const int node = body.is_net() ? world_.nets()[body.index].model.links[elements.front()][0] : elements.front();
  EditResult result;
  for (auto element = elements.rbegin(); element != elements.rend(); ++element) {
    result = world_.apply(edit::Cut{body, *element});
    if (!result.ok) return result;
  }
  result.message = body.is_net()
                       ? std::to_string(elements.size()) + (elements.size() == 1 ? " link" : " links") + " of " + what + " cut"
                       : "segment " + std::to_string(node) + " of " + what +
                             " is cut out: the part from there to its end is now cable " + verlet_cable::quoted(result.name);
  announce(CableEvent::CUT, {name_of(world_, body), {}, node, result.name}, result.message);
  return result;
}

/// Why there is no such cable; nothing if there is.
std::optional<EditResult> Simulation::refused_cable(const std::string& field, const std::string& cable) const {
  if (find(world_.cables(), cable) >= 0) return std::nullopt;
  const std::vector<std::string>& waiting = world_.findings().waiting;
  if (std::find(waiting.begin(), waiting.end(), cable) != waiting.end())
    return refused(field + ": " + quoted(cable) + " waits for its tf frames; allowed: cables that are simulated already");
  std::string names;
  for (const SimulatedCable& other : world_.cables()) names += (names.empty() ? "" : ", ") + other.model->name;
  return refused(field + ": " + quoted(cable) + "; allowed: " + (names.empty() ? "none, there are no cables" : names));
}

EditResult Simulation::set_length(const std::string& cable, bool at_end, double length, double speed) {
  if (!started_) return refused_before_start();
  if (const auto reason = refused_cable("cable", cable)) return *reason;
  const int index = find(world_.cables(), cable);
  const double before = world_.cables()[index].state.length();
  const EditResult result = world_.apply(edit::SetLength{index, at_end, length, speed});
  if (!result.ok) return result;
  return done("cable " + quoted(cable) + (length < before ? " is taken in from " : " is paid out from ") + rounded_text(before) +
              " m to " + number_text(length) + " m, which takes at least " + rounded_text(std::abs(length - before) / speed, 3) +
              " s");
}

EditResult Simulation::join(const std::string& first, bool first_at_end, const std::string& second, bool second_at_end) {
  if (!started_) return refused_before_start();
  if (const auto reason = refused_cable("first", first)) return *reason;
  if (const auto reason = refused_cable("second", second)) return *reason;
  const int nodes = world_.cables()[find(world_.cables(), first_at_end ? first : second)].state.nodes();
  const EditResult result =
      world_.apply(edit::Join{find(world_.cables(), first), first_at_end, find(world_.cables(), second), second_at_end});
  if (!result.ok) return result;
  const std::string message = "cable " + quoted(second) + " is joined to " + quoted(first);
  announce(CableEvent::JOINED, {result.name, {}, nodes - 1, second}, message);
  return {true, message, result.name};
}

}  // namespace verlet_cable
