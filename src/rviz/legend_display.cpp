#include "legend_display.h"

#include <rviz/display_context.h>

#include <QApplication>
#include <pluginlib/class_list_macros.hpp>

#include "legend_picture.h"

namespace verlet_cable {

LegendDisplay::LegendDisplay()
    : topic_(new rviz::RosTopicProperty("Topic", "/cable/legend", QString::fromStdString(ros::message_traits::datatype<Legend>()),
                                        "Of the cable node", this, SLOT(followTopic()), this)) {}

void LegendDisplay::onInitialize() {
  static int displays = 0;
  picture_ = std::make_unique<ScreenPicture>("verlet_cable/legend/" + std::to_string(displays++));
}

void LegendDisplay::onEnable() {
  followTopic();
}

void LegendDisplay::onDisable() {
  subscriber_.shutdown();
  picture_->show({});
}

void LegendDisplay::reset() {
  Display::reset();
  followTopic();
}

void LegendDisplay::followTopic() {
  if (!picture_ || !isEnabled()) return;
  onDisable();
  if (topic_->getTopicStd().empty()) return;
  try {
    subscriber_ =
        update_nh_.subscribe<Legend>(topic_->getTopicStd(), 1, [this](const Legend::ConstPtr& legend) { receive(*legend); });
    setStatus(rviz::StatusProperty::Ok, "Topic", "OK");
  } catch (const ros::Exception& problem) {
    setStatus(rviz::StatusProperty::Error, "Topic", QString("Error subscribing: ") + problem.what());
  }
}

void LegendDisplay::receive(const Legend& legend) {
  picture_->show(legend_picture(legend, QApplication::font()));
  context_->queueRender();
}

}  // namespace verlet_cable

PLUGINLIB_EXPORT_CLASS(verlet_cable::LegendDisplay, rviz::Display)
