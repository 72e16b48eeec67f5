#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "../support/nets.h"
#include "../support/scenes.h"
#include "verlet_cable/core/jump_text.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

/// [m/s] of boosts, in no special direction.
const Vector3 boost(3, -1, 0.5);

Pose at(const Vector3& position) {
  Pose pose;
  pose.position = position;
  return pose;
}

/// All frames at a place, moving as given from there.
BoundaryInputs moving(std::vector<Pose> poses, const FrameVelocity& velocity) {
  BoundaryInputs inputs;
  for (const Pose& pose : poses) inputs.push_back({pose, true, velocity});
  inputs.front() = FrameInput{};
  return inputs;
}

BoundaryInputs shifted(BoundaryInputs inputs, const Vector3& way) {
  for (std::size_t i = 1; i < inputs.size(); ++i) inputs[i].pose.position += way;
  return inputs;
}

/// A cable between the frames "left" and "hand", which are apart.
SceneDesc between_hands(AttachmentType type, double bending_stiffness, double axial_stiffness) {
  SceneDesc scene = scenes::held_by_a_hand(20, type);
  scene.cables[0].attachments[0].frame = "left";
  scene.materials[0].material.bending_stiffness = bending_stiffness;
  scene.materials[0].material.axial_stiffness = axial_stiffness;
  return scene;
}

/// The scene with its cable at these places, everything of it at one velocity.
SceneDesc at_places(SceneDesc scene, const std::vector<Vector3>& places, const Vector3& velocity) {
  InitialShapeDesc& initial = scene.cables[0].initial;
  initial.type = InitialShapeDesc::Type::points;
  initial.points = places;
  initial.velocities.assign(places.size(), velocity);
  return scene;
}

double largest_tension(const World& world) {
  double largest = 0;
  for (const double t : world.cables()[0].state.tension) largest = std::max(largest, std::abs(t));
  return largest;
}

/// A motion of everything alike changes no force, from the first step on. The inputs of the boosted world say how its frames
/// begin to move, or it finds out.
void expect_galilean_invariance(const SceneDesc& scene, const std::vector<Pose>& frames, bool told) {
  const World shape(scene, moving(frames, {}));
  const std::vector<Vector3> places = shape.cables()[0].state.positions;
  const BoundaryInputs at_rest = moving(frames, {}), at_speed = moving(frames, {boost, Vector3::Zero()});
  BoundaryInputs begin = at_speed;
  if (!told)
    for (FrameInput& input : begin) input.velocity.reset();
  World still(at_places(scene, places, Vector3::Zero()), at_rest), moved(at_places(scene, places, boost), begin);
  double largest = 0, difference = 0;
  for (int i = 1; i <= 300; ++i) {
    const double t = i * scene.time_step;
    ASSERT_EQ(still.step(at_rest).status, Status::ok);
    ASSERT_EQ(moved.step(shifted(at_speed, t * boost)).status, Status::ok);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const CableState &a = still.cables()[0].state, &b = moved.cables()[0].state;
      ASSERT_NEAR((b.positions[k] - a.positions[k] - t * boost).norm(), 0, 1e-9) << i << " " << k;
      if (k + 1 == places.size()) continue;
      largest = std::max(largest, std::abs(a.tension[k]));
      difference = std::max(difference, std::abs(a.tension[k] - b.tension[k]));
    }
  }
  // Between two holders lengths that are rounded at 1e-16 m stand for tensions at 1e7 times the weight.
  EXPECT_LT(difference, 4e-9 * largest);
}

