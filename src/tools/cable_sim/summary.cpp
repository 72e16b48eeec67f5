#include "summary.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <utility>

#include "common/json.h"

namespace verlet_cable::cable_sim {
namespace {

using tools::Json;

constexpr double nanoseconds = 1e9;

std::string hash_text(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, hash);
  return text;
}

Json array(const Vector3& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Json bodies_json(const World& world) {
  Json json = Json::object();
  for (const SimulatedBody& body : world.bodies()) {
    if (body.is_junction) continue;
    const Quaternion& q = body.pose.orientation;
    json[body.name] = {{"position", array(body.pose.position)}, {"orientation", {q.x(), q.y(), q.z(), q.w()}}};
  }
  return json;
}

Json guides_json(const World& world) {
  Json json = Json::object();
  for (std::size_t guide = 0; guide < world.guides().size(); ++guide) {
    const GuideView view = world.view_guide(static_cast<int>(guide));
    if (view.cable < 0) continue;
    json[world.guides()[guide].name] = {{"arc_length", view.arc_length}, {"tension", {view.tension[0], view.tension[1]}}};
  }
  return json;
}

Json event_json(const Event& event) {
  Json json{{"time", event.time}, {"type", event.type}};
  if (!event.cable.empty()) json["cable"] = event.cable;
  if (event.node >= 0) json["node"] = event.node;
  if (!event.frame.empty()) json["frame"] = event.frame;
  if (!event.other.empty()) json["other"] = event.other;
  json["message"] = event.message;
  return json;
}

Json energy_json(const Energy& energy, double initial_total) {
  return {{"kinetic", energy.kinetic}, {"gravity", energy.gravity}, {"stretch", energy.stretch},     {"bend", energy.bend},
          {"twist", energy.twist},     {"total", energy.total()},   {"initial_total", initial_total}};
}

Json ledger_json(const Ledger& ledger) {
  Json work = Json::object(), dissipated = Json::object();
  for (const auto& [name, place] : EnergyBalance::Work::fields) work[name] = ledger.balance.work.*place;
  for (const auto& [name, place] : EnergyBalance::Dissipated::fields) dissipated[name] = ledger.balance.dissipated.*place;
  return {{"work", work}, {"dissipated", dissipated}, {"change", ledger.change}, {"unaccounted", ledger.unaccounted()}};
}

}  // namespace

Summary::Summary(const World& world, std::int64_t averaged_steps)
    : averaged_steps_(static_cast<std::size_t>(averaged_steps)), initial_energy_(world.energy().total()) {
  for (const SimulatedCable& cable : world.cables()) segments_ += cable.state.segments();
  for (const SimulatedNet& net : world.nets())
    segments_ += static_cast<std::int64_t>(std::max(net.model.links.size(), net.model.masses.size()));
  segments_ += static_cast<std::int64_t>(world.particles().size());
  segments_ +=
      std::count_if(world.bodies().begin(), world.bodies().end(), [](const SimulatedBody& body) { return !body.is_junction; });
  extremes_.add(world);
}

void Summary::add_step(const World& world, const StepResult& result, std::chrono::steady_clock::duration wall_time) {
  wall_time_ += wall_time;
  substeps_ += result.substeps;
  max_strain_ = std::max(max_strain_, result.max_strain);
  extremes_.add(world);
  for (const Attachment& attachment : world.attachments()) {
    if (!is_named(attachment)) continue;
    std::vector<Wrench>& last = wrenches_[attachment.name];
    if (steps_ < averaged_steps_) last.emplace_back();
    last[steps_ % averaged_steps_] = {attachment.force, attachment.torque};
  }
  ++steps_;
}

Summary::Wrench Summary::mean_wrench(const Attachment& attachment) const {
  if (steps_ == 0) return {attachment.force, attachment.torque};
  const std::vector<Wrench>& last = wrenches_.at(attachment.name);
  const std::size_t count = last.size();
  Wrench mean;
  for (std::size_t step = steps_ - count; step < steps_; ++step) {
    mean.force += last[step % averaged_steps_].force;
    mean.torque += last[step % averaged_steps_].torque;
  }
  mean.force /= static_cast<double>(count);
  mean.torque /= static_cast<double>(count);
  return mean;
}

std::string Summary::json(const World& world, const std::vector<Event>& events) const {
  // By names, which are not looked up: there may be tens of thousands.
  std::vector<std::pair<std::string, Json>> attachments;
  for (const Attachment& attachment : world.attachments()) {
    if (!is_named(attachment)) continue;
    const Wrench mean = mean_wrench(attachment);
    attachments.emplace_back(attachment.name, Json{{"force", array(mean.force)},
                                                   {"torque", array(mean.torque)},
                                                   {"force_now", array(attachment.force)},
                                                   {"torque_now", array(attachment.torque)}});
  }
  Json listed_events = Json::array();
  for (const Event& event : events) listed_events.push_back(event_json(event));
  const Json json{
      {"sim_time", world.time()},
      {"wall_time", wall_seconds()},
      {"real_time_factor", world.time() / wall_seconds()},
      {"steps", world.steps()},
      {"substeps", substeps_},
      {"segments", segments_},
      {"ns_per_segment_substep", nanoseconds * wall_seconds() / static_cast<double>(segments_ * substeps_)},
      {"max_strain", max_strain_},
      {"energy", energy_json(world.energy(), initial_energy_)},
      {"ledger", ledger_json(world.ledger())},
      {"unaccounted_steps", world.ledger().unaccounted_steps},
      {"extremes", extremes_.json()},
      {"attachments", Json::object_t(attachments.begin(), attachments.end())},
      {"bodies", bodies_json(world)},
      {"guides", guides_json(world)},
      {"state_hash", hash_text(world.hash())},
      {"events", std::move(listed_events)},
  };
  return tools::file_text(json);
}

std::string Summary::line(const World& world) const {
  char text[200];
  std::snprintf(text, sizeof text,
                "%g s of %" PRId64 " segments in %.3g s (%.3g times real time), largest strain %.2g, state hash %s", world.time(),
                segments_, wall_seconds(), wall_seconds() > 0 ? world.time() / wall_seconds() : 0.0, max_strain_,
                hash_text(world.hash()).c_str());
  return text;
}

}  // namespace verlet_cable::cable_sim
