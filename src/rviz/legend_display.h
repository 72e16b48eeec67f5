#pragma once

#include <ros/ros.h>
#include <rviz/display.h>
#include <rviz/properties/ros_topic_property.h>
#include <verlet_cable/Legend.h>

#include <memory>

#include "screen_picture.h"

namespace verlet_cable {

/// What the colors of the cables mean, in the corner of the window.
class LegendDisplay : public rviz::Display {
  Q_OBJECT
 public:
  LegendDisplay();

  void reset() override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private Q_SLOTS:
  void followTopic();

 private:
  void receive(const Legend& legend);

  rviz::RosTopicProperty* topic_;
  ros::Subscriber subscriber_;
  std::unique_ptr<ScreenPicture> picture_;
};

}  // namespace verlet_cable
