#include "csv_writer.h"

#include <algorithm>

#include "verlet_cable/core/number_text.h"

namespace verlet_cable::cable_sim {
namespace {

constexpr std::size_t full_buffer = std::size_t{1} << 20;

}  // namespace

CsvWriter::CsvWriter(tools::OutputFile& file) : file_(file), buffer_("t,cable,node,x,y,z,vx,vy,vz,tension\n") {}

void CsvWriter::write_nodes(const World& world) {
  const std::string time = number_text(world.time());
  for (const SimulatedCable& cable : world.cables()) {
    const std::string start = time + ',' + cable.model->name + ',';
    const auto nodes = static_cast<std::size_t>(cable.state.nodes());
    for (std::size_t node = 0; node < nodes; ++node)
      write_row(start, node, cable.state.positions[node], cable.state.velocities[node],
                cable.state.tension[std::min(node, nodes - 2)]);
  }
  for (const SimulatedNet& net : world.nets()) {
    const std::string start = time + ',' + net.model.name + ',';
    const std::vector<double> tension = node_tension(net);
    for (std::size_t node = 0; node < tension.size(); ++node)
      write_row(start, node, net.state.positions[node], net.state.velocities[node], tension[node]);
  }
  for (const SimulatedParticle& particle : world.particles())
    write_row(time + ',' + particle.desc.name + ',', 0, particle.position, particle.velocity, 0);
  if (!has_failed()) whole_.push_back({file_.written() + buffer_.size(), world.time()});
  // Who reads from a pipe sees each row when it is there.
  if (file_.is_direct()) flush();
}

void CsvWriter::write_row(const std::string& start, std::size_t node, const Vector3& position, const Vector3& velocity,
                          double tension) {
  buffer_ += start;
  buffer_ += std::to_string(node);
  for (const double number : position) append(number);
  for (const double number : velocity) append(number);
  append(tension);
  buffer_ += '\n';
  if (buffer_.size() > full_buffer) flush();
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

void CsvWriter::append(double number) {
  char text[number_text_size];
  buffer_ += ',';
  buffer_.append(text, write_number(text, number));
}

}  // namespace verlet_cable::cable_sim
