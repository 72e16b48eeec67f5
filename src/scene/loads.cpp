#include "verlet_cable/scene/loads.h"

#include <algorithm>
#include <stdexcept>

#include "pose_bytes.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

/// [steps] what rounding may do to the quotient of two times.
constexpr double step_tolerance = 1e-6;

template <class Desc>
const Desc* find(const std::vector<Desc>& descs, const std::string& name) {
  const auto found = std::find_if(descs.begin(), descs.end(), [&](const Desc& desc) { return desc.name == name; });
  return found == descs.end() ? nullptr : &*found;
}

/// Empty if nothing is wrong.
std::string problem_of(const LoadRow& row, const SceneDesc& scene) {
  if (row.node < 0) {
    if (find(scene.bodies, row.on) != nullptr) return "";
    if (find(scene.cables, row.on) != nullptr) return "node -1 of cable " + in_quotes(row.on) + "; allowed: a node from 0 on";
  } else if (const CableDesc* cable = find(scene.cables, row.on)) {
    if (row.node <= cable->segments) return "";
    return "node " + std::to_string(row.node) + " of cable " + in_quotes(row.on) + "; allowed: 0 to " +
           std::to_string(cable->segments);
  } else if (find(scene.bodies, row.on) != nullptr) {
    return "node " + std::to_string(row.node) + " of body " + in_quotes(row.on) + "; allowed: -1";
  }
  NameList names;
  for (const CableDesc& cable : scene.cables) names.add(cable.name);
  for (const BodyDesc& body : scene.bodies) names.add(body.name);
  return "on " + in_quotes(row.on) + "; allowed: " + names.text("none, there are no cables and bodies");
}

}  // namespace

std::vector<std::string> validate_loads(const Loads& loads, const SceneDesc& scene) {
  constexpr std::size_t most_errors = 100;
  std::vector<std::pair<std::size_t, std::string>> found;
  for (const LoadRow& row : loads)
    if (const std::string problem = problem_of(row, scene); !problem.empty())
      found.emplace_back(row.line, "line " + std::to_string(row.line) + ": " + problem);
  std::sort(found.begin(), found.end());
  std::vector<std::string> errors;
  for (std::size_t i = 0; i < std::min(found.size(), most_errors); ++i) errors.push_back(found[i].second);
  if (found.size() > most_errors) errors.push_back("and " + std::to_string(found.size() - most_errors) + " more rows");
  return errors;
}

bool is_due(double start, double time, double time_step) {
  return start <= time + step_tolerance * time_step;
}

LoadPlayer::LoadPlayer(ByteReader& bytes) {
  Loads loads(bytes.read_length());
  for (LoadRow& row : loads) {
    bytes(row.time);
    row.name = bytes.read_text();
    row.on = bytes.read_text();
    bytes(row.node);
    row.force = read_vector(bytes);
    row.torque = read_vector(bytes);
    bytes(row.line);
  }
  bytes(next_);
  if (next_ > loads.size()) throw std::invalid_argument("there are fewer loads than were applied");
  if (!loads.empty()) loads_ = std::make_shared<const Loads>(std::move(loads));
}

void LoadPlayer::write(ByteWriter& bytes) const {
  bytes(loads_ ? loads_->size() : std::size_t{0});
  if (loads_) {
    for (const LoadRow& row : *loads_) {
      bytes(row.time);
      bytes.write_text(row.name);
      bytes.write_text(row.on);
      bytes(row.node);
      write_vector(row.force, bytes);
      write_vector(row.torque, bytes);
      bytes(row.line);
    }
  }
  bytes(next_);
}

LoadPlayer LoadPlayer::from_the_start() const {
  LoadPlayer player = *this;
  player.next_ = 0;
  return player;
}

namespace {

/// The node of a cable that is nearest to where a node of its scene was: guides have nodes of their own. One that does not exist
/// where the cable does not reach there.
int node_now(int node, const SimulatedCable& cable) {
  const double place = node * cable.model->segment_length;
  const std::vector<double> places = cable.state.arc_length();
  if (place > places.back() + 0.5 * cable.model->segment_length) return std::max(node, cable.state.nodes());
  const auto after = std::lower_bound(places.begin(), places.end(), place);
  if (after == places.end()) return cable.state.segments();
  const bool is_nearer = after != places.begin() && place - *(after - 1) < *after - place;
  return static_cast<int>(after - places.begin()) - (is_nearer ? 1 : 0);
}

}  // namespace

std::vector<RefusedLoad> LoadPlayer::apply_due(World& world) {
  std::vector<RefusedLoad> refused;
  for (; loads_ && next_ < loads_->size() && is_due((*loads_)[next_].time, world.time(), world.time_step()); ++next_) {
    const LoadRow& row = (*loads_)[next_];
    edit::ApplyLoad load;
    load.name = row.name;
    load.body = row.node < 0 ? rigid_body_id(verlet_cable::find(world.bodies(), row.on))
                             : cable_id(verlet_cable::find(world.cables(), row.on));
    if (row.node > 0 && load.body.index >= 0) load.node = node_now(row.node, world.cables()[load.body.index]);
    load.force = row.force;
    load.torque = row.torque;
    const EditResult result = world.apply(load);
    if (result.ok) continue;
    // The load before it ends all the same.
    load.force = load.torque = Vector3::Zero();
    world.apply(load);
    refused.push_back({row.name, row.on, "line " + std::to_string(row.line) + " is left out: " + result.message});
  }
  return refused;
}

}  // namespace verlet_cable
