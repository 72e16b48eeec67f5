#include <gtest/gtest.h>

#include <ostream>

#include "scene_text.h"

namespace verlet_cable {
namespace {

using test::errors_of;
using test::joined;
using test::replaced;

const std::string harness = R"(
materials:
  m: {linear_density: 0.1, radius: 0.005, bending_stiffness: 0.01}
cables:
  - {name: trunk, length: 1, segments: 10, material: m, attachments: [{name: top, at: start}]}
  - {name: left, length: 0.5, segments: 5, material: m, attachments: [{name: tip, at: end, frame: hand}]}
  - {name: right, length: 0.5, segments: 5, material: m}
  - {name: twig, length: 0.2, segments: 4, material: m}
junctions:
  - name: fork
    cable: trunk
    at: 0.6
    branches: [{cable: left, end: start, rotation: [0, 0, 0.6]}, {cable: right, end: end}]
    type: hinge
    mass: 0.01
  - {name: knot, cable: right, at: start, branches: [{cable: twig}]}
)";

TEST(JunctionKeys, areRead) {
  const SceneDesc scene = read_scene_text(harness);
  ASSERT_EQ(scene.junctions.size(), 2u);
  const JunctionDesc &fork = scene.junctions[0], &knot = scene.junctions[1];
  EXPECT_EQ(fork.name, "fork");
  EXPECT_EQ(fork.cable, "trunk");
  EXPECT_EQ(fork.place.at, PlaceDesc::At::arc_length);
  EXPECT_EQ(fork.place.arc_length, 0.6);
  ASSERT_EQ(fork.branches.size(), 2u);
  EXPECT_EQ(fork.branches[0].cable, "left");
  EXPECT_EQ(fork.branches[0].end, BranchDesc::End::start);
  EXPECT_EQ(fork.branches[0].rotation, Vector3(0, 0, 0.6));
  EXPECT_EQ(fork.branches[1].end, BranchDesc::End::end);
  EXPECT_EQ(fork.type, JunctionDesc::Type::hinge);
  EXPECT_EQ(fork.mass, 0.01);
  EXPECT_EQ(knot.place.at, PlaceDesc::At::start);
  EXPECT_EQ(knot.branches[0].end, BranchDesc::End::start);
  EXPECT_EQ(knot.type, JunctionDesc::Type::rigid);
  EXPECT_EQ(knot.mass, 0);
}

TEST(JunctionKeys, cablesMayFormLoops) {
  // Both ends of one cable, and the end of a cable at its own middle.
  EXPECT_EQ(joined(errors_of(replaced(harness, "at: start, branches: [{cable: twig}]",
                                      "at: 0.2, branches: [{cable: twig}, {cable: twig, end: end}]"))),
            "");
  EXPECT_EQ(
      joined(errors_of(replaced(harness, "branches: [{cable: twig}]", "branches: [{cable: twig}, {cable: trunk, end: end}]"))),
      "");
  EXPECT_EQ(
      joined(errors_of(replaced(harness, "{cable: right, end: end}]", "{cable: right, end: end}, {cable: trunk, end: end}]"))),
      "");
}

TEST(JunctionKeys, whatIsJoinedIsHeld) {
  const std::string settled = replaced(harness, "segments: 4, material: m", "segments: 4, material: m, initial: {type: settled}");
  EXPECT_EQ(joined(errors_of(settled)), "");
  const auto errors = errors_of(replaced(settled, "{cable: twig}", "{cable: trunk, end: end}"));
  ASSERT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_EQ(errors[0].rfind("cables[3].initial.type: settled without attachments;", 0), 0u) << errors[0];
}

struct JunctionMistake {
  const char* name;
  const char* what;
  const char* with;
  const char* error;
};

void PrintTo(const JunctionMistake& mistake, std::ostream* stream) {
  *stream << mistake.name;
}

class JunctionKeysMistake : public testing::TestWithParam<JunctionMistake> {};

TEST_P(JunctionKeysMistake, isNamed) {
  const auto errors = errors_of(replaced(harness, GetParam().what, GetParam().with));
  ASSERT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_EQ(errors[0].rfind(GetParam().error, 0), 0u) << errors[0];
  EXPECT_NE(errors[0].find("; allowed: "), std::string::npos) << errors[0];
}

const JunctionMistake mistakes[] = {
    {"unknownKey", "mass: 0.01", "weight: 1", "junctions[0].weight: unknown key"},
    {"noName", "name: knot, ", "", "junctions[1].name: missing;"},
    {"nameTwice", "name: knot", "name: fork",
     "junctions[1].name: \"fork\"; allowed: a name that is used once; it is junctions[0].name"},
    {"noCable", "    cable: trunk\n", "", "junctions[0].cable: missing;"},
    {"unknownCable", "cable: trunk", "cable: stem",
     "junctions[0].cable: \"stem\"; allowed: a cable of the scene (left, right, trunk, twig)"},
    {"noPlace", "    at: 0.6\n", "", "junctions[0].at: missing;"},
    {"beyondTheEnd", "at: 0.6", "at: 9.0",
     "junctions[0].at: 9; allowed: start, end, or an arc length [m] from 0 to the cable's length 1"},
    {"place", "at: 0.6", "at: middle", "junctions[0].at: \"middle\";"},
    {"noBranches", ", branches: [{cable: twig}]", "", "junctions[1].branches: missing;"},
    {"branchesEmpty", "[{cable: twig}]", "[]", "junctions[1].branches: none; allowed: a list of at least one branch"},
    {"branchOfNothing", "[{cable: twig}]", "[{end: start}]", "junctions[1].branches[0].cable: missing;"},
    {"unknownBranch", "{cable: twig}", "{cable: leaf}",
     "junctions[1].branches[0].cable: \"leaf\"; allowed: a cable of the scene ("},
    {"branchWithKey", "{cable: twig}", "{cable: twig, at: 0.1}", "junctions[1].branches[0].at: unknown key"},
    {"end", "{cable: twig}", "{cable: twig, end: middle}", "junctions[1].branches[0].end: \"middle\"; allowed: start | end"},
    {"rotation", "rotation: [0, 0, 0.6]", "rotation: 0.6",
     "junctions[0].branches[0].rotation: 0.6; allowed: three finite numbers"},
    {"infiniteRotation", "rotation: [0, 0, 0.6]", "rotation: [0, 0, .inf]", "junctions[0].branches[0].rotation: [0, 0, inf];"},
    {"type", "type: hinge", "type: weld", "junctions[0].type: \"weld\"; allowed: rigid | hinge"},
    {"mass", "mass: 0.01", "mass: -0.01", "junctions[0].mass: -0.01; allowed: 0 or more [kg]"},
    {"withItselfAtOnePlace", "cable: right, at: start, branches: [{cable: twig}]",
     "cable: twig, at: end, branches: [{cable: twig, end: end}]",
     "junctions[1].branches[0]: end of \"twig\", where the junction is; allowed: another cable, or another place of this one"},
    {"withItselfTooNear", "cable: right, at: start, branches: [{cable: twig}]",
     "cable: twig, at: 0.1, branches: [{cable: twig, end: end}]",
     "junctions[1].branches[0]: end of \"twig\", 2 of its segments from the junction; allowed: an end at least 3 segments away"},
    {"endJoinedTwice", "{cable: twig}", "{cable: twig}, {cable: left}",
     "junctions[1].branches[1].end: start of \"left\"; allowed: an end that is joined once; junctions[0].branches[0] joins it"},
    {"endThatIsHeld", "{cable: twig}", "{cable: twig}, {cable: left, end: end}",
     "junctions[1].branches[1].end: end of \"left\"; allowed: an end that nothing else holds; attachment \"tip\" does"},
    {"endWithAJunction", "at: start, branches", "at: end, branches",
     "junctions[0].branches[1].end: end of \"right\"; allowed: an end without a junction of its own; junctions[1] is there"},
    {"twoAtOneNode", "cable: right, at: start", "cable: trunk, at: 0.58",
     "junctions[1].at: node 6 of \"trunk\"; allowed: a node that has no other junction; junctions[0] is there"},
};
INSTANTIATE_TEST_SUITE_P(JunctionKeys, JunctionKeysMistake, testing::ValuesIn(mistakes),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace verlet_cable
