#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "contact/law.h"
#include "verlet_cable/core/contact.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What touched in the substeps of a step, as means over the step.
class StepContacts {
 public:
  void clear() { contacts_.clear(); }
  /// Those of a substep that is done, which was this part of the step. `on_obstacles`: of bodies.
  void add(const std::vector<Touch>& touches, const std::vector<Touch>& on_obstacles, const std::vector<SimulatedCable>& cables,
           double part);
  /// Adds the contacts of cables, then of bodies, to lists: each once, in an order that does not depend on substeps.
  void collect(std::vector<SimulatedContact>& of_cables, std::vector<SimulatedContact>& of_bodies);

 private:
  struct Contact {
    std::uint64_t key = 0, other_key = 0;  ///< of its touch
    int substep = 0;
    SimulatedContact mean;
  };

  void merge();

  std::vector<Contact> contacts_;
  int substeps_ = 0;
};

struct State;

/// Of the obstacle, body or cable that is touched.
const std::string& name_of_touched(const SimulatedContact& contact, const State& state);

}  // namespace verlet_cable
