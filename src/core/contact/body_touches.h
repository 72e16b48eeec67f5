#pragma once

#include <vector>

#include "body/body_progress.h"
#include "contact/contact_set.h"
#include "contact/solid_features.h"
#include "verlet_cable/core/body.h"

namespace verlet_cable {

/// A body whose contacts with obstacles are looked for.
struct TouchingBody {
  int index = 0;  ///< into World::bodies()
  const SimulatedBody* body = nullptr;
  const BodyProgress* progress = nullptr;
};

/// Finds where bodies may touch obstacles in a substep: anew each time, but for what their caches keep.
class BodyTouches {
 public:
  /// Adds those of a body in the next h [s], ascending by their keys. `held`: attachments that hold bodies, indices into
  /// `attachments`; obstacles that are joined to what holds the body do not push it.
  void find(const TouchingBody& body, const std::vector<int>& held, const std::vector<Attachment>& attachments,
            const std::vector<MovingObstacle>& obstacles, const ContactRules& rules, double h, std::vector<Touch>& touches);
  /// The substep is done: the cache of a body takes what sticks.
  static void keep(int body, const std::vector<Touch>& touches, ContactCache& cache);
  /// They are those of a substep that goes by another scheme than the conserving one, which `find` takes for granted.
  static void follow_scheme(Scheme scheme, const ContactRules& rules, double h, std::vector<Touch>& touches);

 private:
  void find_shape(const TouchingBody& body, int shape, const MovingObstacle& moving, const ContactRules& rules, double h,
                  std::vector<Touch>& touches);

  std::vector<FeatureContact> found_, found_on_obstacle_;  ///< of the shape, and of the obstacle
};

}  // namespace verlet_cable
