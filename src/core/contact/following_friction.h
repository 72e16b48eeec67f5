#pragma once

#include <vector>

#include "contact/law.h"
#include "rod/participant.h"

namespace verlet_cable {

/// Friction that follows the normal forces within a linear solution. The matrix has no part of it, since it is not symmetric.
class FollowingFriction {
 public:
  /// Improves the cables' own solutions until friction follows all the same: along a capstan it takes as many times as the
  /// cable's tension has to be handed on. `index`: of the participant, by cable; `tolerated` [m]: error of a node.
  void solve(std::vector<Touch>& touches, const std::vector<int>& index, double tolerated,
             std::vector<Participant>& participants);

 private:
  /// A contact whose friction follows the normal force: it slides, or leans at an edge.
  struct Slip {
    Touch* touch = nullptr;
    int participant = 0;
    Vector3 normal, friction;                ///< the second: over the normal force
    double normal_force = 0, stiffness = 0;  ///< [N], [N/m] of it
    double change = 0;                       ///< [N] of it, in the correction
    Vector3 displacement = Vector3::Zero();  ///< [m] likewise
  };
  struct Cable {
    bool slips = false;
    VectorArray kept_load;  ///< nodes [N]: as it was before contacts added to it
  };

  double follow(double tolerated, std::vector<Participant>& participants);
  void solve_again(std::vector<Participant>& participants);

  std::vector<Slip> slips_;
  std::vector<Cable> cables_;  ///< one a participant
};

}  // namespace verlet_cable