TEST(MovingFrames, ABoostOfEverythingChangesNoForce) {
  const Quaternion down = quaternion_from_rpy({0, 0.9, 0}), up = quaternion_from_rpy({0, -0.9, 0});
  const std::vector<Pose> frames{{}, {{0, 0, 1}, down}, {{0.7, 0.1, 1.1}, up}};
  for (const AttachmentType type : {AttachmentType::hinge, AttachmentType::clamp})
    for (const double bending : {0.0, 0.01})
      for (const double axial : {infinity, 1000.0})
        for (const bool told : {true, false}) {
          SCOPED_TRACE(testing::Message() << (type == AttachmentType::clamp) << " " << bending << " " << axial << " " << told);
          SceneDesc scene = between_hands(type, bending, axial);
          scene.cables[0].initial.type = InitialShapeDesc::Type::catenary;
          expect_galilean_invariance(scene, frames, told);
          scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
          expect_galilean_invariance(scene, frames, told);
        }
}

TEST(MovingFrames, HeldNodesBeginAsTheirFramesMove) {
  for (const auto type : {InitialShapeDesc::Type::catenary, InitialShapeDesc::Type::settled}) {
    SceneDesc scene = between_hands(AttachmentType::clamp, 0, infinity);
    scene.cables[0].initial.type = type;
    const Vector3 angular(0.3, -0.2, 2);
    const BoundaryInputs inputs = moving({Pose{}, at({0, 0, 1}), at({0.7, 0.1, 1})}, {boost, angular});
    World world(scene, inputs);
    for (const bool settled : {false, true}) {
      if (settled) {
        EXPECT_TRUE(world.settle());
      }
      const CableState& state = world.cables()[0].state;
      const std::size_t last = state.positions.size() - 1;
      for (const auto& [node, frame] : {std::pair<std::size_t, int>{0, 1}, {1, 1}, {last - 1, 2}, {last, 2}}) {
        const Vector3 arm = state.positions[node] - inputs[frame].pose.position;
        EXPECT_NEAR((state.velocities[node] - boost - angular.cross(arm)).norm(), 0, 1e-12) << node;
      }
      for (std::size_t i = 0; i < last; ++i) {
        const Vector3 along = (state.positions[i + 1] - state.positions[i]).normalized();
        EXPECT_NEAR(along.dot(state.velocities[i + 1] - state.velocities[i]), 0, 1e-8) << i;
      }
    }
  }
}

TEST(MovingFrames, ATurningClampBeginsWithItsCable) {
  constexpr double rate = 4, density = 0.1;
  for (const double bending : {0.0, 0.01})
    for (const bool told : {true, false}) {
      SceneDesc scene = scenes::one_cable(20);
      scene.gravity.acceleration.setZero();
      scene.materials[0].material.bending_stiffness = bending;
      scene.cables[0].attachments = {scenes::attachment("hub", PlaceDesc::At::start, {0, 0, 0}, "hub", AttachmentType::clamp)};
      scene.cables[0].initial.type = InitialShapeDesc::Type::points;
      scene.cables[0].initial.points = {{0, 0, 0}, {1, 0, 0}};
      scene.cables[0].initial.velocities = {{0, 0, 0}, {0, rate, 0}};
      BoundaryInputs inputs = moving({Pose{}, Pose{}}, {Vector3::Zero(), {0, 0, rate}});
      if (!told) inputs[1].velocity.reset();
      World world(scene, inputs);
      for (int i = 1; i <= 500; ++i) {
        inputs[1].pose.orientation = quaternion_from_rpy({0, 0, rate * i * scene.time_step});
        ASSERT_EQ(world.step(inputs).status, Status::ok);
        // Half of density (rate length)^2 near the hub. Without bending stiffness the clamp holds both ends of the first segment.
        ASSERT_NEAR(world.cables()[0].state.tension[1], 0.5 * density * rate * rate, 0.05 * density * rate * rate) << i;
      }
    }
}

TEST(MovingFrames, ANetBeginsWithItsFrames) {
  for (const LinkType links : {LinkType::spring, LinkType::limited, LinkType::rigid}) {
    SceneDesc scene = scenes::flag(3, 3, 0.05, links);
    scene.nets[0].attachments[0].frame = "pole";
    World world(scene, moving({Pose{}, Pose{}}, {boost, Vector3::Zero()}));
    EXPECT_EQ(world.nets()[0].state.velocities[scene.nets[0].attachments[0].node], boost);
  }
}

