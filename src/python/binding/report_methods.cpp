#include <cstdint>
#include <string>

#include "binding/contact_array.h"
#include "binding/edit_methods.h"
#include "binding/named_tuple.h"
#include "binding/text_arguments.h"
#include "verlet_cable/core/body_name.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

py::list load_list(const World& world, const py::object& load_type) {
  py::list list;
  for (const Load& load : world.loads()) {
    const double left = load.end_step == 0 ? infinity : static_cast<double>(load.end_step - world.steps()) * world.time_step();
    list.append(load_type(load.name, name_of(world, load.body), load.body.is_cable() ? load.node : -1, array_of(load.force),
                          array_of(load.torque), array_of(load.point), load.is_local, left));
  }
  return list;
}

py::list take_events(EventRecord& record, const py::object& event_type) {
  const EventRecord::Taken taken = record.take();
  py::list list;
  for (const auto& [time, type, subject, message] : taken.events)
    list.append(event_type(time, type, subject.cable, subject.attachment, subject.node, subject.other, message));
  if (taken.left_out > 0)
    list.append(event_type(taken.last_time, "more", "", "", 0, "", std::to_string(taken.left_out) + " more events"));
  return list;
}

double arc_length_at(const World& world, const std::string& guide) {
  NameList names;
  for (std::size_t i = 0; i < world.guides().size(); ++i) {
    if (world.guides()[i].name == guide) {
      const GuideView view = world.view_guide(static_cast<int>(i));
      if (view.cable >= 0) return view.arc_length;
      throw py::value_error("guide: " + in_quotes(guide) + " has no cable in it; allowed: guides that have one");
    }
    names.add(world.guides()[i].name);
  }
  throw UnknownName("guide: " + in_quotes(guide) + "; allowed: " + names.text("none, there are no guides"));
}

}  // namespace

void add_report_methods(py::module_& module, WorldMethods& methods) {
  const py::object load_type = add_tuple(
      module, "Load", {"name", "on", "node", "force", "torque", "point", "local", "time_left"},
      "A load on a cable or body: its name; the name of the cable or body; the node, or -1 for a body; force (3,) [N] "
      "and torque (3,) [N m]; for a body the point (3,) [m] where the force acts, and whether it is in the body's axes; "
      "and for how long [s] it still acts, inf: until it is changed.");
  methods.add_reader(
      "loads", [load_type](PythonWorld& self) { return load_list(self.world(), load_type); },
      "List of the loads that act in the next step, as Load(name, on, node, force, torque, point, local, time_left).");
  const py::object event_type = add_tuple(module, "Event", {"time", "type", "cable", "attachment", "node", "other", "message"},
                                          "An event of a world: the fields of CableEvent.msg, with the simulated `time` [s] and "
                                          "the name of the constant as `type`. Fields that do not apply are '' or 0.");
  methods.add_reader(
      "events", [event_type](PythonWorld& self) { return take_events(self.events(), event_type); },
      "List of Event(time, type, cable, attachment, node, other, message) since the last call, in the order of their times, with "
      "the types of cable_sim. At once: 'CUT', 'BROKE', 'PINNED', 'UNPINNED', 'JOINED', 'LIMIT', 'CAUGHT', 'RELEASED', 'JUMPED' "
      "(at most once a second for each frame), 'LOAD_ENDED' (attachment: the load), 'ENERGY' (once until it stops) and "
      "'not_fitted' (the initial shape). When "
      "they begin, and with '_end' when they were not there for 0.1 s: 'overstretched', 'inside_obstacle' (other: the obstacle), "
      "'not_settled', 'degraded', 'FAULT', 'frame_too_fast' and 'frame_out_of_range' (other: the frame); the time of an end is "
      "that of the last step they were there. After the first 1000, one event of type 'more' states how many were left out. A "
      "copy of a world has the events that were not retrieved yet.");
  methods.add_reader(
      "contacts", [](PythonWorld& self) { return contact_array(self.world()); },
      "Where cables touched obstacles, bodies and cables in the last step: a structured array with the fields of Contact.msg "
      "after that of the cable: cable, segment, position (3,) [m] on its centre line, normal (3,) out of what is touched, "
      "force (3,) [N] on the cable, mean over the step, and other, the name of what is touched. Contacts of cables with "
      "cables are there twice, once for each. After an edit there are none until the next step.");
  methods.add_reader(
      "ledger", [](PythonWorld& self) { return ledger_dict(self.world().ledger()); },
      "Where energy [J] has come from and gone since the start: a dict with the dicts work (attachments, winches, obstacles, "
      "applied) and dissipated (axial, bending, torsional, yielding, drag, contact, guides, bodies, unresolved, edits), change "
      "(of "
      "energy()['total']), unaccounted (change - work + dissipated: rounding and tolerances) and unaccounted_steps (in which "
      "that was too much).");
  methods.add_reader(
      "arc_length", [](PythonWorld& self, const py::str& guide) { return arc_length_at(self.world(), text_of(guide, "guide")); },
      py::arg("guide"),
      "[m] at rest from the start of a cable to what of it is in a guide; of a sheave, to the middle of its wheel. Raises "
      "KeyError, "
      "ValueError if no cable is in the guide.");
  methods.add_reader(
      "save", [](PythonWorld& self) { return py::bytes(self.driven().save()); },
      "The world as bytes, from which World.load goes on with the same bytes as a copy would: its state, motion and poses that "
      "were set, but not its events. They are for this version of the package on this kind of machine. A pickle has them with "
      "the scene.");
}

}  // namespace verlet_cable
