#pragma once

#include <memory>
#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// A world that is to be stepped together with others.
struct WorldStep {
  World* world = nullptr;
  const BoundaryInputs* inputs = nullptr;  ///< as of World::step
  StepResult result;                       ///< out
};

/// Steps many worlds by a step each, as World::step does, with the same result; sooner, where cables in them are alike. Keeps
/// nothing from one call to the next but memory.
class WorldStepper {
 public:
  WorldStepper();
  ~WorldStepper();

  /// No world twice. Uses all cores, or only the calling thread.
  void step(std::vector<WorldStep>& worlds, bool all_cores);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace verlet_cable
