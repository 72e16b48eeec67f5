#pragma once

#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "publish/color.h"
#include "publish/drawing_frame.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topic `markers` (visualization_msgs/MarkerArray): the display in rviz. Every message is complete, so that late subscribers see
/// everything; markers that are no longer needed are deleted once.
///  * namespace = name of a cable, id 0: the cable, a tube or a line (cable_markers.h);
///  * namespace = name of a net, id 0: its links, as lines; id 1, for a grid with marker_style tube: its triangles, lit from both
///  sides;
///  * namespace = name of a particle, id 0: a sphere;
///  * namespace "pins", ids from 1: the attachments of cables, nets and bodies: hinges are spheres, clamps are boxes that are
///  longest along the cable's +x axis, axles are cylinders;
///  * namespace "guides", ids from 1: the guides that cables slide through (guide_markers.h);
///  * namespace "obstacles", ids from 1: the present obstacles; a capsule is three markers;
///  * namespace "bodies", ids from 1: the shapes of bodies, in the same way;
///  * namespace "payloads", ids from 1: point masses, as balls with the density of aluminium;
///  * namespace "loads", ids from 1: arrows along forces and torques from outside;
///  * namespace "waiting", id 0: while something has not started, a text that says which frames of tf it waits for.
class MarkerPublisher {
 public:
  MarkerPublisher(ros::NodeHandle& private_node, const SceneDesc& scene, const DrawingFrame& frame);
  void show(const SceneDesc& scene, const DrawingFrame& frame);  ///< from now on
  void publish(const World& world, const ColorScale& colors, const ros::Time& stamp);

 private:
  using Key = std::pair<std::string, int>;  // namespace and id

  visualization_msgs::Marker make_marker(const std::string& ns, int id, int type) const;
  void add_cables(const World& world, const ColorScale& colors, visualization_msgs::MarkerArray& markers);
  void add_payloads(const SimulatedCable& cable, visualization_msgs::MarkerArray& markers);
  void add_net(const SimulatedNet& net, visualization_msgs::MarkerArray& markers) const;
  void add_particle(const SimulatedParticle& particle, visualization_msgs::MarkerArray& markers) const;
  void add_pin(const World& world, const Attachment& attachment, visualization_msgs::MarkerArray& markers);
  void add_guide(const World& world, int guide, visualization_msgs::MarkerArray& markers);
  void add_loads(const World& world, visualization_msgs::MarkerArray& markers);
  void add_obstacle(const World& world, const Obstacle& obstacle, visualization_msgs::MarkerArray& markers);
  void add_body(const SimulatedBody& body, visualization_msgs::MarkerArray& markers);
  void add_waiting(const World& world, visualization_msgs::MarkerArray& markers) const;
  void add_shape(const std::string& ns, const std::string& name, int& part, const Shape& shape, const Pose& pose,
                 visualization_msgs::MarkerArray& markers);
  void add_look(const std::string& ns, const std::string& name, int& part, visualization_msgs::Marker look,
                visualization_msgs::MarkerArray& markers);
  void delete_what_is_gone(visualization_msgs::MarkerArray& markers);
  int id_of(const std::string& name);
  int free_id();
  void free_ids_of_what_is_gone();

  ros::Publisher publisher_;
  DrawingFrame frame_;
  MarkerStyle style_;
  std::map<std::string, std::vector<std::string>> holders_;  // frames, by the name of what they hold
  double text_height_ = 0;                                   // [m]
  std::map<std::string, int> ids_;          // of pins, payloads, guides, obstacles and bodies, by name, of this tick
  std::map<std::string, int> earlier_ids_;  // of the last tick: what is still there keeps its id
  std::set<int> free_ids_;                  // of what is gone: obstacles may come with another name each time
  std::set<Key> shown_;                     // at the last tick with subscribers
};

}  // namespace verlet_cable
