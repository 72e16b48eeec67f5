#include "edit_requests/named_edits.h"
#include "simulation/edit_result.h"
#include "simulation/simulation.h"
#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
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
  if (started_ && !paused) go_on_from(grid_.step_at_or_before(target()));
  return done(paused ? "paused" : "running");
}

EditResult Simulation::pin(const std::string& name, const CheckedPin& pin, AttachmentType type) {
  if (!started_) return refused_before_start();
  if (const auto reason = refused_frame("frame_id", pin.frame)) return *reason;
  EditResult result = apply_pin(world_, name, pin, type);
  if (!result.ok) return result;
  frames_.add(pin.frame, stamp_);
  const Attachment& attachment = world_.attachments()[find(world_.attachments(), result.name)];
  announce(CableEvent::PINNED, subject_of(world_, attachment), result.message);
  return result;
}

EditResult Simulation::unpin(const std::string& name) {
  if (!started_) return refused_before_start();
  const int index = find(world_.attachments(), name);
  const EventSubject subject = index < 0 ? EventSubject{} : subject_of(world_, world_.attachments()[index]);
  EditResult result = apply_unpin(world_, name);
  if (!result.ok) return result;
  moves_.forget(name);
  announce(CableEvent::UNPINNED, subject, result.message);
  return result;
}

EditResult Simulation::move_attachment(const std::string& name, const Pose& offset) {
  if (!started_) return refused_before_start();
  const int index = find(world_.attachments(), name);
  if (index < 0) return refused_attachment(world_, name);
  moves_.send(name, world_.attachments()[index].pose, offset);
  return done("attachment " + in_quotes(name) + " moves to its new place");
}

EditResult Simulation::cut(const Location& place) {
  if (!started_) return refused_before_start();
  const PlacedEdit cut = apply_cut(world_, place);
  if (cut.result.ok) announce(CableEvent::CUT, {name_of(world_, place.body), {}, cut.node, cut.result.name}, cut.result.message);
  return cut.result;
}

EditResult Simulation::set_length(const std::string& cable, bool at_end, double length, double speed, double max_tension) {
  if (!started_) return refused_before_start();
  return apply_set_length(world_, cable, at_end, length, speed, max_tension);
}

EditResult Simulation::set_tension(const std::string& cable, const edit::SetTension& change) {
  if (!started_) return refused_before_start();
  return apply_set_tension(world_, cable, change);
}

CheckedLoad Simulation::check_load(const RequestedLoad& request, const RequestedPlace& place) const {
  const FindFrame find = [this](const std::string& frame) { return find_frame(frame); };
  return verlet_cable::check_load(request, locate_node(place, world_, find), world_, find);
}

EditResult Simulation::apply_load(const edit::ApplyLoad& load) {
  if (!started_) return refused_before_start();
  return verlet_cable::apply_load(world_, load);
}

EditResult Simulation::join(const std::string& first, bool first_at_end, const std::string& second, bool second_at_end) {
  if (!started_) return refused_before_start();
  const PlacedEdit join = apply_join(world_, first, first_at_end, second, second_at_end);
  if (join.result.ok) announce(CableEvent::JOINED, {join.result.name, {}, join.node, second}, join.result.message);
  return join.result;
}

}  // namespace verlet_cable
