#include "verlet_cable/core/sensitivity.h"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <utility>

#include "sensitivity/cable_sensitivity.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "world/implementation.h"

namespace verlet_cable {

namespace {

using Kind = SensitivityColumn::Kind;

struct NamedKind {
  const char* name;
  Kind kind;
  double MaterialDesc::*value;
};
constexpr std::array<NamedKind, 5> of_materials{{{"axial_stiffness", Kind::axial_stiffness, &MaterialDesc::axial_stiffness},
                                                 {"axial_damping", Kind::axial_damping, &MaterialDesc::axial_damping},
                                                 {"bending_damping", Kind::bending_damping, &MaterialDesc::bending_damping},
                                                 {"drag", Kind::drag, &MaterialDesc::drag},
                                                 {"linear_density", Kind::linear_density, &MaterialDesc::linear_density}}};
/// Reads names of parameters.
class ParameterReader {
 public:
  ParameterReader(const State& state, bool is_settled) : state_(state), is_settled_(is_settled) {}

  void read(const std::string& text, std::vector<SensitivityColumn>& columns) {
    name_ = text;
    if (text == "gravity") {
      for (int axis = 0; axis < 3; ++axis) columns.push_back({Kind::gravity, -1, -1, axis});
      return;
    }
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) return refuse(Sensitivity::parameter_words);
    const std::string key = text.substr(0, colon), name = text.substr(colon + 1);
    if (key == "pose") return read_pose(name, columns);
    const auto material =
        std::find_if(of_materials.begin(), of_materials.end(), [&](const NamedKind& k) { return key == k.name; });
    const bool bends = key == "bending_stiffness", is_length = key == "length";
    if (material == of_materials.end() && !bends && !is_length) return refuse(Sensitivity::parameter_words);
    const int cable = find(state_.cables, name);
    if (cable < 0) {
      NameList names;
      for (const SimulatedCable& other : state_.cables) names.add(other.model->name);
      return refuse("cables: " + names.text());
    }
    if (is_length) {
      if (!is_settled_) return refuse_start();
      columns.push_back({Kind::length, cable});
      return;
    }
    const MaterialDesc& values = state_.cables[cable].model->material;
    const double value = bends ? values.bending_stiffness.largest() : values.*(material->value);
    const Kind kind = bends ? Kind::bending_stiffness : material->kind;
    if (!(value < infinity)) return refuse("where it is finite; it is .inf");
    const bool is_law = kind == Kind::bending_stiffness || kind == Kind::bending_damping;
    if (is_law && !(value > 0)) return refuse("where it is above 0; it is 0");
    columns.push_back({kind, cable});
  }

  std::vector<std::string> errors;

 private:
  void read_pose(const std::string& name, std::vector<SensitivityColumn>& columns) {
    const int frame = state_.frames.find(name);
    if (frame <= 0 || frame >= static_cast<int>(state_.frames.names.size()) || state_.body_of_frame(frame) >= 0) {
      NameList names;
      for (int i = 1; i < static_cast<int>(state_.frames.names.size()); ++i)
        if (state_.body_of_frame(i) < 0) names.add(state_.frames.names[i]);
      return refuse("frames: " + names.text("none, there is none that moves"));
    }
    if (!is_settled_) return refuse_start();
    for (const Kind kind : {Kind::translation, Kind::rotation})
      for (int axis = 0; axis < 3; ++axis) columns.push_back({kind, -1, frame, axis});
  }
  void refuse(const std::string& allowed) { errors.push_back("parameters: " + in_quotes(name_) + "; allowed: " + allowed); }
  void refuse_start() { refuse("of a start that is settled: a given state does not go together with another length or pose"); }

  const State& state_;
  bool is_settled_;
  std::string name_;
};

std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

}  // namespace

struct Sensitivity::Implementation {
  std::vector<std::string> parameters;
  std::vector<SensitivityColumn> columns;
  std::vector<CableSensitivity> cables;                   ///< those that depend on a parameter
  std::map<int, std::string> lost;                        ///< by cable: why
  std::vector<std::shared_ptr<const CableModel>> models;  ///< of all cables, at the start

  /// nullptr: it does not depend on any.
  const CableSensitivity* find(int cable) const {
    for (const CableSensitivity& c : cables)
      if (c.cable() == cable) return &c;
    return nullptr;
  }
  void lose(int cable, double time, const std::string& why) {
    lost.emplace(cable, "at t = " + rounded_text(time, 6) + " s: " + why);
  }
};

namespace {

bool depends_on(int cable, const SensitivityColumn& column, const State& state) {
  if (column.cable >= 0) return column.cable == cable;
  if (column.frame < 0) return true;
  return std::any_of(state.attachments.begin(), state.attachments.end(), [&](const Attachment& attachment) {
    return attachment.body == cable_id(cable) && attachment.frame == column.frame;
  });
}

}  // namespace

const char* const Sensitivity::parameter_words =
    "KEY:CABLE with a key axial_stiffness, axial_damping, bending_stiffness, bending_damping, drag or linear_density; "
    "length:CABLE, pose:FRAME, gravity";

