#include <gtest/gtest.h>

#include <ostream>

#include "scene_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

using test::errors_of;
using test::has_line;
using test::joined;
using test::replaced;

const std::string tackle = R"(
materials:
  m: {linear_density: 0.1, radius: 0.005}
bodies:
  - {name: block, mass: 1, inertia: [1, 1, 1], pose: [0.5, 0, 0, 0, 0, 0]}
cables:
  - name: rope
    length: 2
    segments: 40
    material: m
    attachments: [{name: top, at: start}]
    initial: {type: points, points: [[0, 0, 0], [0.5, 0, 0.1], [1, 0, 0], [1, 0, -0.98]]}
  - {name: branch, length: 0.2, segments: 4, material: m}
guides:
  - {name: wheel, cable: rope, at: 0.5, body: block, rotation: [1.5708, 0, 0], type: sheave, radius: 0.1, friction: 2, inertia: 0.01, bearing_friction: 0.2}
  - {name: eye, cable: rope, at: 1.02, frame: mast, offset: [1, 0, -3], initial_pose: [0, 0, 3, 0, 0, 0], friction: .inf}
  - {name: clip, cable: rope, at: 1.5, offset: [1, 0, -0.5], type: clip, friction: 0.2, retention: 8.0, capture: 0.004}
  - {name: hook, cable: rope, offset: [5, 0, 0], type: clip}
)";

TEST(GuideKeys, areRead) {
  const SceneDesc scene = read_scene_text(tackle);
  ASSERT_EQ(scene.guides.size(), 4u);
  const GuideDesc &wheel = scene.guides[0], &eye = scene.guides[1], &clip = scene.guides[2], &hook = scene.guides[3];
  EXPECT_EQ(wheel.name, "wheel");
  EXPECT_EQ(wheel.cable, "rope");
  ASSERT_TRUE(wheel.place);
  EXPECT_EQ(wheel.place->arc_length, 0.5);
  EXPECT_EQ(wheel.body, "block");
  EXPECT_EQ(wheel.rotation, Vector3(1.5708, 0, 0));
  EXPECT_EQ(wheel.type, GuideDesc::Type::sheave);
  EXPECT_EQ(wheel.radius, 0.1);
  EXPECT_EQ(wheel.friction_coefficient(), 2);
  EXPECT_EQ(wheel.inertia, 0.01);
  EXPECT_EQ(wheel.bearing_friction, 0.2);
  EXPECT_EQ(eye.type, GuideDesc::Type::eyelet);
  EXPECT_EQ(eye.frame, "mast");
  EXPECT_EQ(eye.offset, Vector3(1, 0, -3));
  EXPECT_EQ(eye.friction_coefficient(), infinity);
  EXPECT_EQ(clip.type, GuideDesc::Type::clip);
  EXPECT_EQ(clip.retention, 8);
  EXPECT_EQ(clip.capture, 0.004);
  EXPECT_FALSE(hook.place);
  EXPECT_EQ(hook.friction_coefficient(), 0);
  EXPECT_EQ(hook.retention, infinity);
  EXPECT_EQ(hook.capture, 0);
  EXPECT_EQ(frame_names(scene), (std::vector<std::string>{"world", "mast"}));
  EXPECT_TRUE(initial_frames(scene)[1].known);
}

TEST(GuideKeys, aWheelGripsUnlessItsFrictionIsGiven) {
  const SceneDesc scene = read_scene_text(replaced(tackle, "friction: 2, inertia: 0.01, bearing_friction: 0.2", "inertia: 0"));
  EXPECT_EQ(scene.guides[0].friction_coefficient(), infinity);
}

TEST(GuideKeys, shapesInNumbersPassWithinASegment) {
  const auto errors = [](const char* offset) {
    return errors_of(replaced(tackle, "offset: [1, 0, -0.5]", std::string("offset: ") + offset));
  };
  EXPECT_EQ(joined(errors("[1.049, 0, -0.5]")), "");
  EXPECT_TRUE(has_line(errors("[1, 0.051, -0.5]"),
                       "guides[2]: the initial shape of \"rope\" misses it by 0.051 m; allowed: a shape in numbers that passes "
                       "within a segment's length, 0.05 m"))
      << joined(errors("[1, 0.051, -0.5]"));
  // Other shapes follow the guides.
  const std::string hanging = replaced(tackle, "offset: [1, 0, -0.5]", "offset: [9, 9, 9]");
  const std::size_t at = hanging.find("    initial:");
  EXPECT_EQ(joined(errors_of(std::string(hanging).erase(at, hanging.find('\n', at) - at))), "");
}

TEST(GuideKeys, shapesInNumbersPassOverTheWheel) {
  const std::string place = "body: block, rotation: [1.5708, 0, 0]";
  // The wheel's middle below the top of the shape by the radius, and by so much more or less.
  EXPECT_EQ(joined(errors_of(replaced(tackle, place, "offset: [0.5, 0, 0.045], rotation: [1.5708, 0, 0]"))), "");
  for (const auto& [offset, miss] : {std::pair("[0.5, 0, -0.06]", "0.05689"), {"[0.5, 0.06, 0]", "0.06"}})
    EXPECT_TRUE(has_line(errors_of(replaced(tackle, place, std::string("offset: ") + offset + ", rotation: [1.5708, 0, 0]")),
                         std::string("guides[0]: the initial shape of \"rope\" misses it by ") + miss))
        << offset;
}

TEST(GuideKeys, whereNobodyKnowsTheGuideNoShapeMissesIt) {
  EXPECT_EQ(joined(errors_of(replaced(tackle, "offset: [1, 0, -3], initial_pose: [0, 0, 3, 0, 0, 0]", "offset: [7, 7, 7]"))), "");
  EXPECT_EQ(joined(errors_of(replaced(tackle, ", pose: [0.5, 0, 0, 0, 0, 0]", ""))), "");
}

