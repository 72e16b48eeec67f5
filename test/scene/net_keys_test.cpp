#include <gtest/gtest.h>

#include <ostream>

#include "scene_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

using test::errors_of;
using test::joined;
using test::replaced;

const std::string lecture_scene = R"(
time_step: 0.002
gravity: {type: central, mu: 2.5, center: [1, 2, 3]}
integrator: verlet
particles:
  - {name: planet, mass: 1.5, position: [1, 0, 0], velocity: [0, 1.1, 0], restitution: 0.5, friction: 0.25, radius: 0.1, color: [0, 1, 0, 1]}
nets:
  - name: flag
    grid: {rows: 3, columns: 4, spacing: 0.1, origin: [0, 0, 2], x_axis: [2, 0, 0], y_axis: [0, 0, -1]}
    mass: 0.12
    links: limited
    stiffness: 50
    damping: 0.1
    tolerance: 0.2
    attachments:
      - {name: a, node: 0, offset: [0, 0, 2]}
      - {name: b, node: 3, frame: pole, initial_pose: [0.3, 0, 2, 0, 0, 0]}
  - name: figure
    nodes: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    links: [[0, 1], [1, 2], [2, 0]]
    link_type: rigid
    masses: [1, 2, 3]
    velocity: [1, 0, 0]
    minimum_distances: [[0, 2, 0.5]]
)";

