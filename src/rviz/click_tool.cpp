#include "click_tool.h"

#include <OgreQuaternion.h>
#include <OgreVector3.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/render_panel.h>
#include <rviz/selection/selection_manager.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/viewport_mouse_event.h>

#include <algorithm>

namespace verlet_cable {
namespace {

/// What was clicked at belongs to a cable if it is no further from its middle [radii], or [m].
constexpr float click_radii = 3;
constexpr float click_distance = 0.02f;

Ogre::Vector3 to_ogre(const geometry_msgs::Point& point) {
  return {static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z)};
}

float distance_to_segment(const Ogre::Vector3& point, const Ogre::Vector3& from, const Ogre::Vector3& to) {
  const Ogre::Vector3 along = to - from;
  const float length = along.squaredLength();
  const float part = length > 0 ? std::clamp((point - from).dotProduct(along) / length, 0.0f, 1.0f) : 0.0f;
  return point.distance(from + part * along);
}

}  // namespace

ClickTool::ClickTool(char shortcut, const std::string& what)
    : what_(what),
      node_(new rviz::StringProperty("Node", "/cable", "Namespace of the cable node", getPropertyContainer(), SLOT(followNode()),
                                     this)) {
  shortcut_key_ = shortcut;
}

void ClickTool::onInitialize() {
  setCursor(QCursor(Qt::CrossCursor));
}

void ClickTool::activate() {
  active_ = true;
  followNode();
  setStatus(QString::fromStdString("Click on a cable: " + what_ + ". Right and middle button: move the view."));
}

void ClickTool::deactivate() {
  active_ = false;
  followNode();
}

/// Its cables are needed only while the tool is in use.
void ClickTool::followNode() {
  state_.shutdown();
  cables_.reset();
  std::string problem;
  if (!active_ || node_->getStdString().empty() || !ros::names::validate(node_->getStdString(), problem)) return;
  state_ =
      ros::NodeHandle().subscribe<CableArray>(nameOf("state"), 1, [this](const CableArray::ConstPtr& state) { cables_ = state; });
}

int ClickTool::processMouseEvent(rviz::ViewportMouseEvent& event) {
  if (event.leftDown()) {
    click(event);
    return Render;
  }
  // Where the mouse only passes, the view would write its own help over the last answer.
  const bool moves_view = event.middle() || event.right() || event.wheel_delta != 0;
  if (moves_view && !event.left() && event.panel->getViewController()) event.panel->getViewController()->handleMouseEvent(event);
  return 0;
}

void ClickTool::click(rviz::ViewportMouseEvent& event) {
  Ogre::Vector3 picked;
  if (!context_->getSelectionManager()->get3DPoint(event.viewport, event.x, event.y, picked)) {
    tell({false, "nothing was hit; click on a cable"});
    return;
  }
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (!cables_ || !context_->getFrameManager()->getTransform(cables_->header.frame_id, ros::Time(), position, orientation)) {
    tell({false, "no messages from " + node_->getStdString() + "; see Node in the tool's properties"});
    return;
  }
  const Ogre::Vector3 point = orientation.Inverse() * (picked - position);
  CableLocation location;
  location.mode = CableLocation::NEAREST;
  location.point.header.frame_id = cables_->header.frame_id;
  location.point.point.x = point.x;
  location.point.point.y = point.y;
  location.point.point.z = point.z;
  if (isOnCable(location.point.point)) {
    clicked(location);
  } else {
    tell({false, "that is not a cable; click on a cable"});
  }
}

bool ClickTool::isOnCable(const geometry_msgs::Point& point) const {
  const Ogre::Vector3 place = to_ogre(point);
  for (const Cable& cable : cables_->cables) {
    const float longest = std::max(click_radii * static_cast<float>(cable.radius), click_distance);
    for (std::size_t i = 1; i < cable.positions.size(); ++i)
      if (distance_to_segment(place, to_ogre(cable.positions[i - 1]), to_ogre(cable.positions[i])) <= longest) return true;
  }
  return false;
}

void ClickTool::tell(const ServiceAnswer& answer) {
  setStatus(QString::fromStdString(answer.message));
  if (!answer.success) ROS_WARN("%s", answer.message.c_str());
}

}  // namespace verlet_cable