struct GuideMistake {
  const char* name;
  const char* what;
  const char* with;
  const char* error;
};

void PrintTo(const GuideMistake& mistake, std::ostream* stream) {
  *stream << mistake.name;
}

class GuideKeysMistake : public testing::TestWithParam<GuideMistake> {};

TEST_P(GuideKeysMistake, isNamed) {
  const auto errors = errors_of(replaced(tackle, GetParam().what, GetParam().with));
  ASSERT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_EQ(errors[0].rfind(GetParam().error, 0), 0u) << errors[0];
  EXPECT_NE(errors[0].find("; allowed: "), std::string::npos) << errors[0];
}

const GuideMistake mistakes[] = {
    {"unknownKey", "friction: 0.2, retention", "grip: 0.2, retention", "guides[2].grip: unknown key"},
    {"noName", "name: eye, ", "", "guides[1].name: missing;"},
    {"namedLikeACable", "name: eye", "name: rope",
     "guides[1].name: \"rope\"; allowed: a name that is used once; it is cables[0].name"},
    {"namedLikeABody", "name: eye", "name: block",
     "guides[1].name: \"block\"; allowed: a name that is used once; it is bodies[0].name"},
    {"nameTwice", "name: eye", "name: wheel",
     "guides[1].name: \"wheel\"; allowed: a name that is used once; it is guides[0].name"},
    {"noCable", "name: eye, cable: rope", "name: eye", "guides[1].cable: missing;"},
    {"unknownCable", "name: eye, cable: rope", "name: eye, cable: nowhere",
     "guides[1].cable: \"nowhere\"; allowed: a cable of the scene (branch, rope)"},
    {"unknownType", "type: clip, friction", "type: eylet, friction",
     "guides[2].type: \"eylet\"; allowed: eyelet | sheave | clip"},
    {"unknownTypeWithoutPlace", "type: clip}", "type: eylet}", "guides[3].type: \"eylet\";"},
    {"eyeletWithoutPlace", "at: 1.02, ", "", "guides[1].at: missing;"},
    {"sheaveWithoutPlace", "at: 0.5, ", "", "guides[0].at: missing;"},
    {"beyondTheEnd", "at: 1.5", "at: 2.1",
     "guides[2].at: 2.1; allowed: start, end, or an arc length [m] from 0 to the cable's length 2"},
    {"beforeTheStart", "at: 0.5", "at: -0.1", "guides[0].at: -0.1;"},
    {"notInOrder", "at: 1.5", "at: 1.01",
     "guides[2].at: 1.01; allowed: more than the 1.02 m of \"eye\": the guides of a cable are listed in"},
    {"twiceAtOnePlace", "at: 1.5", "at: 1.02", "guides[2].at: 1.02; allowed: more than the 1.02 m of \"eye\""},
    {"whereItIsHeld", "at: 0.5", "at: start",
     "guides[0].at: 0; allowed: a place where nothing holds the cable; attachment \"top\" does"},
    {"whereItIsJoined", "guides:",
     "junctions: [{name: y, cable: branch, at: 0.1, branches: [{cable: rope, end: end}]}]\nguides:\n"
     "  - {name: last, cable: branch, at: 0.1}",
     "guides[0].at: 0.1; allowed: a place where nothing holds the cable; junction \"y\" does"},
    {"bodyAndFrame", "frame: mast, offset: [1, 0, -3], initial_pose: [0, 0, 3, 0, 0, 0]", "frame: mast, body: block",
     "guides[1].body: \"block\", given together with frame \"mast\"; allowed: one of the two"},
    {"unknownBody", "body: block", "body: blok", "guides[0].body: \"blok\"; allowed: a body of the scene (block)"},
    {"frameWithSlash", "frame: mast", "frame: /mast", "guides[1].frame: \"/mast\";"},
    {"frameNamedLikeABody", "frame: mast, offset: [1, 0, -3]", "frame: block, offset: [1, 0, -3]",
     "guides[1].frame: \"block\"; allowed: a frame that is not named like a body"},
    {"offset", "offset: [5, 0, 0]", "offset: [5, 0, .inf]", "guides[3].offset: [5, 0, inf];"},
    {"friction", "friction: 0.2, retention", "friction: -0.2, retention",
     "guides[2].friction: -0.2; allowed: 0 or more, or .inf"},
    {"noRadius", "radius: 0.1, ", "", "guides[0].radius: missing; allowed: any number above 0 [m]"},
    {"zeroRadius", "radius: 0.1", "radius: 0", "guides[0].radius: 0; allowed: any number above 0 [m]"},
    {"inertia", "inertia: 0.01", "inertia: -1", "guides[0].inertia: -1; allowed: 0 or more [kg m^2]"},
    {"bearingFriction", "bearing_friction: 0.2", "bearing_friction: -1",
     "guides[0].bearing_friction: -1; allowed: 0 or more [N m]"},
    {"retention", "retention: 8.0", "retention: 0", "guides[2].retention: 0; allowed: any number above 0, or .inf [N]"},
    {"capture", "capture: 0.004", "capture: -1", "guides[2].capture: -1; allowed: 0 or more [m]"},
    {"radiusOfAClip", "retention: 8.0", "radius: 8.0",
     "guides[2].radius: given with another type; allowed: only with type: sheave"},
    {"captureOfAnEyelet", "friction: .inf", "capture: 1",
     "guides[1].capture: given with another type; allowed: only with type: clip"},
};
INSTANTIATE_TEST_SUITE_P(GuideKeys, GuideKeysMistake, testing::ValuesIn(mistakes),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace verlet_cable