/// Hangs straight down from a frame, at rest.
class Hanging {
 public:
  explicit Hanging(double time_step) {
    scene_ = scenes::one_cable(20);
    scene_.time_step = time_step;
    scene_.cables[0].attachments = {scenes::attachment("grip", PlaceDesc::At::start, {0, 0, 0}, "hand")};
    world_.emplace(scene_, scenes::hand_at({0, 0, 0}));
  }

  StepResult step(double x) {
    const StepResult result = world_->step(scenes::hand_at({x, 0, 0}));
    jumps_.insert(jumps_.end(), world_->findings().jumps.begin(), world_->findings().jumps.end());
    EXPECT_EQ(world_->cables()[0].state.positions[0], Vector3(x, 0, 0));
    carried_ += result.status == Status::jumped;
    fastest_ = std::max(fastest_, fastest());
    tightest_ = std::max(tightest_, largest_tension(*world_));
    return result;
  }
  double fastest() const {
    double fastest = 0;
    for (const Vector3& v : world_->cables()[0].state.velocities) fastest = std::max(fastest, v.norm());
    return fastest;
  }
  /// The hand moves by a function of time [s].
  void run(const std::function<double(double)>& x, double from, double to) {
    const double h = scene_.time_step;
    for (double t = from + h; t < to + 0.5 * h; t += h) step(x(t));
  }
  double weight() const { return 9.81 * 0.1; }

  SceneDesc scene_;
  std::optional<World> world_;
  std::vector<Jump> jumps_;
  int carried_ = 0;
  double fastest_ = 0;   ///< [m/s] of all nodes and steps
  double tightest_ = 0;  ///< [N]
};

TEST(Jumps, AFrameThatIsSuddenlyElsewhereCarriesItsCableAlong) {
  for (const double h : {0.0002, 0.001, 0.002, 0.005, 0.02})
    for (const double duration : {1e-5, 0.001, 0.002, 0.005})
      for (const double begin : {0.1, 0.1 + 0.3 * h}) {
        SCOPED_TRACE(testing::Message() << h << " " << duration << " " << begin);
        Hanging hanging(h);
        const auto x = [&](double t) { return 0.2 * std::clamp((t - begin) / duration, 0.0, 1.0); };
        hanging.run(x, 0, 0.3);
        ASSERT_EQ(hanging.jumps_.size(), 1u);
        EXPECT_GT(hanging.carried_, 0);
        // The parts of a step at both ends may be slow enough to be followed.
        EXPECT_NEAR(hanging.jumps_[0].distance, 0.2, 2 * 5 * h + 1e-9);
        EXPECT_LE(hanging.jumps_[0].duration, 0.005 + 2 * h);
        if (begin == 0.1 && duration <= h) {
          EXPECT_LT(hanging.fastest_, 1e-6);
          EXPECT_LT(hanging.tightest_, 1.001 * hanging.weight());
        }
        EXPECT_LT(hanging.fastest_, 10);
      }
}

/// How a frame would have moved on in the step in which it jumps is not known: it is taken to keep its velocity. What that leaves
/// out, its acceleration (here 5 m/s^2), makes a difference of second order in the step; without acceleration it is 1e-10 m.
TEST(Jumps, MotionGoesOnAsBefore) {
  Hanging still(0.001), jumping(0.001);
  for (int i = 1; i <= 1000; ++i) {
    const double x = 0.3 * std::sin(0.004 * i);
    still.step(x);
    jumping.step(x + (i > 300 ? 0.2 : 0) - (i > 700 ? 0.5 : 0));
    const double away = (i > 300 ? 0.2 : 0) - (i > 700 ? 0.5 : 0);
    for (int k = 0; k <= 20; ++k) {
      const Vector3 difference = jumping.world_->cables()[0].state.positions[k] - still.world_->cables()[0].state.positions[k];
      ASSERT_NEAR((difference - Vector3(away, 0, 0)).norm(), 0, 5e-4) << i << " " << k;
    }
  }
  ASSERT_EQ(jumping.jumps_.size(), 2u);
  EXPECT_NEAR(jumping.jumps_[0].distance, 0.2, 1e-3);
  EXPECT_NEAR(jumping.jumps_[0].time, 0.3, 1e-9);
  EXPECT_NEAR(jumping.jumps_[0].duration, 0.001, 1e-9);
  EXPECT_EQ(jumping.world_->frames()[jumping.world_->attachments()[jumping.jumps_[0].attachment].frame], "hand");
}

