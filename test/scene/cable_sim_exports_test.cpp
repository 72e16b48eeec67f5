#include "cable_sim/usd_record.h"
#include "cable_sim_fixture.h"
#include "scene/surface.h"

namespace verlet_cable {
namespace {

using cable_sim::usd_identifier;
using cable_sim::UsdSamples;

/// A rope that breaks, so that there are other cables later; a net, a particle and a body beside it.
const std::string breaking = R"(
time_step: 0.005
materials: {m: {linear_density: 0.1, radius: 0.005, breaking_tension: 4.0}, thick: {linear_density: 0.1, radius: 0.02}}
cables: [{name: rope, length: 1.0, segments: 10, material: m, color: [1, 0.2, 0.1, 0.5],
          point_masses: [{at: end, mass: 0.5}],
          attachments: [{name: hand, at: start, frame: hand, initial_pose: [0, 0, 2, 0, 0, 0]}],
          initial: {type: straight, from: [0, 0, 2], to: [0.8, 0, 1.4]}},
         {name: other, length: 1.0, segments: 4, material: m, sections: [{from: 0.5, to: 1.0, material: thick}],
          initial: {type: straight, from: [0, 1, 2], to: [1, 1, 2]}}]
particles: [{name: p, mass: 0.1, position: [1, 1, 1], velocity: [0, 0, 0]}]
nets: [{name: net, grid: {rows: 2, columns: 2, spacing: 0.1}, mass: 0.1, stiffness: 50}]
bodies: [{name: plug, mass: 0.1, shapes: [{type: box, size: [0.1, 0.1, 0.1]}], pose: [5, 0, 1, 0, 0, 0]}]
obstacles: [{name: floor, type: plane}, {name: ball, type: sphere, radius: 0.1, pose: [5, 4, 0, 0, 0, 0]}]
)";

TEST_F(CableSim, exportsAreWholeAndTheSameOnEveryRun) {
  const std::string scene = write("scene.yaml", breaking) + " --duration 0.5 --rate 50";
  for (const char* number : {"1", "2"})
    ASSERT_EQ(run(scene + " --usd " + path(number) + ".usda --vtk " + path("vtk") + number), 0) << err;
  const std::string usd = content(path("1.usda"));
  EXPECT_EQ(usd.rfind("#usda 1.0\n", 0), 0u);
  EXPECT_EQ(content(path("2.usda")), usd);
  for (const char* name :
       {"cables.pvd", "bodies.pvd", "obstacles.pvd", "cables_0025.vtp", "bodies_0025.vtp", "obstacles_0025.vtp"}) {
    EXPECT_TRUE(exists(std::string("vtk1/") + name)) << name;
    EXPECT_EQ(content(path("vtk1/") + name), content(path("vtk2/") + name)) << name;
  }
  EXPECT_FALSE(exists("vtk1/cables_0026.vtp"));
  // Into a directory that is there already.
  ASSERT_EQ(run(scene + " --vtk " + path("vtk1")), 0) << err;
}

TEST_F(CableSim, exportsThatCannotBeAreRefusedBeforeAnythingIsSimulated) {
  const std::string scene = write("scene.yaml", breaking) + " --output " + path("o.csv");
  EXPECT_EQ(run(scene + " --usd " + path("a.usd") + " --vtk " + path("scene.yaml")), 2);
  EXPECT_EQ(err, "cable_sim: --usd: \"" + path("a.usd") +
                     "\"; allowed: a name that ends in .usda\ncable_sim: --vtk: cannot write \"" + path("scene.yaml") +
                     "\": it is not a directory; allowed: a directory that can be written, or a new one in such a directory\n"
                     "cable_sim: 2 errors, nothing was simulated\n");
  EXPECT_EQ(run(scene + " --usd " + path("nowhere/a.usda") + " --vtk " + path("nowhere/vtk")), 2);
  EXPECT_NE(err.find("cable_sim: --usd: cannot write \"" + path("nowhere/a.usda") + "\": "), std::string::npos) << err;
  EXPECT_NE(err.find("cable_sim: --vtk: cannot write \"" + path("nowhere/vtk") + "\": it cannot be made: No such file"),
            std::string::npos)
      << err;
  EXPECT_FALSE(exists("o.csv"));
}

TEST(Usd, identifiersAreValidAndDifferent) {
  std::set<std::string> used;
  EXPECT_EQ(usd_identifier("hose", used), "hose");
  EXPECT_EQ(usd_identifier("hose", used), "hose_2");
  EXPECT_EQ(usd_identifier("arm/link-1", used), "arm_link_1");
  EXPECT_EQ(usd_identifier("arm_link-1", used), "arm_link_1_2");
  EXPECT_EQ(usd_identifier("2nd", used), "_2nd");
  EXPECT_EQ(usd_identifier("", used), "_");
  EXPECT_EQ(usd_identifier("\xc3\xa4", used), "__");
}

TEST(Usd, whatStandsStillHasOneValueAndKeepsItUntilItChanges) {
  UsdSamples still, moving;
  for (const char* code : {"0", "1", "2"}) still.add(code, "(1, 2)");
  EXPECT_EQ(still.statement("", "double2 a"), "double2 a = (1, 2)\n");
  // Values are interpolated: it must not begin to move at 0.
  for (const char* code : {"0", "1", "2"}) moving.add(code, "5");
  moving.add("3", "6");
  EXPECT_EQ(moving.statement("", "double a"), "double a.timeSamples = {\n    0: 5,\n    2: 5,\n    3: 6,\n}\n");
}

/// [m^3] by the divergence theorem: positive where faces are counterclockwise from outside.
double volume(const Surface& surface) {
  double sum = 0;
  for (const std::vector<int>& face : surface.faces)
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      sum += surface.points[face[0]].dot(surface.points[face[k]].cross(surface.points[face[k + 1]])) / 6;
  return sum;
}

TEST(Surface, isClosedAndFacesOutwards) {
  EXPECT_NEAR(volume(surface_of(BoxShape{{1, 2, 3}}, 1)), 6, 1e-12);
  // 32 corners: 32 / 2 sin(2 pi / 32) instead of pi.
  const double polygon = 16 * std::sin(2 * M_PI / 32);
  EXPECT_NEAR(volume(surface_of(CylinderShape{0.5, 2}, 1)), polygon * 0.25 * 2, 1e-12);
  // Facets are inside of what is round, and cut off less than 2 % of it.
  const double sphere = volume(surface_of(SphereShape{0.5}, 1)), ball = 4.0 / 3 * M_PI * 0.125;
  EXPECT_LT(sphere, ball);
  EXPECT_GT(sphere, 0.98 * ball);
  EXPECT_NEAR(volume(surface_of(CapsuleShape{0.5, 2}, 1)), sphere + polygon * 0.25 * 2, 1e-12);
}

}  // namespace
}  // namespace verlet_cable
