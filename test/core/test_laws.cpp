#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "law/bend.h"
#include "law/drag.h"
#include "law/guide.h"
#include "law/resistance.h"
#include "law/stretch.h"
#include "law/winch.h"

// Each law alone: what it exerts is the derivative of its potential, keeps the energy over a substep, or takes some.

namespace verlet_cable {
namespace {

using Vector = VectorOf<double>;

class Law : public testing::Test {
 protected:
  double number(double size) { return std::uniform_real_distribution<double>(-size, size)(random_); }
  Vector vector(double size) { return {number(size), number(size), number(size)}; }

 private:
  std::mt19937 random_{1};
};

double& component(Vector& v, int i) {
  return i == 0 ? v.x : i == 1 ? v.y : v.z;
}

TEST_F(Law, BendsKeepTheEnergyOverASubstep) {
  for (int i = 0; i < 100; ++i) {
    const Vector start = vector(0.5), change = vector(0.3), end = start + change;
    const Bend<double> joint = bend(2.5, start, dot(start, start), change, 0.5);
    EXPECT_NEAR(dot(joint.moment, change), bend_energy(2.5, end) - bend_energy(2.5, start), 1e-14);
  }
}

/// Forces of the end are its derivative.
TEST_F(Law, TheMomentOfABendIsTheDerivativeOfItsEnergy) {
  constexpr double step = 1e-5;
  for (int i = 0; i < 100; ++i) {
    const Vector e = vector(0.5);
    const Bend<double> joint = bend(2.5, e, dot(e, e), Vector{0, 0, 0}, 1);
    for (int k = 0; k < 3; ++k) {
      Vector more = e, less = e, moment = joint.moment;
      component(more, k) += step;
      component(less, k) -= step;
      EXPECT_NEAR(component(moment, k), (bend_energy(2.5, more) - bend_energy(2.5, less)) / (2 * step), 1e-8);
    }
  }
}

/// Bends of a cable, in which the material turns as clamps turn it and by itself.
struct DampedBends {
  std::vector<BendDamping<double>> bends;