/// From rest at 0.1 s, by `way` [m] at one speed, or smoothly.
double at_one_speed(double way, double duration, double t) {
  return way * std::clamp((t - 0.1) / duration, 0.0, 1.0);
}
double smoothly(double way, double duration, double t) {
  const double u = std::clamp((t - 0.1) / duration, 0.0, 1.0);
  return way * u * u * (3 - 2 * u);
}

TEST(Jumps, LastNoLongerThanFiveMilliseconds) {
  for (const auto& place : {at_one_speed, smoothly})
    for (const double way : {0.2, 1.0, 5.0})
      for (const double duration : {0.004, 0.005, 0.006, 0.007, 0.008, 0.01, 0.012, 0.02, 0.033}) {
        SCOPED_TRACE(testing::Message() << (place == at_one_speed) << " " << way << " m in " << duration << " s");
        Hanging hanging(0.001);
        hanging.run([&](double t) { return place(way, duration, t); }, 0, 0.15);
        if (duration > 0.0051) {
          EXPECT_TRUE(hanging.jumps_.empty());
          EXPECT_GT(hanging.tightest_, 5 * hanging.weight());
        } else {
          ASSERT_EQ(hanging.jumps_.size(), 1u);
          EXPECT_NEAR(hanging.jumps_[0].distance, way, 1e-9);
          EXPECT_NEAR(hanging.jumps_[0].duration, duration, 1e-9);
          EXPECT_LT(hanging.tightest_, 1.001 * hanging.weight());
        }
      }
  for (const double duration : {0.004, 0.005, 0.006, 0.008}) {
    Hanging hanging(0.001);
    hanging.run([&](double t) { return at_one_speed(20 * duration, duration, t); }, 0, 0.15);
    EXPECT_EQ(hanging.jumps_.size(), duration < 0.0051 ? 1u : 0u) << duration;
  }
}

/// What lasted was a motion, and so is its end: the cable is not carried on.
TEST(Jumps, TheEndOfAShortMotionIsNone) {
  for (const double duration : {0.006, 0.008, 0.01, 0.02}) {
    Hanging hanging(0.001);
    hanging.run([&](double t) { return at_one_speed(20 * duration, duration, t); }, 0, 0.15);
    EXPECT_TRUE(hanging.jumps_.empty()) << duration;
    EXPECT_EQ(hanging.carried_, 5) << duration;
  }
}

TEST(Jumps, OutAndBackLeavesTheCableWhereItWas) {
  Hanging hanging(0.001);
  hanging.run([](double t) { return t > 0.1005 && t < 0.1015 ? 0.0045 : 0; }, 0, 0.3);
  EXPECT_TRUE(hanging.jumps_.empty());
  EXPECT_NEAR(hanging.world_->cables()[0].state.positions[20].x(), 0, 1e-4);
}

TEST(Jumps, ASmoothMotionIsNoneInLongStepsEither) {
  for (const double amplitude : {0.25, 0.5, 1.0})
    for (const double rate : {6, 9, 12}) {
      Hanging hanging(0.1);
      hanging.run([&](double t) { return amplitude * std::sin(rate * t); }, 0, 20);
      EXPECT_TRUE(hanging.jumps_.empty()) << amplitude << " " << rate;
    }
}

