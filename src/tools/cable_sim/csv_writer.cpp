#include "csv_writer.h"

#include <algorithm>

#include "verlet_cable/core/number_text.h"

namespace verlet_cable::cable_sim {
namespace {

constexpr std::size_t full_buffer = std::size_t{1} << 20;

void write_row(const std::string& start, std::size_t node, const Vector3& position, const Vector3& velocity, double tension,
               CsvWriter& csv) {
  csv.begin_row(start + std::to_string(node));
  csv.append_all(position);
  csv.append_all(velocity);
  csv.append(tension);
  csv.end_row();
}

}  // namespace

CsvWriter::CsvWriter(tools::OutputFile& file, const std::string& header) : file_(file), buffer_(header + "\n") {}

void CsvWriter::append(double number) {
  char text[number_text_size];
  buffer_ += ',';
  buffer_.append(text, write_number(text, number));
}

void CsvWriter::end_row() {
  buffer_ += '\n';
  if (buffer_.size() > full_buffer) flush();
}

void CsvWriter::end_time(double time) {
  if (!has_failed()) whole_.push_back({file_.written() + buffer_.size(), time});
  // Who reads from a pipe sees each row when it is there.
  if (file_.is_direct()) flush();
}

void CsvWriter::flush() {
  file_.write(buffer_.data(), buffer_.size());
  buffer_.clear();
  if (has_failed()) return;
  const auto behind = [this](const Whole& whole) { return whole.size > file_.written(); };
  const auto first_behind = std::find_if(whole_.begin(), whole_.end(), behind);
  if (first_behind - whole_.begin() > 1) whole_.erase(whole_.begin(), first_behind - 1);
}

std::string CsvWriter::keep_whole_times() {
  const auto is_there = [this](const Whole& whole) { return whole.size <= file_.written(); };
  const auto last = std::find_if(whole_.rbegin(), whole_.rend(), is_there);
  const std::string problem = last == whole_.rend() ? "" : file_.keep_first(last->size);
  return problem.empty() ? "" : problem + "; it holds all until " + number_text(last->time) + " s";
}

void write_nodes(const World& world, CsvWriter& csv) {
  const std::string time = number_text(world.time());
  for (const SimulatedCable& cable : world.cables()) {
    const std::string start = time + ',' + cable.model->name + ',';
    const auto nodes = static_cast<std::size_t>(cable.state.nodes());
    for (std::size_t node = 0; node < nodes; ++node)
      write_row(start, node, cable.state.positions[node], cable.state.velocities[node],
                cable.state.tension[std::min(node, nodes - 2)], csv);
  }
  for (const SimulatedNet& net : world.nets()) {
    const std::string start = time + ',' + net.model.name + ',';
    const std::vector<double> tension = node_tension(net);
    for (std::size_t node = 0; node < tension.size(); ++node)
      write_row(start, node, net.state.positions[node], net.state.velocities[node], tension[node], csv);
  }
  for (const SimulatedParticle& particle : world.particles())
    write_row(time + ',' + particle.desc.name + ',', 0, particle.position, particle.velocity, 0, csv);
  csv.end_time(world.time());
}

void write_bodies(const World& world, CsvWriter& csv) {
  const std::string time = number_text(world.time());
  for (const SimulatedBody& body : world.bodies()) {
    if (body.is_junction) continue;
    csv.begin_row(time + ',' + body.name);
    csv.append_all(body.pose.position);
    csv.append_all(body.pose.orientation.coeffs());  // x, y, z, w
    csv.append_all(body.velocity);
    csv.append_all(body.angular_velocity);
    csv.end_row();
  }
  csv.end_time(world.time());
}

}  // namespace verlet_cable::cable_sim
