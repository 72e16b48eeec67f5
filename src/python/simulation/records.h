#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "simulation/quantity.h"

namespace verlet_cable {

/// One quantity of many worlds over time: worlds x records x rows x columns numbers.
struct Record {
  Quantity quantity = Quantity::positions;
  std::string name;
  QuantityShape shape;
  std::shared_ptr<double> numbers;
  std::vector<char> changed;  ///< worlds x records: 1 where its shape was another, and the numbers are 0
};

/// What many worlds record while they are stepped.
class Records {
 public:
  Records() = default;
  /// Room for all that `world`, which is like the others, has of these quantities. Throws TooMuchMemory.
  Records(const World& world, const std::vector<Quantity>& quantities, std::size_t worlds, std::size_t records);

  std::size_t count() const { return records_; }
  const std::vector<Record>& all() const { return all_; }
  const Record* find(Quantity quantity, const std::string& name) const;
  /// Threads may do so for different worlds at once.
  void add(const World& world, std::size_t index, std::size_t record);

 private:
  std::size_t records_ = 0;
  std::vector<Record> all_;
};

}  // namespace verlet_cable