TEST(Jumps, AJumpInTheFirstStepIsOne) {
  SceneDesc scene = scenes::one_cable(20);
  scene.cables[0].attachments = {scenes::attachment("grip", PlaceDesc::At::start, {0, 0, 0}, "hand")};
  for (const bool told : {true, false}) {
    BoundaryInputs inputs = scenes::hand_at({0, 0, 0});
    if (told) inputs[1].velocity.emplace();
    World world(scene, inputs);
    EXPECT_EQ(world.step(scenes::hand_at({1, 0, 0})).status, Status::jumped);
    world.step(scenes::hand_at({1, 0, 0}));
    ASSERT_EQ(world.findings().jumps.size(), 1u);
    EXPECT_EQ(jump_text(world, world.findings().jumps[0]), "frame \"hand\" jumped by 1 m within " +
                                                               std::to_string(std::lround(1e3 * scene.time_step)) +
                                                               " ms: cable \"cable\" was carried along with it");
    EXPECT_EQ(jump_text(world, {0, 0.25, 0, 0.2}),
              "frame \"hand\" jumped by 0.25 m within 200 ms: cable \"cable\" was carried "
              "along with it");
    EXPECT_LT(largest_tension(world), 1.001 * 9.81 * 0.1);
  }
}

TEST(Jumps, AHolderThatStandsIsSeenToStand) {
  Hanging hanging(0.001);
  hanging.run([](double t) { return 20 * std::min(t, 0.2); }, 0, 0.2);
  for (int i = 0; i < 20; ++i) {
    hanging.step(4);
    EXPECT_EQ(hanging.world_->cables()[0].state.velocities[0].norm() < 1e-6, true) << i;
  }
  EXPECT_TRUE(hanging.jumps_.empty());
}

TEST(Jumps, AVehicleIsFollowedFromItsStart) {
  Hanging hanging(0.001);
  hanging.run([](double t) { return 30 * t; }, 0, 0.3);
  EXPECT_EQ(hanging.carried_, 0);
}

TEST(Jumps, AFrameThatIsReallyFastIsFollowed) {
  for (const double h : {0.0002, 0.001, 0.002, 0.005}) {
    Hanging hanging(h);
    // To 8 m/s within 20 ms.
    const auto x = [](double t) { return t < 0.02 ? 200 * t * t : 0.08 + 8 * (t - 0.02); };
    hanging.run(x, 0, 0.3);
    EXPECT_EQ(hanging.carried_, 0) << h;
    EXPECT_TRUE(hanging.jumps_.empty()) << h;
  }
}

TEST(Jumps, AChangeOfVelocityThatLastsIsAMotion) {
  for (const double h : {0.0002, 0.001, 0.002, 0.005}) {
    Hanging hanging(h);
    const auto x = [](double t) { return t < 0.2 ? 4 * t : 0.8 - 4 * (t - 0.2); };  // 8 m/s in a step
    hanging.run(x, 0, 0.2);
    EXPECT_EQ(hanging.carried_, 0) << h;
    hanging.run(x, 0.2, 0.4);
    EXPECT_TRUE(hanging.jumps_.empty()) << h;
    EXPECT_LE(hanging.carried_ * h, 0.005 + 2.01 * h) << h;
    EXPECT_NEAR(hanging.world_->cables()[0].state.velocities[0].x(), -4, 1e-6) << h;
  }
}

TEST(Jumps, NoiseIsSurvived) {
  Hanging hanging(0.001);
  unsigned random = 1;
  for (int i = 0; i < 3000; ++i) {
    random = random * 1664525u + 1013904223u;
    const StepResult result = hanging.step(0.005 * (static_cast<double>(random >> 8) / (1 << 23) - 1));
    ASSERT_LT(result.status, Status::degraded);
    ASSERT_LT(hanging.world_->cables()[0].state.positions[20].norm(), 1.001);
  }
  EXPECT_LT(hanging.fastest_, 20);
}

