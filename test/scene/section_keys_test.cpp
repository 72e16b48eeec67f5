#include <gtest/gtest.h>

#include "scene_text.h"

/// Sections of cables: which are there, and what is wrong with others.
namespace verlet_cable {
namespace {

using test::errors_of;
using test::has_line;
using test::joined;
using test::replaced;
using test::sound_scene;

std::string with_sections(const std::string& sections, const std::string& more_materials = "") {
  const std::string materials =
      "  wire: {linear_density: 0.3, radius: 0.002, minimum_bend_radius: 0.05, maximum_tension: 20, "
      "transverse_stiffness: 2e5, maximum_squeeze: 300}\n";
  return replaced(replaced(sound_scene, "cables:", materials + more_materials + "cables:"),
                  "    color:", "    sections: " + sections + "\n    color:");
}

TEST(SectionKeys, AreRead) {
  const SceneDesc scene =
      read_scene_text(with_sections("[{from: 0.5, to: 1.0, material: wire}, {from: 0, to: '0.1', material: rov_tether}]"));
  ASSERT_EQ(scene.cables[0].sections.size(), 2u);
  EXPECT_EQ(scene.cables[0].sections[0].from, 0.5);
  EXPECT_EQ(scene.cables[0].sections[1].to, 0.1);
  EXPECT_EQ(scene.cables[0].sections[0].material, "wire");
  ASSERT_NE(scene.find_material("rov_tether"), nullptr) << "a preset comes along";
  EXPECT_EQ(scene.find_material("wire")->minimum_bend_radius, 0.05);
  EXPECT_EQ(scene.find_material("wire")->maximum_tension, 20);
  EXPECT_EQ(scene.find_material("wire")->transverse_stiffness, 2e5);
  EXPECT_EQ(scene.find_material("wire")->maximum_squeeze, 300);
  EXPECT_EQ(scene.find_material("m")->transverse_stiffness, infinity);
  EXPECT_EQ(scene.find_material("m")->maximum_squeeze, infinity);
  EXPECT_EQ(scene.find_material("m")->minimum_bend_radius, 0);
  EXPECT_EQ(scene.find_material("m")->maximum_tension, infinity);
}

struct BadSections {
  const char* sections;
  const char* error;
};

class BadSection : public testing::TestWithParam<BadSections> {};

TEST_P(BadSection, IsNamed) {
  const std::vector<std::string> errors = errors_of(with_sections(GetParam().sections));
  EXPECT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_TRUE(has_line(errors, std::string("cables[0].sections") + GetParam().error)) << joined(errors);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadSection,
    testing::Values(
        BadSections{"{from: 0, to: 1, material: wire}", ": "}, BadSections{"[wire]", "[0]: "},
        BadSections{"[{from: 0, to: 0.5}]", "[0].material: missing"},
        BadSections{"[{to: 0.5, material: wire}]", "[0].from: missing"},
        BadSections{"[{from: 0, to: 0.5, material: wires}]", "[0].material: \"wires\"; allowed: "},
        BadSections{"[{from: 0, to: 0.5, material: wire, with: 1}]", "[0].with: unknown key"},
        BadSections{"[{from: -0.1, to: 0.5, material: wire}]", "[0].from: -0.1; allowed: "},
        BadSections{"[{from: 0, to: .nan, material: wire}]", "[0].to: "},
        BadSections{"[{from: 0, to: .inf, material: wire}]", "[0].to: "},
        BadSections{"[{from: 0.5, to: 1.1, material: wire}]", "[0].to: 1.1; allowed: at most the cable's length, 1 m"},
        BadSections{"[{from: 0.5, to: 0.5, material: wire}]", "[0].to: 0.5; allowed: more than cables[0].sections[0].from"},
        BadSections{"[{from: 0.5, to: 0.7, material: wire}, {from: 0, to: 0.6, material: m}]",
                    "[1]: 0 to 0.6 m; allowed: sections that do not overlap; cables[0].sections[0] is from 0.5 to 0.7 m"},
        BadSections{"[{from: 0.03, to: 0.06, material: wire}]", "[0]: 0.03 to 0.06 m; allowed: with the middle of a segment"}));

/// Before each is compared with each other.
TEST(SectionKeys, MoreThanSegmentsAreRefused) {
  std::string sections = "[";
  for (int i = 0; i < 100'000; ++i) sections += "{from: 0, to: 0.5, material: wire}, ";
  const std::vector<std::string> errors = errors_of(with_sections(sections + "]"));
  ASSERT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_TRUE(has_line(errors, "cables[0].sections: 100000 sections; allowed: at most one for each segment, ")) << errors[0];
}

TEST(SectionKeys, AllThatIsWrongIsNamedAtOnce) {
  const std::vector<std::string> errors =
      errors_of(replaced(with_sections("[{from: 0.5, to: 2, material: wire}, {from: 0.1, to: 0.3, material: none}]"),
                         "maximum_tension: 20", "maximum_tension: 0"));
  EXPECT_EQ(errors.size(), 3u) << joined(errors);
  EXPECT_TRUE(has_line(errors, "materials.wire.maximum_tension: 0; allowed: any number above 0, or .inf [N]")) << joined(errors);
}

/// Frames of the material go through the whole cable: what passes them on must resist twist.
TEST(SectionKeys, BesideWhatBendsUnequallyTorsionalStiffnessIsRequired) {
  const std::string ribbon =
      "  ribbon: {linear_density: 0.1, radius: 0.002, bending_stiffness: [0.1, 0.2], torsional_stiffness: 0.1}\n";
  const std::string sections = "[{from: 0, to: 0.2, material: ribbon}, {from: 0.5, to: 0.7, material: wire}]";
  const std::vector<std::string> errors = errors_of(with_sections(sections, ribbon));
  EXPECT_EQ(errors.size(), 2u) << joined(errors);
  for (const char* name : {"m", "wire"})
    EXPECT_TRUE(
        has_line(errors, std::string("materials.") + name +
                             ".torsional_stiffness: 0; allowed: any number above 0 [N m^2] as cables[0] is of ribbon, too"))
        << joined(errors);
}

/// A cable that is held further apart than it is long can stretch where a section does.
TEST(SectionKeys, OneElasticSectionLetsACableStretch) {
  const std::string far = replaced(sound_scene, "initial_pose: [0.7,", "initial_pose: [1.1,");
  EXPECT_TRUE(has_line(errors_of(far), "cables[0].length: "));
  const std::string rubber = "  rubber: {linear_density: 0.1, radius: 0.002, axial_stiffness: 50}\n";
  EXPECT_TRUE(errors_of(replaced(with_sections("[{from: 0.2, to: 0.4, material: rubber}]", rubber), "initial_pose: [0.7,",
                                 "initial_pose: [1.1,"))
                  .empty());
  // Not beside it.
  EXPECT_TRUE(
      has_line(errors_of(replaced(replaced(with_sections("[{from: 0.2, to: 0.4, material: rubber}]", rubber),
                                           "initial_pose: [0.7,", "initial_pose: [1.1,"),
                                  "    point_masses", "      - {name: middle, at: 0.5, offset: [0.1, 0, 0]}\n    point_masses")),
               "cables[0].length: 0.5 m of cable between \"middle\" and \"right\""));
}

}  // namespace
}  // namespace verlet_cable
