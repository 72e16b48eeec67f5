#include "csv_writer.h"

#include <algorithm>

#include "verlet_cable/core/number_text.h"

namespace verlet_cable::cable_sim {
namespace {

constexpr std::size_t full_buffer = std::size_t{1} << 20;

}  // namespace

CsvWriter::CsvWriter(OutputFile& file) : file_(file), buffer_("t,cable,node,x,y,z,vx,vy,vz,tension\n") {}

void CsvWriter::write_nodes(const World& world) {
  const std::string time = number_text(world.time());
  for (const SimulatedCable& cable : world.cables()) {
    const std::string start = time + ',' + cable.model.name + ',';
    const auto nodes = static_cast<std::size_t>(cable.model.nodes());
    for (std::size_t node = 0; node < nodes; ++node) {
      buffer_ += start;
      buffer_ += std::to_string(node);
      for (const double number : cable.state.positions[node]) append(number);
      for (const double number : cable.state.velocities[node]) append(number);
      append(cable.state.tension[std::min(node, nodes - 2)]);
      buffer_ += '\n';
    }
    if (buffer_.size() > full_buffer) flush();
  }
}

void CsvWriter::flush() {
  file_.write(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void CsvWriter::append(double number) {
  char text[number_text_size];
  buffer_ += ',';
  buffer_.append(text, write_number(text, number));
}

}  // namespace verlet_cable::cable_sim
