#include "summary.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>

#include "common/json_writer.h"

namespace verlet_cable::cable_sim {
namespace {

constexpr double nanoseconds = 1e9;

std::string hash_text(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, hash);
  return text;
}

void write_event(tools::JsonWriter& json, const Event& event) {
  json.begin_object();
  json.entry("time", event.time);
  json.entry("type", event.type);
  if (!event.cable.empty()) json.entry("cable", event.cable);
  if (event.node >= 0) json.entry("node", std::int64_t{event.node});
  if (!event.frame.empty()) json.entry("frame", event.frame);
  if (!event.other.empty()) json.entry("other", event.other);
  json.entry("message", event.message);
  json.end_object();
}

void write_energy(tools::JsonWriter& json, const Energy& energy, double initial_total) {
  json.begin_object();
  json.entry("kinetic", energy.kinetic);
  json.entry("gravity", energy.gravity);
  json.entry("stretch", energy.stretch);
  json.entry("bend", energy.bend);
  json.entry("twist", energy.twist);
  json.entry("total", energy.total());
  json.entry("initial_total", initial_total);
  json.end_object();
}

}  // namespace

Summary::Summary(const World& world, std::int64_t averaged_steps)
    : averaged_steps_(static_cast<std::size_t>(averaged_steps)), initial_energy_(world.energy().total()) {
  for (const SimulatedCable& cable : world.cables()) segments_ += cable.model.segments();
  for (const SimulatedNet& net : world.nets())
    segments_ += static_cast<std::int64_t>(std::max(net.model.links.size(), net.model.masses.size()));
  segments_ += static_cast<std::int64_t>(world.particles().size());
}

void Summary::add_step(const World& world, const StepResult& result, std::chrono::steady_clock::duration wall_time) {
  wall_time_ += wall_time;
  substeps_ += result.substeps;
  max_strain_ = std::max(max_strain_, result.max_strain);
  for (const Attachment& attachment : world.attachments()) {
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
  tools::JsonWriter json;
  json.begin_object();
  json.entry("sim_time", world.time());
  json.entry("wall_time", wall_seconds());
  json.entry("real_time_factor", world.time() / wall_seconds());
  json.entry("steps", world.steps());
  json.entry("substeps", substeps_);
  json.entry("segments", segments_);
  json.entry("ns_per_segment_substep", nanoseconds * wall_seconds() / static_cast<double>(segments_ * substeps_));
  json.entry("max_strain", max_strain_);
  json.key("energy");
  write_energy(json, world.energy(), initial_energy_);
  json.key("attachments");
  json.begin_object();
  for (const Attachment& attachment : world.attachments()) {
    const Wrench mean = mean_wrench(attachment);
    json.key(attachment.name);
    json.begin_object();
    json.entry("force", mean.force);
    json.entry("torque", mean.torque);
    json.entry("force_now", attachment.force);
    json.entry("torque_now", attachment.torque);
    json.end_object();
  }
  json.end_object();
  json.entry("state_hash", hash_text(world.hash()));
  json.key("events");
  json.begin_array();
  for (const Event& event : events) write_event(json, event);
  json.end_array();
  json.end_object();
  return json.text() + "\n";
}

std::string Summary::line(const World& world) const {
  char text[200];
  std::snprintf(text, sizeof text, "%g s of %" PRId64 " segments in %.3g s (%.3g times real time), largest strain %.2g, state %s",
                world.time(), segments_, wall_seconds(), wall_seconds() > 0 ? world.time() / wall_seconds() : 0.0, max_strain_,
                hash_text(world.hash()).c_str());
  return text;
}

}  // namespace verlet_cable::cable_sim
