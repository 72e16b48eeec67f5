// What the topics say about a world, with a ROS master: contents, stamps, frames, and what comes and goes.
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <verlet_cable/CableArray.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <string>

#include "publish/color.h"
#include "publish/publishers.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

const ros::Time stamp(12, 340000000);
const ros::WallDuration patience(5.0);  // far more than a message on one machine takes

/// A rope of 1 m and 0.2 kg that hangs straight down, at rest, from a hinge 0.3 m beside the hand's origin, with 0.5 kg at its
/// end; and a cord between two clamps.
SceneDesc two_cables() {
  SceneDesc scene;
  scene.frame_id = "base";
  scene.materials.resize(1);
  scene.materials[0].name = "rope";
  scene.materials[0].material.linear_density = 0.2;
  scene.materials[0].material.radius = 0.01;

  CableDesc rope;
  rope.name = "rope";
  rope.length = 1;
  rope.segments = 10;
  rope.material = "rope";
  AttachmentDesc hook;
  hook.name = "hook";
  hook.frame = "hand";
  hook.offset = Vector3(0.3, 0, 0);
  // x up, so that gravity is along the hand's -x
  hook.initial_pose = InitialPose{1, 2, 3, 0, -M_PI_2, 0};
  rope.attachments.push_back(hook);
  rope.point_masses.push_back({{PlaceDesc::At::end, 0}, 0.5});
  scene.cables.push_back(rope);

  CableDesc cord = rope;
  cord.name = "cord";
  cord.point_masses.clear();
  cord.attachments.clear();
  for (const bool end : {false, true}) {
    AttachmentDesc clamp;
    clamp.name = end ? "right" : "left";
    clamp.place.at = end ? PlaceDesc::At::end : PlaceDesc::At::start;
    clamp.offset = Vector3(end ? 0.8 : 0, 0, 1);
    clamp.type = AttachmentType::clamp;
    cord.attachments.push_back(clamp);
  }
  scene.cables.push_back(cord);
  return scene;
}

/// The last message of a topic.
template <typename Message>
class Listener {
 public:
  Listener(ros::NodeHandle& node, const std::string& topic)
      : subscriber_(
            node.subscribe<Message>(topic, 10, [this](const boost::shared_ptr<const Message>& message) { last = message; })) {}
  bool connected() const { return subscriber_.getNumPublishers() > 0; }

  boost::shared_ptr<const Message> last;

 private:
  ros::Subscriber subscriber_;
};

class Topics : public testing::Test {
 protected:
  Topics()
      : node_("~"), scene_(two_cables()), inputs_(initial_frames(scene_)), world_(scene_, inputs_), publishers_(node_, scene_) {
    world_.step(inputs_);
  }

  /// Publishes until the listener has something new.
  template <typename Message>
  const Message& next(Listener<Message>& listener) {
    listener.last.reset();
    const ros::WallTime end = ros::WallTime::now() + patience;
    while (!listener.last && ros::WallTime::now() < end) {
      publishers_.publish(world_, stamp);
      ros::spinOnce();
      ros::WallDuration(0.002).sleep();
    }
    if (!listener.last) throw std::runtime_error("no message came");
    return *listener.last;
  }

  ros::NodeHandle node_;
  SceneDesc scene_;
  BoundaryInputs inputs_;
  World world_;
  Publishers publishers_;
};

const Marker* find(const MarkerArray& markers, const std::string& ns, int type) {
  const auto wanted = [&](const Marker& marker) {
    return marker.ns == ns && marker.type == type && marker.action == Marker::ADD;
  };
  const auto found = std::find_if(markers.markers.begin(), markers.markers.end(), wanted);
  return found == markers.markers.end() ? nullptr : &*found;
}

std::set<std::pair<std::string, int>> keys(const MarkerArray& markers, int action) {
  std::set<std::pair<std::string, int>> found;
  for (const Marker& marker : markers.markers) {
    if (marker.action == action) found.emplace(marker.ns, marker.id);
  }
  return found;
}

