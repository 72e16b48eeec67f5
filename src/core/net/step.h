#pragma once

#include <vector>

#include "contact/moving_obstacle.h"
#include "rod/work_budget.h"
#include "target/boundary.h"
#include "target/kinematic_targets.h"
#include "verlet_cable/core/net.h"

namespace verlet_cable {

/// What a net's step is done with.
struct NetStep {
  const NetModel& model;
  const SceneDesc& scene;                        ///< time step, gravity, fluid, integrator
  const std::vector<MovingObstacle>& obstacles;  ///< over the step
  const KinematicTargets& targets;
  std::vector<HeldNode>& held;  ///< at the end of the step; forces on the holders are written to it

  double h() const { return scene.time_step; }
};

struct NetStepResult {
  bool finite = true;           ///< false: the state is as it was before
  int overstretched_node = -1;  ///< that is held where its links cannot be within their bounds; -1: none
  int unsolved_node = -1;       ///< of a link that was not brought within its bounds though it could be; -1: none
  bool torn = false;            ///< links are far outside their bounds: what pulls at them is not to go on
  bool softened = false;        ///< the step was too long for the springs: they were taken to be softer
  bool exhausted = false;       ///< it took more work than it may: what it had come to by then is no solution
  int iterations = 0;
  double max_strain = 0;
};

/// In links, by which nets share what a step has for them.
inline double size_of(const NetModel& model) {
  return budget::net + static_cast<double>(model.links.size() + model.minimum_distances.size());
}
/// [visits] of work (rod/work_budget.h) that a net's step may take in any case.
inline double first_share_of(const NetModel& model) {
  return budget::net_first_share * size_of(model);
}

/// What acts on a held node besides the net's links.
inline Vector3 force_on_holder(const NetStep& s, const HeldNode& held, const Vector3& links, const Vector3& wind,
                               const Vector3& acceleration) {
  return links + wind + s.model.masses[held.node] * (s.scene.gravity.at(held.position) - acceleration);
}

/// Whether nothing has run away: positions and velocities are numbers of a scene's size.
inline bool is_sane(const std::vector<Vector3>& vectors) {
  for (const Vector3& v : vectors)
    if (!(v.cwiseAbs().maxCoeff() <= 1e9)) return false;
  return true;
}

}  // namespace verlet_cable
