#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rviz/display.h>
#include <rviz/panel.h>
#include <rviz/tool.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <QApplication>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTableWidget>
#include <functional>
#include <pluginlib/class_loader.hpp>
#include <stdexcept>

namespace {

const ros::WallDuration patience(10);
/// A window that does not answer for longer than this feels stuck.
const ros::WallDuration longest_turn(0.25);

/// The panel as rviz has it: Qt's events and ROS's messages in one thread.
class CablePanelTest : public testing::Test {
 protected:
  CablePanelTest() : loader_("rviz", "rviz::Panel"), panel_(loader_.createUniqueInstance("verlet_cable/CablePanel")) {
    panel_->initialize(nullptr);
  }

  void wait_for(const std::string& what, const std::function<bool()>& wanted) {
    const ros::WallTime deadline = ros::WallTime::now() + patience;
    while (!wanted()) {
      ASSERT_LT(ros::WallTime::now(), deadline) << what;
      const ros::WallTime begin = ros::WallTime::now();
      ros::spinOnce();
      QApplication::processEvents();
      EXPECT_LT(ros::WallTime::now() - begin, longest_turn) << what;
      ros::WallDuration(0.005).sleep();
    }
  }

  template <typename Widget>
  bool shows(const QString& text) const {
    for (const Widget* widget : panel_->findChildren<Widget*>())
      if (widget->text().contains(text)) return true;
    return false;
  }

  QPushButton& button(const QString& text) const {
    for (QPushButton* button : panel_->findChildren<QPushButton*>())
      if (button->text() == text) return *button;
    throw std::runtime_error("no button " + text.toStdString());
  }

  void click(const QString& text) { button(text).click(); }

  void write(const QString& before, const QString& after) {
    for (QLineEdit* edit : panel_->findChildren<QLineEdit*>()) {
      if (edit->text() != before) continue;
      edit->setText(after);
      Q_EMIT edit->editingFinished();
    }
  }

  QTableWidget& table() const { return *panel_->findChild<QTableWidget*>(); }

  pluginlib::ClassLoader<rviz::Panel> loader_;
  pluginlib::UniquePtr<rviz::Panel> panel_;
};

TEST(RvizPlugins, ToolsAreLoaded) {
  pluginlib::ClassLoader<rviz::Tool> loader("rviz", "rviz::Tool");
  for (const char* name : {"verlet_cable/CutTool", "verlet_cable/PinTool"}) {
    ASSERT_TRUE(loader.isClassAvailable(name)) << name;
    const auto tool = loader.createUniqueInstance(name);
    EXPECT_NE(tool->getPropertyContainer(), nullptr) << name;
  }
}

TEST(RvizPlugins, LegendIsLoaded) {
  pluginlib::ClassLoader<rviz::Display> loader("rviz", "rviz::Display");
  const auto display = loader.createUniqueInstance("verlet_cable/Legend");
  EXPECT_EQ(display->subProp("Topic")->getValue().toString(), "/cable/legend");
}

TEST_F(CablePanelTest, ShowsSpeedAndLoads) {
  wait_for("speed", [this] { return shows<QLabel>("real time"); });
  wait_for("force",
           [this] { return table().rowCount() == 2 && table().item(0, 2) && table().item(0, 2)->text().toDouble() > 0.01; });
}

TEST_F(CablePanelTest, ShowsWhatWaitsForWhichFrame) {
  const auto shows_row = [this](int row, const QString& attachment, const QString& force) {
    return table().item(row, 0) && table().item(row, 0)->text() == attachment && table().item(row, 2)->text() == force;
  };
  write("/cable", "/waiting");
  wait_for("waiting attachments", [&] {
    return table().rowCount() == 2 && shows_row(0, "left", "waits for left_gripper") &&
           shows_row(1, "right", "waits for right_gripper");
  });
  EXPECT_EQ(table().item(0, 1)->text(), "hose");

  tf2_ros::StaticTransformBroadcaster broadcaster;
  std::vector<geometry_msgs::TransformStamped> transforms(2);
  for (int i = 0; i < 2; ++i) {
    transforms[i].header.frame_id = "world";
    transforms[i].header.stamp = ros::Time::now();
    transforms[i].child_frame_id = i == 0 ? "left_gripper" : "right_gripper";
    transforms[i].transform.translation.x = i == 0 ? -0.4 : 0.4;
    transforms[i].transform.rotation.w = 1;
  }
  broadcaster.sendTransform(transforms);
  wait_for("forces", [this] {
    if (table().rowCount() != 2) return false;
    for (int row = 0; row < 2; ++row)
      if (table().item(row, 2)->text().toDouble() < 0.01) return false;
    return true;
  });
}

TEST_F(CablePanelTest, PausesStepsAndResets) {
  wait_for("speed", [this] { return shows<QLabel>("real time"); });
  click("Pause");
  wait_for("that the node stands", [this] { return shows<QLabel>("paused") && button("Step").isEnabled(); });
  click("Step");
  wait_for("steps", [this] { return shows<QLabel>("10 steps done"); });
  click("Reset");
  wait_for("reset", [this] { return shows<QLabel>("reset to the initial state"); });
  click("Resume");
  wait_for("that the node runs", [this] { return shows<QLabel>("real time"); });
}

TEST_F(CablePanelTest, SavesAndRestores) {
  wait_for("speed", [this] { return shows<QLabel>("real time"); });
  click("Save");
  wait_for("snapshot", [this] { return shows<QLabel>("saved as \"first\""); });
  click("Restore");
  wait_for("restored snapshot", [this] { return shows<QLabel>("restored the snapshot \"first\""); });
  write("first", "another");
  click("Restore");
  wait_for("refusal", [this] { return shows<QLabel>("name: \"another\"; allowed: first"); });
}

TEST_F(CablePanelTest, SurvivesANodeThatIsNotThere) {
  wait_for("speed", [this] { return shows<QLabel>("real time"); });
  write("/cable", "/nobody");
  wait_for("silence", [this] { return shows<QLabel>("no messages from this node") && table().rowCount() == 0; });
  click("Reset");
  wait_for("that nobody answers", [this] { return shows<QLabel>("no answer from /nobody/reset"); });
  write("/nobody", "not a name!");
  click("Reset");
  wait_for("that it is no name", [this] { return shows<QLabel>("no answer from not a name!/reset"); });
  write("not a name!", "/cable");
  wait_for("speed", [this] { return shows<QLabel>("real time"); });
}

TEST_F(CablePanelTest, ClosesWhileANodeIsStuck) {
  ros::NodeHandle stuck("/stuck");
  ros::CallbackQueue nobody_serves_it;
  stuck.setCallbackQueue(&nobody_serves_it);
  const boost::function<bool(std_srvs::Trigger::Request&, std_srvs::Trigger::Response&)> reset = [](auto&, auto&) {
    return true;
  };
  const ros::ServiceServer server = stuck.advertiseService("reset", reset);
  write("/cable", "/stuck");
  click("Reset");
  wait_for("request", [&] { return !nobody_serves_it.isEmpty(); });
  const ros::WallTime begin = ros::WallTime::now();
  panel_.reset();
  EXPECT_LT(ros::WallTime::now() - begin, ros::WallDuration(1));
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "rviz_plugins_test");
  const ros::NodeHandle node;
  const QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
