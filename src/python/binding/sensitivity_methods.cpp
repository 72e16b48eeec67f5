#include "binding/sensitivity_methods.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "binding/arguments.h"
#include "binding/run_steps.h"
#include "binding/text_arguments.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/sensitivity.h"

namespace verlet_cable {
namespace {

constexpr const char* allowed_outputs = "positions:CABLE, velocities:CABLE, tension:CABLE, wrench:ATTACHMENT";

/// Derivatives of one output: `rows` numbers of it, the derivatives of each side by side.
struct Output {
  std::string text, key;           ///< 'positions:hose', 'positions'
  int attachment = -1;             ///< of a wrench
  std::vector<py::ssize_t> shape;  ///< of the output itself
  int cable = -1;                  ///< that it is of; -1: a body or net
  std::vector<double> derivatives;
};

/// `words`: what each of them may be.
std::vector<std::string> texts_of(const py::object& given, const char* argument, const char* words) {
  std::vector<std::string> texts;
  if (py::isinstance<py::str>(given)) {
    texts.push_back(text_of(given, argument));
    return texts;
  }
  const auto refuse = [&](const py::handle& wrong) {
    throw py::type_error(std::string(argument) + ": " + ascii_text(wrong) + "; allowed: a text, or a list of texts: " + words);
  };
  if (!py::isinstance<py::list>(given) && !py::isinstance<py::tuple>(given)) refuse(given);
  for (const py::handle text : given) {
    if (!py::isinstance<py::str>(text)) refuse(text);
    texts.push_back(text_of(text, argument));
  }
  return texts;
}

/// An output by its name: what is to be read, but no derivatives.
Output find_output(const World& world, const std::string& text) {
  const std::size_t colon = text.find(':');
  Output output;
  output.text = text;
  output.key = text.substr(0, colon);
  const std::string name = colon == std::string::npos ? "" : text.substr(colon + 1);
  const auto refuse = [&](const std::string& allowed) {
    throw std::invalid_argument("outputs: " + in_quotes(text) + "; allowed: " + allowed);
  };
  const bool is_wrench = output.key == "wrench";
  if (colon == std::string::npos ||
      (!is_wrench && output.key != "positions" && output.key != "velocities" && output.key != "tension"))
    refuse(allowed_outputs);
  NameList names;
  if (is_wrench) {
    output.attachment = find(world.attachments(), name);
    for (const Attachment& other : world.attachments())
      if (is_named(other) && other.body.is_cable()) names.add(other.name);
    if (output.attachment < 0 || !is_named(world.attachments()[output.attachment]) ||
        !world.attachments()[output.attachment].body.is_cable())
      refuse("attachments of cables: " + names.text("none, there is none"));
    output.cable = world.attachments()[output.attachment].body.index;
    output.shape = {6};
  } else {
    for (const SimulatedCable& cable : world.cables()) names.add(cable.model->name);
    output.cable = find(world.cables(), name);
    if (output.cable < 0) refuse("cables: " + names.text("none, there is none"));
    const CableState& state = world.cables()[output.cable].state;
    if (output.key == "tension")
      output.shape = {state.segments()};
    else
      output.shape = {state.nodes(), 3};
  }
  return output;
}

void read(const World& world, const Sensitivity& sensitivity, Output& output) {
  if (const std::string lost = sensitivity.lost(world, output.cable); !lost.empty())
    throw py::value_error("outputs: " + in_quotes(output.text) + " has no derivatives any longer, " + lost +
                          "; allowed: cables of which derivatives are followed, as anew after another track_sensitivity()");
  std::size_t size = static_cast<std::size_t>(sensitivity.columns());
  for (const py::ssize_t length : output.shape) size *= static_cast<std::size_t>(length);
  output.derivatives.resize(size);
  double* const to = output.derivatives.data();
  if (output.key == "wrench")
    sensitivity.read_wrench(world, output.attachment, to);
  else if (output.key == "positions")
    sensitivity.read_positions(world, output.cable, to);
  else if (output.key == "velocities")
    sensitivity.read_velocities(world, output.cable, to);
  else
    sensitivity.read_tension(world, output.cable, to);
}

int columns_of(const std::string& parameter) {
  if (parameter == "gravity") return 3;
  return parameter.compare(0, 5, "pose:") == 0 ? 6 : 1;
}

/// Columns of some of the parameters that are followed.
std::vector<std::size_t> chosen_columns(const Sensitivity& sensitivity, const std::vector<std::string>& wanted) {
  std::vector<std::size_t> chosen;
  for (const std::string& parameter : wanted) {
    std::size_t first = 0;
    bool is_found = false;
    for (const std::string& followed : sensitivity.parameters()) {
      const auto columns = static_cast<std::size_t>(columns_of(followed));
      if (followed == parameter && !is_found) {
        is_found = true;
        for (std::size_t k = 0; k < columns; ++k) chosen.push_back(first + k);
      }
      first += columns;
    }
    if (!is_found)
      throw py::value_error("parameters: " + in_quotes(parameter) + "; allowed: those that are followed, " +
                            NameList(sensitivity.parameters()).text());
  }
  return chosen;
}

py::array_t<double> array_of(const Output& output, std::size_t all, const std::vector<std::size_t>& columns) {
  std::vector<py::ssize_t> shape = output.shape;
  shape.push_back(static_cast<py::ssize_t>(columns.size()));
  py::array_t<double> array(shape);
  double* to = array.mutable_data();
  for (std::size_t row = 0; row < output.derivatives.size() / all; ++row)
    for (const std::size_t column : columns) *to++ = output.derivatives[row * all + column];
  return read_only(array);
}

void track(PythonWorld& self, const py::object& parameters, const py::str& start) {
  InUse::check(self.busy(), self.used());
  std::optional<Sensitivity>* const tracked = self.tracked();
  if (tracked == nullptr) throw py::value_error("track_sensitivity: a world of a Batch; allowed: a copy() of it");
  if (parameters.is_none()) {
    tracked->reset();
    return;
  }
  const std::string from = text_of(start, "start");
  if (from != "settled" && from != "given") throw py::value_error("start: " + in_quotes(from) + "; allowed: 'settled', 'given'");
  self.driven().require_placed_frames();
  *tracked = Sensitivity(self.world(), texts_of(parameters, "parameters", Sensitivity::parameter_words),
                         from == "settled" ? Sensitivity::Start::settled : Sensitivity::Start::given);
}

py::object sensitivity(PythonWorld& self, const py::object& outputs, const py::object& parameters) {
  const World& world = self.world();
  const std::optional<Sensitivity>* const tracked = self.tracked();
  const bool is_tracked = tracked != nullptr && tracked->has_value();
  const std::vector<std::string> asked = texts_of(outputs, "outputs", allowed_outputs);
  std::vector<std::string> wanted;
  if (!parameters.is_none()) wanted = texts_of(parameters, "parameters", Sensitivity::parameter_words);
  std::vector<Output> read_ones;
  std::optional<Sensitivity> of_equilibrium;
  std::string errors;  // one a line, of both arguments
  const auto attempt = [&](const auto& act) {
    try {
      act();
    } catch (const std::invalid_argument& error) {
      errors += (errors.empty() ? "" : "\n") + std::string(error.what());
    }
  };
  if (asked.empty()) errors = std::string("outputs: []; allowed: ") + allowed_outputs;
  for (const std::string& text : asked) attempt([&] { read_ones.push_back(find_output(world, text)); });
  if (!is_tracked)
    attempt([&] {
      if (parameters.is_none())
        throw std::invalid_argument(std::string("parameters: None; allowed: ") + Sensitivity::parameter_words +
                                    "; or none after track_sensitivity()");
      of_equilibrium.emplace(world, wanted, Sensitivity::Start::settled);
    });
  if (!errors.empty()) throw py::value_error(errors);
  const Sensitivity& found = is_tracked ? **tracked : *of_equilibrium;
  const auto all = static_cast<std::size_t>(found.columns());
  const std::vector<std::size_t> columns = chosen_columns(found, parameters.is_none() ? found.parameters() : wanted);
  for (Output& output : read_ones) read(world, found, output);
  if (py::isinstance<py::str>(outputs)) return array_of(read_ones.front(), all, columns);
  py::dict arrays;
  for (const Output& output : read_ones) arrays[py::str(output.text)] = array_of(output, all, columns);
  return std::move(arrays);
}

}  // namespace

void add_sensitivity_methods(py::class_<PythonWorld>& world) {
  world
      .def(
          "sensitivity", sensitivity, py::arg("outputs"), py::arg("parameters") = py::none(),
          "Derivatives of `outputs` with respect to `parameters`, by implicit differentiation of the equations that have been "
          "solved, not by differences. Without track_sensitivity(): of the equilibrium at which the world is, after settle() for "
          "example. After it: of the state now, with respect to parameters that have been constant since then; `parameters` are "
          "all that are followed, or some of them.\n\n"
          "An output is 'positions:CABLE' [m], 'velocities:CABLE' [m/s], 'tension:CABLE' [N] or 'wrench:ATTACHMENT' [N, N m]. "
          "The array has the shape of what the method of this name returns, and one more axis, for the columns of the "
          "parameters in their order: (n + 1, 3, columns), (n, columns) or (6, columns). For one output, as a text, it is "
          "returned; "
          "for a list of outputs a dict of arrays.\n\n"
          "A parameter is 'KEY:CABLE' with a key of the material of that cable (of it alone): axial_stiffness, axial_damping, "
          "bending_stiffness, bending_damping, drag or linear_density, in the units of the scene; 'length:CABLE' [m], all "
          "segments growing alike; 'pose:FRAME', six columns: by how much the frame is moved along the axes of the fixed frame "
          "[m] "
          "and turned about them at its origin [rad]; 'gravity', three columns [m/s^2].\n\n"
          "There are derivatives of cables that frames hold, and that are straight unloaded and as stiff about one axis as about "
          "any other, without sections, guides, winches, bodies or water. Raises ValueError that says why there are none.")
      .def(
          "track_sensitivity", track, py::arg("parameters"), py::arg("start") = "settled",
          "From now on, steps carry along the derivatives of the state with respect to `parameters`, as sensitivity() has them. "
          "`start`: 'settled': the world is at an equilibrium, which depends on the parameters; 'given': its state now does not "
          "depend on them (not for 'length' and 'pose', with which it would not go together). With `parameters` None, they are "
          "forgotten. They end, and sensitivity() says why, when a cable touches something, has to be stepped in several "
          "substeps, is edited or tuned, or jumps with its frame. Copies and saved worlds do not have them. Trajectories are the "
          "same with and without; for each eight columns, a step takes about as long as twenty without.\n\nRaises ValueError as "
          "sensitivity().");
}

}  // namespace verlet_cable