TEST_F(Topics, MarkersShowCablesPinsAndPayloads) {
  Listener<MarkerArray> listener(node_, "markers");
  const MarkerArray& markers = next(listener);
  EXPECT_EQ(markers.markers.size(), 6u);
  EXPECT_EQ(keys(markers, Marker::ADD).size(), markers.markers.size()) << "a namespace and id occurs twice";
  for (const Marker& marker : markers.markers) {
    EXPECT_EQ(marker.header.stamp, stamp);
    EXPECT_EQ(marker.header.frame_id, "base");
    EXPECT_EQ(marker.lifetime, ros::Duration(0));
    EXPECT_FALSE(marker.frame_locked);
  }
  const Marker* rope = find(markers, "rope", Marker::TRIANGLE_LIST);
  ASSERT_TRUE(rope);
  EXPECT_EQ(rope->points.size() % 3, 0u);
  EXPECT_EQ(rope->points.size(), rope->colors.size());
  ASSERT_TRUE(find(markers, "cord", Marker::TRIANGLE_LIST));

  const Marker* hinge = find(markers, "pins", Marker::SPHERE);
  ASSERT_TRUE(hinge);
  EXPECT_NEAR(hinge->pose.position.x, 1, 1e-12);  // the hand's x points up
  EXPECT_NEAR(hinge->pose.position.z, 3.3, 1e-12);
  EXPECT_TRUE(find(markers, "pins", Marker::CUBE));

  const Marker* payload = find(markers, "payloads", Marker::SPHERE);
  ASSERT_TRUE(payload);
  EXPECT_NEAR(payload->pose.position.z, world_.cables()[0].state.positions.back().z(), 1e-12);
  // the ball of 0.5 kg of aluminium: (6 m / (pi 2700))^(1/3)
  EXPECT_NEAR(payload->scale.x, 0.07072, 1e-5);
}

TEST_F(Topics, IdsOfWhatIsGoneAreGivenAgain) {
  Listener<MarkerArray> listener(node_, "markers");
  for (int i = 0; i < 10; ++i) {
    Obstacle ball;
    ball.name = "ball/" + std::to_string(i);
    ball.shape = SphereShape{0.1};
    ball.pose.position.x() = i;
    ASSERT_TRUE(world_.apply(edit::SetObstacle{ball}).ok);
    const Marker* shown = nullptr;
    while (!shown || shown->pose.position.x != i) shown = find(next(listener), "obstacles", Marker::SPHERE);
    // Those of three pins and a payload, and of the ball before this one, which may be gone only now.
    EXPECT_LE(shown->id, 6);
    world_.apply(edit::RemoveObstacle{ball.name});
  }
}

TEST_F(Topics, MarkersAsLines) {
  scene_.marker_style = MarkerStyle::line;
  Publishers lines(node_, scene_);
  Listener<MarkerArray> listener(node_, "markers");
  const ros::WallTime end = ros::WallTime::now() + patience;
  while (!listener.last && ros::WallTime::now() < end) {
    lines.publish(world_, stamp);
    ros::spinOnce();
  }
  ASSERT_TRUE(listener.last);
  const Marker* rope = find(*listener.last, "rope", Marker::LINE_STRIP);
  ASSERT_TRUE(rope);
  EXPECT_EQ(rope->points.size(), 11u);
  EXPECT_DOUBLE_EQ(rope->scale.x, 0.02);
}

TEST_F(Topics, TrianglesOfANetArePublishedOnceAndLitFromBothSides) {
  NetDesc net;
  net.name = "flag";
  net.grid = GridDesc{};
  net.grid->rows = 3;
  net.grid->columns = 4;
  net.grid->spacing = 0.1;
  net.mass = 0.1;
  net.color = {0.8, 0.4, 0.2, 0.5};
  scene_.nets.push_back(net);
  world_ = World(scene_, inputs_);
  Listener<MarkerArray> listener(node_, "markers");
  const Marker* triangles = find(next(listener), "flag", Marker::TRIANGLE_LIST);
  ASSERT_TRUE(triangles);
  EXPECT_EQ(triangles->points.size(), 6 * 2 * 3u);
  ASSERT_EQ(triangles->colors.size(), triangles->points.size());
  for (const std_msgs::ColorRGBA& color : triangles->colors) {
    EXPECT_GE(color.r, 0.3f * 0.8f);
    EXPECT_LE(color.r, 0.8f);
    EXPECT_FLOAT_EQ(color.g, color.r / 2);
    EXPECT_FLOAT_EQ(color.b, color.r / 4);
    EXPECT_FLOAT_EQ(color.a, 0.5f);
  }
}

