#include <gtest/gtest.h>

#include <cmath>

#include "../support/scenes.h"
#include "rod/catenary.h"

namespace verlet_cable {
namespace {

/// Ends from level to above each other, slack and taut, of a chain of 1 m.
std::vector<Vector3> spans(double axial_stiffness) {
  std::vector<Vector3> all;
  for (const double across : {0.0, 1e-9, 1e-6, 1e-3, 0.01, 0.03, 0.05, 0.1, 0.3, 0.6, 0.9, 0.99, 0.999999, 1.0})
    for (const double up : {-1.2, -1.01, -0.999, -0.97, -0.5, -0.1, 0.0, 0.005, 0.2, 0.37, 0.51, 0.87, 1.0}) {
      const Vector3 span(0.6 * across, -0.8 * across, up);
      if (span.norm() < (axial_stiffness < infinity ? 1.5 : 1)) all.push_back(span);
    }
  return all;
}

TEST(Catenary, IsInEquilibriumBetweenAllEnds) {
  constexpr double weight = 0.981;
  for (const int n : {2, 3, 4, 5, 7, 10, 20, 21, 50, 100})
    for (const double stiffness : {1.0, 10.0, 100.0, 1e4, 1e6, infinity})
      for (const Vector3& span : spans(stiffness)) {
        const std::vector<double> lengths(n, 1.0 / n), weights(n - 1, weight / n);
        const std::vector<Vector3> nodes = hanging_chain(Vector3::Zero(), span, lengths, weights, -Vector3::UnitZ(), {stiffness});
        const std::string text =
            std::to_string(n) + " " + std::to_string(stiffness) + " " + std::to_string(span.x()) + " " + std::to_string(span.z());
        ASSERT_LT((nodes.back() - span).norm(), 1e-9) << text;
        const auto link = [&](int i) -> Vector3 { return nodes[i + 1] - nodes[i]; };
        const auto tension = [&](int i) -> Vector3 { return stiffness * (n * link(i).norm() - 1) * link(i).normalized(); };
        for (int i = 0; i < n; ++i) {
          if (stiffness == infinity) {
            ASSERT_NEAR(link(i).norm(), 1.0 / n, 1e-12) << text;
          } else if (i > 0) {
            ASSERT_LT((tension(i) - tension(i - 1) - Vector3(0, 0, weight / n)).norm(), 1e-9 * (1 + stiffness)) << text;
          }
        }
      }
}

/// [m] that the nodes of a cable move in 0.5 s after its start.
double way(int segments, double axial_stiffness, const Vector3& span) {
  SceneDesc scene = scenes::one_cable(segments);
  scene.materials[0].material.axial_stiffness = axial_stiffness;
  scene.cables[0].attachments = {scenes::attachment("a", PlaceDesc::At::start, {0, 0, 0}),
                                 scenes::attachment("b", PlaceDesc::At::end, span)};
  World world(scene, initial_frames(scene));
  const std::vector<Vector3> start = world.cables()[0].state.positions;
  const BoundaryInputs inputs(world.frames().size());
  double most = 0;
  for (int i = 0; i < 500; ++i) world.step(inputs);
  for (std::size_t i = 0; i < start.size(); ++i) most = std::max(most, (world.cables()[0].state.positions[i] - start[i]).norm());
  return most;
}

TEST(Catenary, StaysAtRest) {
  for (const int n : {2, 3, 10, 21, 40})
    for (const double stiffness : {10.0, 100.0, 1e4, infinity})
      for (const Vector3& span :
           {Vector3(0, 0, 0), Vector3(0.01, 0, -0.5), Vector3(1e-3, 0, -0.5), Vector3(0, 0, 0.97), Vector3(0, 0, 1),
            Vector3(0.03, 0, 0.51), Vector3(0.3, 0.1, 0.2), Vector3(0.6, 0, 0), Vector3(0.99, 0, 0)})
        // Inextensible cables give way a little under load.
        EXPECT_LT(way(n, stiffness, span), stiffness < infinity ? 1e-9 : 5e-6)
            << n << " " << stiffness << " " << span.transpose();
}

}  // namespace
}  // namespace verlet_cable
