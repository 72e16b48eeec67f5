#pragma once

#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <memory>
#include <set>
#include <string>

#include "requests/mesh_loader.h"
#include "simulation/simulation.h"

namespace verlet_cable {

/// Subscribed topic `obstacles` (visualization_msgs/MarkerArray): a perception node adds, moves and removes obstacles by markers
/// of the types CUBE, SPHERE, CYLINDER and MESH_RESOURCE, with the actions ADD, DELETE and DELETEALL. Namespace and id identify
/// an obstacle, and its frame_id moves it; it stays until it is deleted, whatever its lifetime. Markers are applied between steps,
/// as all callbacks run in one thread. A refused marker is logged, counted, and changes nothing. An obstacle with a mesh appears
/// when the mesh has been read, unless a later marker has replaced or deleted it.
class ObstacleListener {
 public:
  ObstacleListener(ros::NodeHandle& private_node, Simulation& simulation);

  int refused_count() const { return refused_count_; }               ///< markers, and messages of too many, since the start
  const std::string& last_problem() const { return last_problem_; }  ///< why the last of them was refused

 private:
  struct Failure {
    ros::WallTime time;
    std::string problem;
  };
  struct Pending {
    Obstacle obstacle;
    std::string frame;
    MeshRequest mesh;
  };

  void receive(const visualization_msgs::MarkerArray& markers);
  void refuse_marker(const std::string& name, const std::string& problem);
  void refuse(const std::string& problem);
  /// Why the marker was refused, empty if it was not. Adds to `gone` what it deletes.
  std::string apply(const visualization_msgs::Marker& marker, std::set<std::string>& gone);
  std::string add(const visualization_msgs::Marker& marker, std::set<std::string>& gone);
  std::string wait_for_mesh(const Pending& wanted);
  void receive_mesh(const LoadedMesh& loaded);
  std::string place(const Obstacle& obstacle, const std::string& frame);
  void drop_pending(const std::string& name);

  Simulation& simulation_;
  std::map<std::string, Failure> failures_;  ///< of meshes that could not be read, by their URIs
  std::map<MeshRequest, std::weak_ptr<const TriangleMesh>>
      meshes_;                              ///< that were read; those that obstacles have are not read again
  std::map<std::string, Pending> pending_;  ///< obstacles that wait for their meshes, by their names
  int refused_count_ = 0;
  std::string last_problem_;
  MeshLoader loader_;
  ros::Subscriber subscriber_;
};

}  // namespace verlet_cable