TEST_F(Topics, CablesThatTakeTooManyTrianglesAreLinesAndTubesAgain) {
  CableDesc cable = scene_.cables[0];
  cable.point_masses.clear();
  cable.attachments.clear();
  cable.segments = 2;
  SceneDesc many = scene_;
  for (int i = 0; i < 200; ++i) {
    cable.name = "cable" + std::to_string(i);
    many.cables.push_back(cable);
  }
  Listener<MarkerArray> listener(node_, "markers");
  EXPECT_TRUE(find(next(listener), "rope", Marker::TRIANGLE_LIST));
  world_ = World(many, inputs_);
  const MarkerArray& lines = next(listener);
  EXPECT_FALSE(find(lines, "rope", Marker::TRIANGLE_LIST));
  const Marker* rope = find(lines, "rope", Marker::LINE_STRIP);
  ASSERT_TRUE(rope);
  EXPECT_EQ(rope->id, 0);
  EXPECT_DOUBLE_EQ(rope->scale.x, 0.02);
  world_ = World(scene_, inputs_);
  EXPECT_TRUE(find(next(listener), "rope", Marker::TRIANGLE_LIST));
}

TEST_F(Topics, MarkersOfWhatIsGoneAreDeletedOnceAndIdsStay) {
  Listener<MarkerArray> listener(node_, "markers");
  const auto before = keys(next(listener), Marker::ADD);
  ASSERT_TRUE(world_.apply(edit::Unpin{"left"}).ok);
  const EditResult cut = world_.apply(edit::Cut{cable_id(find(world_.cables(), "cord")), 4});
  ASSERT_TRUE(cut.ok);

  const MarkerArray& after_cut = next(listener);
  const auto showing = keys(after_cut, Marker::ADD);
  EXPECT_TRUE(find(after_cut, cut.name, Marker::TRIANGLE_LIST));
  for (const auto& key : keys(after_cut, Marker::DELETE)) EXPECT_EQ(key.first, "pins");
  EXPECT_EQ(keys(after_cut, Marker::DELETE).size(), 1u);
  EXPECT_TRUE(keys(next(listener), Marker::DELETE).empty());
  int stayed = 0;
  for (const auto& key : before) stayed += static_cast<int>(showing.count(key));
  EXPECT_EQ(stayed, 5) << "all but the pin";

  world_ = World(scene_, inputs_);
  const auto gone = keys(next(listener), Marker::DELETE);
  EXPECT_EQ(gone, (std::set<std::pair<std::string, int>>{{cut.name, 0}}));
  EXPECT_EQ(keys(*listener.last, Marker::ADD), before);
}

TEST_F(Topics, LegendIsThatOfTheScene) {
  const auto wait_for = [](Listener<Legend>& listener, const std::string& quantity) {
    const ros::WallTime end = ros::WallTime::now() + patience;
    while ((!listener.last || listener.last->quantity != quantity) && ros::WallTime::now() < end) {
      ros::spinOnce();
      ros::WallDuration(0.002).sleep();
    }
    ASSERT_TRUE(listener.last);
    EXPECT_EQ(listener.last->quantity, quantity);
  };
  Listener<Legend> early(node_, "legend");
  wait_for(early, "tension");
  EXPECT_EQ(early.last->values.back(), ColorScale(scene_).full_tension());
  scene_.color_by = ColorBy::strain;
  publishers_.show(scene_);
  wait_for(early, "strain");
  Listener<Legend> late(node_, "legend");
  wait_for(late, "strain");
}

