// Obstacles of the topic that come before the start or while it is being built, with a ROS master: what diagnostics read of them.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <string>
#include <vector>

#include "simulation/simulation.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

const ros::WallDuration patience(60.0);  // far more than the scene takes to build, with sanitizers on a busy machine

/// A clamped rod that starts in equilibrium: seconds of work, far more than what is built in an update.
SceneDesc slow_scene() {
  SceneDesc scene;
  scene.materials.resize(1);
  scene.materials[0].name = "rod";
  scene.materials[0].material.linear_density = 0.1;
  scene.materials[0].material.radius = 0.005;
  scene.materials[0].material.bending_stiffness = 1;
  CableDesc cable;
  cable.name = "rod";
  cable.length = 1;
  cable.segments = 5000;
  cable.material = "rod";
  cable.initial.type = InitialShapeDesc::Type::settled;
  AttachmentDesc clamp;
  clamp.name = "root";
  clamp.type = AttachmentType::clamp;
  cable.attachments.push_back(clamp);
  scene.cables.push_back(cable);
  return scene;
}

Obstacle ball(const std::string& name) {
  Obstacle obstacle;
  obstacle.name = name;
  obstacle.shape = SphereShape{0.1};
  obstacle.pose.position = Vector3(0, 0, 5);
  return obstacle;
}

class ObstaclesAtStart : public testing::Test {
 protected:
  ~ObstaclesAtStart() override { ros::Time::setNow(ros::Time(0)); }

  void update_at(double time) {
    ros::Time::setNow(ros::Time(time));
    simulation_.update(Simulation::longest_slice);
  }

  void set_ball(const std::string& name, const std::string& frame) {
    const EditResult result = simulation_.set_obstacle(ball(name), frame);
    ASSERT_TRUE(result.ok) << result.message;
  }

  SimulationReport::Phase phase() { return simulation_.take_report().phase; }

  /// The frames of the world's numbers are those that diagnostics read by these numbers.
  void expect_same_frames() {
    std::vector<std::string> followed;
    for (const FrameReport& frame : simulation_.frames().report()) followed.push_back(frame.name);
    EXPECT_EQ(simulation_.world().frames(), followed);
    for (const Obstacle& obstacle : simulation_.world().obstacles()) EXPECT_LT(obstacle.frame, static_cast<int>(followed.size()));
  }

  std::vector<std::string> frames_of_obstacles() {
    std::vector<std::string> frames;
    for (const Obstacle& obstacle : simulation_.world().obstacles())
      frames.push_back(obstacle.name + " in " + simulation_.world().frames()[obstacle.frame]);
    return frames;
  }

  ros::NodeHandle node_{"~"};
  Simulation simulation_{node_, slow_scene()};
};

TEST_F(ObstaclesAtStart, KeepTheirFramesWhileItIsBuilt) {
  const std::vector<std::string> all{"early in hand", "late in arm"};
  set_ball("early", "hand");
  update_at(100);  // waits for the frame of the obstacle, which tf does not have
  expect_same_frames();
  ASSERT_EQ(phase(), SimulationReport::Phase::awaits_first_frames);
  update_at(101);  // longer than it waits
  ASSERT_EQ(phase(), SimulationReport::Phase::building);
  expect_same_frames();
  set_ball("late", "arm");
  expect_same_frames();
  EXPECT_EQ(frames_of_obstacles(), all);
  update_at(101.1);
  ASSERT_EQ(phase(), SimulationReport::Phase::building);
  expect_same_frames();
  const ros::WallTime end = ros::WallTime::now() + patience;
  for (double time = 101.2; phase() == SimulationReport::Phase::building && ros::WallTime::now() < end; time += 0.01) {
    update_at(time);
    ros::WallDuration(0.01).sleep();
  }
  ASSERT_EQ(phase(), SimulationReport::Phase::running);
  expect_same_frames();
  EXPECT_EQ(frames_of_obstacles(), all);
}

TEST_F(ObstaclesAtStart, KeepTheirFramesWhenTimeJumpsBackMeanwhile) {
  set_ball("early", "hand");
  update_at(100);
  update_at(101);
  ASSERT_EQ(phase(), SimulationReport::Phase::building);
  update_at(50);  // another start, for which nothing has to be waited
  ASSERT_EQ(phase(), SimulationReport::Phase::building);
  expect_same_frames();
  set_ball("late", "arm");
  expect_same_frames();
  EXPECT_EQ(frames_of_obstacles(), (std::vector<std::string>{"early in hand", "late in arm"}));
}

}  // namespace
}  // namespace verlet_cable

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "obstacles_at_start_test");
  ros::NodeHandle keeps_ros_up;
  return RUN_ALL_TESTS();
}
