#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rod/scheme.h"

// Schemes of substeps, on a mass at a spring that acts on one side only: what begins and ends within a substep.

namespace verlet_cable {
namespace {

/// m = 1 and h = 1: `stiffness` is the square of a frequency times the substep.
struct Bouncing {
  double place, velocity, stiffness;

  double energy() const { return 0.5 * (velocity * velocity + stiffness * std::pow(std::min(place, 0.0), 2)); }

  void step(Scheme scheme) {
    const double inertia = inertia_of(scheme);
    double way = velocity;  // where nothing touches
    if (place + way < 0) way = (inertia * velocity - stiffness * place) / (inertia + stiffness);
    const VelocityWeights weights = velocity_weights(scheme);
    velocity = weights.displacement * way + weights.velocity * velocity;
    place += way;
  }
};

TEST(Scheme, MakesNoEnergyOfForcesThatBeginOrEnd) {
  for (const Scheme scheme : {Scheme::first_order, Scheme::dissipative})
    for (const double stiffness : {0.01, 0.3, 1.0, 4.0, 30.0, 1e3, 1e6})
      for (double place = -1; place <= 1; place += 0.01) {
        Bouncing mass{place, -0.4, stiffness};
        for (int i = 0; i < 20; ++i) {
          const double before = mass.energy();
          mass.step(scheme);
          ASSERT_LE(mass.energy(), before * (1 + 1e-12)) << "stiffness " << stiffness << ", from " << place << ", step " << i;
        }
      }
}

/// What is carried along by something that is accelerated ends up with the velocity that is expected of it.
TEST(Scheme, CarriesAlongWithTheVelocityThatIsExpected) {
  constexpr double acceleration = 0.7;
  for (const Scheme scheme : {Scheme::conserving, Scheme::first_order, Scheme::dissipative, Scheme::damped}) {
    const VelocityWeights weights = velocity_weights(scheme);
    double velocity = 0, change = acceleration;  // what is its own, and what `damped` remembers
    for (int i = 0; i < 200; ++i) {
      const double way = acceleration * (i + 0.5), end = acceleration * (i + 1);
      const double next = weights.displacement * way + weights.velocity * velocity + weights.acceleration * change;
      if (scheme == Scheme::damped) change = way - velocity + 0.5 * change;
      velocity = next;
      if (i > 150) {
        EXPECT_NEAR(velocity, lagging_velocity(scheme, 1, way, end), 1e-9 * end);
      }
    }
  }
}

}  // namespace
}  // namespace verlet_cable