TEST_F(Topics, PointsAreTheNodesInOrder) {
  Listener<sensor_msgs::PointCloud2> listener(node_, "points");
  const sensor_msgs::PointCloud2& cloud = next(listener);
  EXPECT_EQ(cloud.header.stamp, stamp);
  EXPECT_EQ(cloud.header.frame_id, "base");
  EXPECT_EQ(cloud.height, 1u);
  ASSERT_EQ(cloud.width, 22u);
  const ColorScale colors(scene_);
  EXPECT_EQ(cloud.data.size(), cloud.row_step);
  sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x"), y(cloud, "y"), z(cloud, "z"), tension(cloud, "tension"),
      s(cloud, "s"), rgb(cloud, "rgb");
  sensor_msgs::PointCloud2ConstIterator<std::uint32_t> cable_id(cloud, "cable_id"), node_id(cloud, "node_id");
  for (int point = 0; point < 22; ++point, ++x, ++y, ++z, ++tension, ++s, ++rgb, ++cable_id, ++node_id) {
    const int id = point / 11, node = point % 11;
    const CableState& state = world_.cables()[id].state;
    EXPECT_EQ(*cable_id, static_cast<std::uint32_t>(id));
    EXPECT_EQ(*node_id, static_cast<std::uint32_t>(node));
    EXPECT_FLOAT_EQ(*x, static_cast<float>(state.positions[node].x()));
    EXPECT_FLOAT_EQ(*y, static_cast<float>(state.positions[node].y()));
    EXPECT_FLOAT_EQ(*z, static_cast<float>(state.positions[node].z()));
    EXPECT_FLOAT_EQ(*tension, static_cast<float>(state.tension[std::min(node, 9)]));
    EXPECT_FLOAT_EQ(*s, 0.1f * node);
    const float expected_rgb = packed_rgb(colors.node_colors(world_.cables()[id], {})[node]);
    EXPECT_EQ(std::memcmp(&*rgb, &expected_rgb, sizeof(float)), 0);
  }
}

TEST_F(Topics, SurfaceIsOnTheCables) {
  Listener<sensor_msgs::PointCloud2> listener(node_, "surface");
  const sensor_msgs::PointCloud2& cloud = next(listener);
  EXPECT_EQ(cloud.header.stamp, stamp);
  // Two cables of 1 m, with rings of 12 points that are as far apart as these.
  EXPECT_EQ(cloud.width, 2 * 12 * static_cast<unsigned>(1 / (2 * M_PI * 0.01 / 12)));
  sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x");
  sensor_msgs::PointCloud2ConstIterator<std::uint32_t> cable_id(cloud, "cable_id");
  float lowest = 10, highest = 0;
  for (unsigned point = 0; point < cloud.width / 2; ++point, ++x, ++cable_id) {
    // The rope, which hangs from (1, 2, 3.3)
    EXPECT_EQ(*cable_id, 0u);
    EXPECT_NEAR(std::hypot(x[0] - 1, x[1] - 2), 0.01, 1e-5);
    lowest = std::min(lowest, x[2]);
    highest = std::max(highest, x[2]);
  }
  EXPECT_NEAR(highest, 3.3, 0.003);
  EXPECT_NEAR(lowest, 2.3, 0.003);
}

TEST_F(Topics, SurfaceOfManyCablesStaysLight) {
  CableDesc cable = scene_.cables[1];
  cable.segments = 50;
  cable.attachments.clear();
  scene_.cables.clear();
  for (int i = 0; i < 120; ++i) {
    cable.name = "cable" + std::to_string(i);
    scene_.cables.push_back(cable);
  }
  world_ = World(scene_, initial_frames(scene_));
  Listener<sensor_msgs::PointCloud2> listener(node_, "surface");
  const sensor_msgs::PointCloud2& cloud = next(listener);
  EXPECT_LE(cloud.width, 100000u);
  EXPECT_GT(cloud.width, 98000u);
}