TEST(Jumps, SeveralHandsAtOnceAndTheClampTheyHold) {
  for (const AttachmentType type : {AttachmentType::hinge, AttachmentType::clamp})
    for (const double bending : {0.0, 0.01}) {
      SceneDesc scene = between_hands(type, bending, infinity);
      scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
      const BoundaryInputs inputs = moving({Pose{}, at({0, 0, 1}), at({0.7, 0, 1})}, {});
      World world(scene, inputs);
      for (int i = 0; i < 100; ++i) world.step(inputs);
      const double tension = largest_tension(world);
      const BoundaryInputs away = shifted(inputs, {0.5, 1, 0});
      EXPECT_EQ(world.step(away).status, Status::jumped);
      EXPECT_TRUE(world.findings().jumps.empty());
      World copy = world;
      EXPECT_EQ(copy.hash(), world.hash());
      for (int i = 0; i < 100; ++i) {
        ASSERT_EQ(world.step(away).status, Status::ok);
        copy.step(away);
        EXPECT_EQ(world.findings().jumps.size(), i == 0 ? 2u : 0u);
        EXPECT_LT(largest_tension(world), tension * 1.02);  // a blow is a hundred times as much
      }
      EXPECT_EQ(copy.hash(), world.hash());
    }
}

TEST(Jumps, KnowTheirAttachmentsAfterAnUnpin) {
  SceneDesc scene = between_hands(AttachmentType::hinge, 0, infinity);
  World world(scene, moving({Pose{}, at({0, 0, 1}), at({0.3, 0, 1})}, {}));
  BoundaryInputs inputs = moving({Pose{}, at({0, 0, 1}), at({0.3, 0, 1})}, {});
  for (int i = 0; i < 10; ++i) world.step(inputs);
  inputs.back().pose.position.z() += 0.2;
  for (int i = 0; i < 10 && world.findings().jumps.empty(); ++i) world.step(inputs);
  ASSERT_EQ(world.findings().jumps.size(), 1u);
  const auto name = [&] { return world.attachments().at(world.findings().jumps.at(0).attachment).name; };
  const std::string jumping = name();
  ASSERT_EQ(jumping, world.attachments()[1].name);
  ASSERT_TRUE(world.apply(edit::Unpin{world.attachments()[0].name}).ok);
  EXPECT_EQ(name(), jumping);
  ASSERT_TRUE(world.apply(edit::Unpin{jumping}).ok);
  EXPECT_TRUE(world.findings().jumps.empty());
}

TEST(Jumps, ANetIsCarriedAlongAndKeepsItsMotion) {
  for (const LinkType links : {LinkType::spring, LinkType::limited, LinkType::rigid}) {
    SceneDesc scene = scenes::flag(4, 4, 0.05, links);
    for (NetAttachmentDesc& attachment : scene.nets[0].attachments) attachment.frame = "pole";
    World still(scene, moving({Pose{}, Pose{}}, {})), jumping = still;
    BoundaryInputs inputs = moving({Pose{}, Pose{}}, {});
    for (int i = 0; i < 300; ++i) {
      still.step(inputs);
      const bool away = i >= 100;
      const StepResult result = jumping.step(shifted(inputs, away ? Vector3(0.5, 0, 0.2) : Vector3(0, 0, 0)));
      EXPECT_EQ(result.status == Status::jumped, i == 100) << i;
      EXPECT_EQ(jumping.findings().jumps.empty(), i != 101) << i;
    }
    for (int k = 0; k < 16; ++k) {
      const Vector3 way = jumping.nets()[0].state.positions[k] - still.nets()[0].state.positions[k];
      EXPECT_NEAR((way - Vector3(0.5, 0, 0.2)).norm(), 0, 1e-6) << k;
    }
  }
}

}  // namespace
}  // namespace verlet_cable
