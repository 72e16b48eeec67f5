#include "simulation/records.h"

#include <algorithm>

#include "simulation/memory_check.h"

namespace verlet_cable {
namespace {

/// All names that have a quantity.
std::vector<std::string> names_of(const World& world, Quantity quantity) {
  std::vector<std::string> names;
  const bool nodes = quantity == Quantity::positions || quantity == Quantity::velocities;
  if (quantity <= Quantity::orientations)
    for (const SimulatedCable& cable : world.cables()) names.push_back(cable.model->name);
  if (nodes || quantity == Quantity::tension)
    for (const SimulatedNet& net : world.nets()) names.push_back(net.model.name);
  if (nodes)
    for (const SimulatedParticle& particle : world.particles()) names.push_back(particle.desc.name);
  if (quantity == Quantity::wrench)
    for (const Attachment& attachment : world.attachments())
      if (is_named(attachment)) names.push_back(attachment.name);
  if (quantity == Quantity::contact_force) names = solid_names(world);
  if (quantity == Quantity::body_pose || quantity == Quantity::body_twist)
    for (const SimulatedBody& body : world.bodies())
      if (!body.is_junction) names.push_back(body.name);
  return names;
}

std::shared_ptr<double> room_for(std::size_t size) {
  return {new double[size], std::default_delete<double[]>()};
}

}  // namespace

Records::Records(const World& world, const std::vector<Quantity>& quantities, std::size_t worlds, std::size_t records)
    : records_(records) {
  double bytes = 0;
  for (const Quantity quantity : quantities) {
    for (std::string& name : names_of(world, quantity)) {
      const QuantityShape shape = shape_of(world, quantity, name);
      all_.push_back({quantity, std::move(name), shape, nullptr, {}});
      bytes += static_cast<double>((sizeof(double) * shape.size() + sizeof(char)) * worlds) * static_cast<double>(records);
    }
  }
  check_memory("record_every: " + std::to_string(records) + " records of " + std::to_string(worlds) + " worlds", bytes);
  for (Record& record : all_) {
    record.numbers = room_for(record.shape.size() * worlds * records);
    record.changed.assign(worlds * records, 0);
  }
}

const Record* Records::find(Quantity quantity, const std::string& name) const {
  const auto found = std::find_if(all_.begin(), all_.end(),
                                  [&](const Record& record) { return record.quantity == quantity && record.name == name; });
  return found == all_.end() ? nullptr : &*found;
}

void Records::add(const World& world, std::size_t index, std::size_t record) {
  for (Record& one : all_) {
    const std::size_t size = one.shape.size();
    double* to = one.numbers.get() + (index * records_ + record) * size;
    if (try_copy_quantity(world, one.quantity, one.name, one.shape, to)) continue;
    std::fill_n(to, size, 0.0);
    one.changed[index * records_ + record] = 1;
  }
}

}  // namespace verlet_cable