  double share(const std::vector<Vector>& changes) const {
    double along = 0, square = 0;
    for (std::size_t j = 0; j < bends.size(); ++j) {
      along += bends[j].along(changes[j]);
      square += bends[j].square();
    }
    return turned_share(along, square);
  }
  double loss(const std::vector<Vector>& changes) const {
    double sum = 0;
    for (std::size_t j = 0; j < bends.size(); ++j) sum += bends[j].loss(changes[j], share(changes));
    return sum;
  }
  /// With `part` of what turns by itself.
  double potential(const std::vector<Vector>& changes, double part) const {
    double sum = 0;
    for (std::size_t j = 0; j < bends.size(); ++j) {
      const Vector bending = changes[j] - bends[j].driven - part * bends[j].turned;
      sum += 0.5 * bends[j].damping * dot(bending, bending);
    }
    return sum;
  }
};

TEST_F(Law, DampingOfBendsIsTheLeastPotentialAndOnlyTakesEnergy) {
  constexpr int count = 5;
  constexpr double step = 1e-6;
  int none = 0, some = 0, all = 0;
  for (int i = 0; i < 500; ++i) {
    DampedBends damped;
    std::vector<Vector> changes;
    const double size = number(2);
    for (int j = 0; j < count; ++j) {
      const Vector turned = vector(0.1);
      damped.bends.push_back({1 + number(0.5), vector(0.1), turned});
      changes.push_back(damped.bends[j].driven + size * turned + vector(0.05));
    }
    const double share = damped.share(changes), least = damped.potential(changes, share);
    ++(share == 0 ? none : share < 1 ? some : all);
    for (double part = 0; part <= 1; part += 0.05) EXPECT_LE(least, damped.potential(changes, part) + 1e-15);
    // A convex potential that is nothing where only clamps turn the material.
    EXPECT_GE(damped.loss(changes), least);
    for (int j = 0; j < count; ++j)
      for (int k = 0; k < 3; ++k) {
        std::vector<Vector> more = changes, less = changes;
        component(more[j], k) += step;
        component(less[j], k) -= step;
        const double slope =
            (damped.potential(more, damped.share(more)) - damped.potential(less, damped.share(less))) / (2 * step);
        Vector moment = damped.bends[j].moment(changes[j], share);
        EXPECT_NEAR(component(moment, k), slope, 1e-6);
      }
  }
  EXPECT_GT(std::min({none, some, all}), 50);
}

/// A spring keeps what a dashpot does not take.
TEST_F(Law, ResistanceKeepsWhatItDoesNotTake) {
  const Resistance<double> resistance{3, 0.4};
  for (int i = 0; i < 100; ++i) {
    const double start = number(1), change = number(1);
    const double work = resistance.stress(start + 0.5 * change, change) * change;
    EXPECT_NEAR(work, resistance.energy(start + change) - resistance.energy(start) + resistance.loss(change), 1e-14);
    EXPECT_GE(resistance.loss(change), 0);
  }
}

/// What moves with the fluid feels nothing; cable and fluid lose what drag takes.
TEST_F(Law, DragTakesWhatCableAndFluidGive) {
  for (int i = 0; i < 100; ++i) {
    const double h = 1e-3;
    const LinearDrag<double> drag{0.3, vector(2), 1 / h};
    const Vector u = vector(5e-3), force = drag.load() - drag.resistance() * u;
    EXPECT_NEAR(drag.loss(u), drag.work(u) - dot(force, u), 1e-15);
    EXPECT_GE(drag.loss(u), 0);
    EXPECT_NEAR(drag.loss(h * drag.fluid), 0, 1e-18);
  }
}

/// Tension and what draws the flow do the whole work that becomes energy, but for what damps; where forces are those of the end
/// they are its derivatives.
TEST_F(Law, WhatFlowsThroughAGuideTakesItsEnergyAlong) {
  constexpr double stiffness = 300, small = 1e-6;
  const auto energy = [&](double rest, double length) {
    return 0.5 * stiffness * rest * (length / rest - 1) * (length / rest - 1);
  };
  // The tension that makes the row vanish, times the mean length
  const auto drawn_at = [](const FlowingLength& flowing, double part) {
    double density = 0;
    for (int i = 0; i < 50; ++i) {
      const DrawnLength drawn = draw({stiffness, 0}, flowing, density, part);
      density -= drawn.row.gap / drawn.row.compliance;
    }
    return std::pair(draw({stiffness, 0}, flowing, density, part), density);
  };
  for (int i = 0; i < 100; ++i) {
    FlowingLength flowing{1 + number(0.2), 1 + number(0.2), 0, 0};
    flowing.start_length = flowing.start_rest * (1.05 + number(0.04));
    flowing.length = flowing.rest * (1.05 + number(0.04));
    const auto [drawn, density] = drawn_at(flowing, 0.5);
    const double tension = density * 0.5 * (flowing.start_length + flowing.length);
    EXPECT_NEAR(tension * (flowing.length - flowing.start_length) - drawn.force * (flowing.rest - flowing.start_rest),
                energy(flowing.rest, flowing.length) - energy(flowing.start_rest, flowing.start_length), 1e-12);

    const auto [at_end, end_density] = drawn_at(flowing, 1);
    EXPECT_NEAR(end_density * flowing.length,
                (energy(flowing.rest, flowing.length + small) - energy(flowing.rest, flowing.length - small)) / (2 * small),
                1e-6);
    EXPECT_NEAR(-at_end.force,
                (energy(flowing.rest + small, flowing.length) - energy(flowing.rest - small, flowing.length)) / (2 * small),
                1e-6);
  }
}

/// Two tensions whose ratio is that of Euler and Eytelwein.
TEST_F(Law, RubbingIsThatOfACapstan) {
  for (const double friction : {0.1, 0.5})
    for (const double angle : {0.1, 1.0, 2.5}) {
      const double slack = 3, tight = slack * std::exp(friction * angle);
      // What the guide presses with across the bisector
      const double press = std::sin(0.5 * angle) * (slack + tight);
      EXPECT_NEAR(rubbing_part(friction, angle) * press, tight - slack, 1e-12);
    }
  EXPECT_NEAR(rubbing_part(0.3, 1e-7), 0.3, 1e-12);
}

/// Newton's method on a row finds the density with which a segment has its tension, and the row says when it has.
/// Growth never falls with the tension; within its bounds the strain at the end is that of the tension.
TEST_F(Law, AWinchGivesTheTensionWithinItsBounds) {
  constexpr double step = 1e-7, stiffness = 1e3;
  for (int i = 0; i < 100; ++i) {
    const double part = i % 2 == 0 ? 0.5 : 1, damping = i % 3 == 0 ? 0 : 50;
    const Resistance<double> resistance{stiffness, damping};
    WoundLength wound;
    wound.start_rest = 1 + number(0.2);
    wound.end_rest = wound.start_rest + number(0.05);
    wound.rest = wound.start_rest + part * (wound.end_rest - wound.start_rest);
    wound.start_length = wound.start_rest * (1 + number(0.1));
    WinchLaw law;
    law.tension = 30;
    law.least = -0.02;
    law.most = 0.02;
    const auto growth_at = [&](double length) {
      const double wanted = wanted_growth(resistance, wound, law.tension, length);
      return std::pair(mode_of(law, wanted), growth_in(law, mode_of(law, wanted), wanted));
    };
    double last = law.least;
    for (double length = 0.6; length < 1.5; length += 0.001) {
      const auto [mode, growth] = growth_at(length);
      ASSERT_GE(growth, last);
      ASSERT_LE(growth, law.most);
      last = growth;
      const double strain = length / (wound.end_rest + growth) - 1, before = wound.start_length / wound.start_rest - 1;
      const double tension = stiffness * strain + damping * (strain - before);
      if (mode == WinchMode::keeps) {
        ASSERT_NEAR(tension, law.tension, 1e-9);
      }
      if (mode == WinchMode::least) {
        ASSERT_LE(tension, law.tension + 1e-9);
      }
      if (mode == WinchMode::most) {
        ASSERT_GE(tension, law.tension - 1e-9);
      }
      // The rise is the derivative of the tension.
      const auto tension_at = [&](double at) {
        const auto [its_mode, its_growth] = growth_at(at);
        return wound_tension(resistance, wound, its_mode, its_growth, at, part).tension;
      };
      if (growth_at(length - step).first != mode || growth_at(length + step).first != mode) continue;
      EXPECT_NEAR(wound_tension(resistance, wound, mode, growth, length, part).rise,
                  (tension_at(length + step) - tension_at(length - step)) / (2 * step), 1e-3);
    }
    EXPECT_EQ(growth_at(0.6).first, WinchMode::least);
    EXPECT_EQ(growth_at(1.5).first, WinchMode::most);
  }
}

TEST_F(Law, ElasticRowsVanishAtTheTension) {
  const double start = 0.1, end = 0.11, rest = 0.1, mean = 0.5 * (start + end);
  const Resistance<double> resistance{200 / rest, 3};
  const double tension = resistance.stress(mean - rest, end - start);
  const LengthRow<double> solved = elastic_row(tension, resistance.slope(0.5), tension / mean, mean, end, 0.5);
  EXPECT_NEAR(solved.gap, 0, 1e-16);
  const double density = 0.9 * tension / mean;
  const LengthRow<double> row = elastic_row(tension, resistance.slope(0.5), density, mean, end, 0.5);
  EXPECT_NEAR(density - row.gap / row.compliance, tension / mean, 1e-10);
}

}  // namespace
}  // namespace verlet_cable