TEST_F(Topics, StateIsEverythingInDoublePrecision) {
  Listener<CableArray> listener(node_, "state");
  const CableArray& state = next(listener);
  EXPECT_EQ(state.header.stamp, stamp);
  EXPECT_EQ(state.header.frame_id, "base");
  ASSERT_EQ(state.cables.size(), 2u);
  for (int id = 0; id < 2; ++id) {
    const Cable& message = state.cables[id];
    const SimulatedCable& cable = world_.cables()[id];
    EXPECT_EQ(message.name, cable.model->name);
    ASSERT_EQ(message.positions.size(), 11u);
    ASSERT_EQ(message.velocities.size(), 11u);
    for (int node = 0; node < 11; ++node) {
      EXPECT_EQ(message.positions[node].z, cable.state.positions[node].z());
      EXPECT_EQ(message.velocities[node].x, cable.state.velocities[node].x());
    }
    EXPECT_EQ(message.tension, cable.state.tension);
    EXPECT_EQ(message.orientations.size(), 10u);
    EXPECT_EQ(message.curvature.size(), 9u);
    EXPECT_EQ(message.twist.size(), 9u);
    EXPECT_EQ(message.arc_length, cable.state.arc_length());
    EXPECT_DOUBLE_EQ(message.rest_length, 1.0);
    EXPECT_DOUBLE_EQ(message.radius, 0.01);
  }
  EXPECT_EQ(state.cables[0].attachments, (std::vector<std::string>{"hook"}));
  EXPECT_EQ(state.cables[1].attachments, (std::vector<std::string>{"left", "right"}));
  EXPECT_EQ(state.cables[1].attachment_nodes, (std::vector<std::uint32_t>{0, 10}));
}

TEST_F(Topics, WrenchOfAHangingRopeIsItsWeight) {
  Listener<geometry_msgs::WrenchStamped> listener(node_, "wrench/hook");
  const geometry_msgs::WrenchStamped& wrench = next(listener);
  EXPECT_EQ(wrench.header.stamp, stamp);
  EXPECT_EQ(wrench.header.frame_id, "hand");
  // 0.2 kg of rope and 0.5 kg at its end, at rest, along the hand's -x; it acts on the x axis, so there is no torque.
  // 1e-6: the step's solution is iterated to about 1e-9 of the lengths.
  EXPECT_NEAR(wrench.wrench.force.x, -0.7 * 9.81, 1e-6);
  EXPECT_NEAR(wrench.wrench.force.y, 0, 1e-6);
  EXPECT_NEAR(wrench.wrench.force.z, 0, 1e-6);
  EXPECT_NEAR(wrench.wrench.torque.x, 0, 1e-6);
  EXPECT_NEAR(wrench.wrench.torque.y, 0, 1e-6);
  EXPECT_NEAR(wrench.wrench.torque.z, 0, 1e-6);
}

TEST_F(Topics, WrenchesComeAndGoWithTheAttachments) {
  Listener<geometry_msgs::WrenchStamped> pinned(node_, "wrench/extra");
  publishers_.publish(world_, stamp);
  EXPECT_FALSE(pinned.connected());
  const Pose where{world_.cables()[0].state.positions[5], Quaternion::Identity()};
  ASSERT_TRUE(world_.apply(edit::Pin{"extra", cable_id(0), 5, 0, where, AttachmentType::hinge}).ok);
  world_.step(inputs_);
  EXPECT_EQ(next(pinned).header.frame_id, "base");
  ASSERT_TRUE(world_.apply(edit::Unpin{"extra"}).ok);
  const ros::WallTime end = ros::WallTime::now() + patience;
  while (pinned.connected() && ros::WallTime::now() < end) {
    publishers_.publish(world_, stamp);
    ros::spinOnce();
    ros::WallDuration(0.002).sleep();
  }
  EXPECT_FALSE(pinned.connected());
}

TEST_F(Topics, ALateSubscriberLacksNothing) {
  Listener<MarkerArray> early(node_, "markers");
  const auto first = keys(next(early), Marker::ADD);
  ros::NodeHandle other(node_);
  Listener<MarkerArray> late(other, "markers");
  EXPECT_EQ(keys(next(late), Marker::ADD), first);
}

}  // namespace
}  // namespace verlet_cable

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "display_topics_test");
  ros::NodeHandle keeps_ros_up;
  return RUN_ALL_TESTS();
}
