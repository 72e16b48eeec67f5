#pragma once

#include <ros/ros.h>

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "interact/handle_server.h"
#include "interact/handles.h"
#include "simulation/simulation.h"

namespace verlet_cable {

/// Topic `hands/update` (visualization_msgs/InteractiveMarkerUpdate), with `hands/update_full` and the subscribed topic
/// `hands/feedback`: interactive markers, the handles in rviz. Attachments can be dragged and rotated, nodes are held as long as
/// the mouse button is down, and menus pin, release, cut and reset. Poses that are not finite, out of bounds or in an unknown
/// frame are refused. Nothing is computed without subscribers.
class Hands {
 public:
  Hands(ros::NodeHandle& private_node, Simulation& simulation);

  /// Does what was asked for since the last call, and shows where things are now. To be called between steps.
  void update();

 private:
  struct Request {
    std::string handle;
    std::uint8_t type = 0;  ///< a constant of InteractiveMarkerFeedback
    std::uint32_t menu_entry = 0;
    std::string frame;
    geometry_msgs::Pose pose;
  };
  struct Grab {
    std::string attachment;  ///< that stands for the mouse
    ros::WallTime last;      ///< when the mouse was heard of
  };

  void receive(const visualization_msgs::InteractiveMarkerFeedback& feedback);
  std::deque<Request> take_requests();
  void apply(const Request& request);
  EditResult drag(const Handle& handle, const Request& request);
  EditResult drag_node(const Handle& handle, Pose place);
  EditResult select(const Handle& handle, std::uint32_t menu_entry);
  EditResult pin(const Handle& handle);
  EditResult cut(const Handle& handle);
  EditResult move(const std::string& attachment, Pose place);
  void let_go(const std::string& handle);
  void drop_lost_grabs();
  void show();
  std::set<std::string> grabbed_attachments() const;

  Simulation& simulation_;
  std::string node_;  // its private namespace
  std::deque<Request> requests_;
  std::map<std::string, Handle> shown_;  // by name
  std::map<std::string, Grab> grabs_;    // by the name of the handle
  std::optional<DrawingFrame> shown_frame_;
  ros::WallTime last_shown_;
  HandleServer server_;  // the last: it calls back until it is gone
};

}  // namespace verlet_cable