Sensitivity::Sensitivity(const World& world, const std::vector<std::string>& parameters, Start start)
    : implementation_(std::make_unique<Implementation>()) {
  const State& state = world.implementation_->state;
  Implementation& own = *implementation_;
  own.parameters = parameters;
  for (const SimulatedCable& cable : state.cables) own.models.push_back(cable.model);
  ParameterReader reader(state, start == Start::settled);
  for (const std::string& parameter : parameters) reader.read(parameter, own.columns);
  if (parameters.empty()) reader.errors.push_back(std::string("parameters: none; allowed: ") + parameter_words);
  for (int cable = 0; cable < static_cast<int>(state.cables.size()); ++cable) {
    const bool depends = std::any_of(own.columns.begin(), own.columns.end(),
                                     [&](const SensitivityColumn& column) { return depends_on(cable, column, state); });
    if (!depends) continue;
    std::string problem = CableSensitivity::unsupported(cable, state);
    if (problem.empty()) {
      own.cables.emplace_back(cable, state, own.columns);
      if (start == Start::settled) problem = own.cables.back().settle(state);
    }
    if (!problem.empty())
      reader.errors.push_back("cable " + in_quotes(state.cables[cable].model->name) + " has no derivatives: " + problem);
  }
  if (!reader.errors.empty()) throw std::invalid_argument(text_of(reader.errors));
}

Sensitivity::Sensitivity(Sensitivity&&) noexcept = default;
Sensitivity& Sensitivity::operator=(Sensitivity&&) noexcept = default;
Sensitivity::~Sensitivity() = default;

const std::vector<std::string>& Sensitivity::parameters() const {
  return implementation_->parameters;
}

int Sensitivity::columns() const {
  return static_cast<int>(implementation_->columns.size());
}

StepResult Sensitivity::step(World& world, const BoundaryInputs& inputs) {
  Implementation& own = *implementation_;
  const World::Implementation& w = *world.implementation_;
  const double time = world.time() + world.time_step();
  for (CableSensitivity& c : own.cables) {
    if (own.lost.count(c.cable()) > 0) continue;
    if (c.cable() >= static_cast<int>(w.state.cables.size())) {
      own.lose(c.cable(), time, "it is another world");
      continue;
    }
    const std::string problem = c.begin_step(w.state);
    if (!problem.empty()) own.lose(c.cable(), time, problem);
  }
  const StepResult result = world.step(inputs);
  for (CableSensitivity& c : own.cables) {
    const int cable = c.cable();
    if (own.lost.count(cable) > 0) continue;
    const auto is_of_cable = [&](const SimulatedContact& contact) {
      return contact.cable == cable || contact.other_cable == cable;
    };
    const std::vector<SimulatedContact>& contacts = w.findings.contacts;
    const CableOutcome& outcome = w.cable_outcomes.value[cable];
    std::string problem;
    if (outcome.gave_way || std::any_of(contacts.begin(), contacts.end(), is_of_cable))
      problem = "it touches something";
    else if (outcome.result.substeps > 1)
      problem = "its step is split into substeps";
    else
      problem = c.end_step(w.state);
    if (!problem.empty()) own.lose(cable, time, problem);
  }
  return result;
}

std::string Sensitivity::lost(const World& world, int cable) const {
  const Implementation& own = *implementation_;
  const State& state = world.implementation_->state;
  const auto found = own.lost.find(cable);
  if (found != own.lost.end()) return found->second;
  const bool is_known = cable < static_cast<int>(own.models.size()) && state.cables[cable].model == own.models[cable];
  if (!is_known) return "it was edited, or came later";
  const CableSensitivity* const followed = own.find(cable);
  return followed != nullptr ? followed->changed(state) : std::string();
}

namespace {

template <class Read>
void read_or_zero(const CableSensitivity* cable, std::size_t rows, int columns, double* to, const Read& read) {
  if (cable != nullptr)
    read(*cable);
  else
    std::fill_n(to, rows * static_cast<std::size_t>(columns), 0.0);
}

}  // namespace

void Sensitivity::read_positions(const World& world, int cable, double* to) const {
  read_or_zero(implementation_->find(cable), 3 * world.cables()[cable].state.positions.size(), columns(), to,
               [&](const CableSensitivity& c) { c.read_positions(to); });
}

void Sensitivity::read_velocities(const World& world, int cable, double* to) const {
  read_or_zero(implementation_->find(cable), 3 * world.cables()[cable].state.positions.size(), columns(), to,
               [&](const CableSensitivity& c) { c.read_velocities(to); });
}

void Sensitivity::read_tension(const World& world, int cable, double* to) const {
  read_or_zero(implementation_->find(cable), world.cables()[cable].state.tension.size(), columns(), to,
               [&](const CableSensitivity& c) { c.read_tension(to); });
}

void Sensitivity::read_wrench(const World& world, int attachment, double* to) const {
  const Attachment& held = world.attachments()[attachment];
  read_or_zero(held.body.is_cable() ? implementation_->find(held.body.index) : nullptr, 6, columns(), to,
               [&](const CableSensitivity& c) { c.read_wrench(attachment, to); });
}

}  // namespace verlet_cable