TEST(NetKeys, areRead) {
  const SceneDesc scene = read_scene_text(lecture_scene);
  EXPECT_EQ(scene.gravity.type, GravityDesc::Type::central);
  EXPECT_EQ(scene.gravity.mu, 2.5);
  EXPECT_EQ(scene.gravity.center, Vector3(1, 2, 3));
  ASSERT_EQ(scene.particles.size(), 1u);
  EXPECT_EQ(scene.particles[0].mass, 1.5);
  EXPECT_EQ(scene.particles[0].velocity, Vector3(0, 1.1, 0));
  EXPECT_EQ(scene.particles[0].restitution, 0.5);
  ASSERT_EQ(scene.nets.size(), 2u);
  const NetDesc &flag = scene.nets[0], &figure = scene.nets[1];
  ASSERT_TRUE(flag.grid);
  EXPECT_EQ(flag.node_count(), 12u);
  EXPECT_EQ(flag.link_count(), 9u + 8u + 12u);
  EXPECT_EQ(flag.link_type, LinkType::limited);
  EXPECT_EQ(flag.tolerance, 0.2);
  EXPECT_EQ(flag.attachments[1].node, 3);
  EXPECT_EQ(figure.link_type, LinkType::rigid);
  EXPECT_EQ(figure.links[2], (std::array<int, 2>{2, 0}));
  EXPECT_EQ(figure.masses, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(figure.minimum_distances[0].distance, 0.5);
  EXPECT_EQ(frame_names(scene), (std::vector<std::string>{"world", "pole"}));
  EXPECT_TRUE(initial_frames(scene)[1].known);
}

TEST(NetKeys, integratorMayNameItsFirstStep) {
  const SceneDesc scene =
      read_scene_text(replaced(lecture_scene, "integrator: verlet", "integrator: {type: verlet, first_step: lecture}"));
  EXPECT_EQ(scene.integrator.first_step, IntegratorDesc::FirstStep::lecture);
  const SceneDesc planet =
      read_scene_text("{integrator: pc5, particles: [{name: planet, mass: 1}], gravity: {type: central, mu: 1}}");
  EXPECT_EQ(planet.integrator.type, IntegratorDesc::Type::pc5);
}

struct NetMistake {
  const char* name;
  const char* what;
  const char* with;
  const char* error;
};

void PrintTo(const NetMistake& mistake, std::ostream* stream) {
  *stream << mistake.name;
}

class NetKeysMistake : public testing::TestWithParam<NetMistake> {};

TEST_P(NetKeysMistake, isNamed) {
  const auto errors = errors_of(replaced(lecture_scene, GetParam().what, GetParam().with));
  ASSERT_EQ(errors.size(), 1u) << joined(errors);
  EXPECT_EQ(errors[0].rfind(GetParam().error, 0), 0u) << errors[0];
  EXPECT_NE(errors[0].find("; allowed: "), std::string::npos) << errors[0];
}

const NetMistake mistakes[] = {
    {"linkToItself", "[1, 2], [2, 0]]", "[1, 1]]", "nets[1].links[1]: [1, 1]; allowed: two different nodes from 0 to 2"},
    {"linkBeyondTheNodes", "[1, 2], [2, 0]]", "[1, 3]]", "nets[1].links[1]: [1, 3]; allowed: two different nodes from 0 to 2"},
    {"linkBeforeTheNodes", "[1, 2], [2, 0]]", "[-1, 2]]", "nets[1].links[1]: [-1, 2];"},
    {"linkTwice", "[1, 2], [2, 0]]", "[1, 0]]", "nets[1].links[1]: [1, 0]; allowed: nodes that no other link joins"},
    {"linkOfThree", "[1, 2], [2, 0]]", "[1, 0, 2]]", "nets[1].links[1]: [1, 0, 2];"},
    {"linkOfHalves", "[1, 2], [2, 0]]", "[0.5, 2]]", "nets[1].links[1][0]: 0.5;"},
    {"linkWithoutLength", "[0, 1, 0]]", "[1, 0, 0]]", "nets[1].links[1]: nodes that are 0 m apart;"},
    {"linksOfAnotherKind", "links: limited", "links: elastic", "nets[0].links: \"elastic\"; allowed: spring | limited | rigid"},
    {"linkTypeTwice", "links: limited", "links: limited\n    link_type: limited",
     "nets[0].link_type: given, although links gives it, too"},
    {"zeroRows", "rows: 3", "rows: 0", "nets[0].grid.rows: 0;"},
    {"zeroColumns", "columns: 4", "columns: 0", "nets[0].grid.columns: 0;"},
    {"zeroSpacing", "spacing: 0.1", "spacing: 0", "nets[0].grid.spacing: 0;"},
    {"parallelAxes", "y_axis: [0, 0, -1]", "y_axis: [1, 0, 0]", "nets[0].grid.y_axis: [1, 0, 0];"},
    {"zeroAxis", "x_axis: [2, 0, 0]", "x_axis: [0, 0, 0]", "nets[0].grid.x_axis: [0, 0, 0];"},
    {"nodesBesideAGrid", "mass: 0.12", "mass: 0.12\n    nodes: [[0, 0, 0]]", "nets[0].nodes: given together with grid;"},
    {"neitherGridNorNodes",
     "    nodes: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n    links: [[0, 1], [1, 2], [2, 0]]\n    link_type: rigid\n"
     "    masses: [1, 2, 3]\n    velocity: [1, 0, 0]\n    minimum_distances: [[0, 2, 0.5]]",
     "    mass: 1", "nets[1].nodes: missing;"},
    {"nanNode", "[0, 1, 0]]", "[0, .nan, 0]]", "nets[1].nodes[2]: [0, .nan, 0];"},
    {"zeroMass", "mass: 0.12", "mass: 0", "nets[0].mass: 0;"},
    {"nanMass", "mass: 0.12", "mass: .nan", "nets[0].mass: \".nan\";"},
    {"noMass", "    mass: 0.12\n", "", "nets[0].mass: missing;"},
    {"massAndMasses", "masses: [1, 2, 3]", "masses: [1, 2, 3]\n    mass: 6", "nets[1].mass: 6; allowed: either mass"},
    {"tooFewMasses", "masses: [1, 2, 3]", "masses: [1, 2]", "nets[1].masses: 2 numbers; allowed: one for each node: 3"},
    {"negativeMasses", "masses: [1, 2, 3]", "masses: [1, -2, 3]", "nets[1].masses[1]: -2;"},
    {"negativeStiffness", "stiffness: 50", "stiffness: -50", "nets[0].stiffness: -50;"},
    {"infiniteDamping", "damping: 0.1", "damping: .inf", "nets[0].damping: inf;"},
    {"zeroTolerance", "tolerance: 0.2", "tolerance: 0", "nets[0].tolerance: 0;"},
    {"toleranceOfRigidLinks", "link_type: rigid", "link_type: rigid\n    tolerance: 0.1",
     "nets[1].tolerance: given with other links"},
    {"minimumDistanceOfSprings", "link_type: rigid", "link_type: spring",
     "nets[1].minimum_distances: given for links that are springs;"},
    {"minimumDistanceToItself", "[[0, 2, 0.5]]", "[[2, 2, 0.5]]", "nets[1].minimum_distances[0]: [2, 2];"},
    {"zeroMinimumDistance", "[[0, 2, 0.5]]", "[[0, 2, 0]]", "nets[1].minimum_distances[0]: 0;"},
    {"attachmentBeyondTheNodes", "node: 3,", "node: 12,",
     "nets[0].attachments[1].node: 12; allowed: a node of the net, from 0 to 11"},
    {"attachmentBeforeTheNodes", "node: 3,", "node: -1,", "nets[0].attachments[1].node: -1;"},
    {"twoAttachmentsAtOneNode", "node: 3,", "node: 0,",
     "nets[0].attachments[1].node: 0; allowed: a node that no other attachment holds; nets[0].attachments[0] does"},
    {"sameAttachmentName", "{name: b,", "{name: a,", "nets[0].attachments[1].name: \"a\";"},
    {"attachmentWithoutNode", "node: 3, ", "", "nets[0].attachments[1].node: missing;"},
    {"poseOfTheFixedFrame", "{name: a, node: 0,", "{name: a, node: 0, initial_pose: [1, 0, 0, 0, 0, 0],",
     "nets[0].attachments[0].initial_pose: [1, 0, 0, 0, 0, 0];"},
    {"netNamedLikeAParticle", "name: flag", "name: planet", "nets[0].name: \"planet\"; allowed: a name that is used once"},
    {"particleWithoutMass", "mass: 1.5, ", "", "particles[0].mass: missing;"},
    {"lightParticle", "mass: 1.5", "mass: 0", "particles[0].mass: 0;"},
    {"infinitePosition", "position: [1, 0, 0]", "position: [.inf, 0, 0]", "particles[0].position: [inf, 0, 0];"},
    {"springyParticle", "restitution: 0.5", "restitution: 1.5", "particles[0].restitution: 1.5;"},
    {"unknownIntegrator", "integrator: verlet", "integrator: rk5", "integrator: \"rk5\"; allowed: verlet | euler | rk4 | pc5"},
    {"firstStepOfEuler", "integrator: verlet\nparticles", "integrator: {type: leapfrog}\nparticles",
     "integrator.type: \"leapfrog\"; allowed: verlet | euler | rk4 | pc5"},
    {"tooManyLinks", "time_step: 0.002", "time_step: 0.002\nlimits: {segments: 32}",
     "cables, nets, particles: 33 segments, links and particles in all; allowed: at most limits.segments = 32"},
};

INSTANTIATE_TEST_SUITE_P(Each, NetKeysMistake, testing::ValuesIn(mistakes),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(NetKeys, otherIntegratorsAreForParticlesAndSpringsOnly) {
  for (const char* integrator : {"euler", "rk4", "pc5"}) {
    const auto errors = errors_of(replaced(lecture_scene, "integrator: verlet", "integrator: " + std::string(integrator)));
    ASSERT_EQ(errors.size(), 2u) << joined(errors);
    EXPECT_EQ(
        errors[0].rfind("integrator: " + std::string(integrator) + " with the limited links of nets[0]; allowed: verlet", 0), 0u)
        << errors[0];
    EXPECT_EQ(errors[1].rfind("integrator: " + std::string(integrator) + " with the rigid links of nets[1];", 0), 0u)
        << errors[1];
    EXPECT_TRUE(test::has_line(errors_of(test::sound_scene + "integrator: " + integrator + "\n"),
                               "integrator: " + std::string(integrator) + " with cables; allowed: verlet"));
  }
}

}  // namespace
}  // namespace verlet_cable
