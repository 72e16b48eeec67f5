#pragma once

#include <ros/ros.h>
#include <rviz/properties/string_property.h>
#include <rviz/tool.h>
#include <verlet_cable/CableArray.h>
#include <verlet_cable/CableLocation.h>

#include <string>

#include "service_caller.h"

namespace verlet_cable {

/// What the tools have in common: a click on a cable becomes a request to the node. Other mouse buttons move the view.
class ClickTool : public rviz::Tool {
  Q_OBJECT
 public:
  void onInitialize() override;
  void activate() override;
  void deactivate() override;
  int processMouseEvent(rviz::ViewportMouseEvent& event) override;

 protected:
  /// `what` it does, for the status line.
  ClickTool(char shortcut, const std::string& what);

  std::string nameOf(const std::string& service) const { return node_->getStdString() + "/" + service; }
  /// Calls a service, and shows what it answered.
  template <typename Service>
  void call(const std::string& service, const typename Service::Request& request) {
    services_.call<Service>(nameOf(service), request, [this](const ServiceAnswer& answer) { tell(answer); });
  }
  void tell(const ServiceAnswer& answer);

 private Q_SLOTS:
  void followNode();

 private:
  virtual void clicked(const CableLocation& location) = 0;
  void click(rviz::ViewportMouseEvent& event);
  bool isOnCable(const geometry_msgs::Point& point) const;

  std::string what_;
  rviz::StringProperty* node_;
  bool active_ = false;
  ros::Subscriber state_;
  CableArray::ConstPtr cables_;  // as they are now
  ServiceCaller services_;
};

}  // namespace verlet_cable
