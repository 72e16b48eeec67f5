#include "verlet_cable/ros/obstacle_listener.h"

#include <set>

#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/ros/obstacle_markers.h"
#include "verlet_cable/scene/mesh_file.h"

namespace verlet_cable {
namespace {

using visualization_msgs::Marker;

constexpr int queue_size = 10;
constexpr double log_period = 5;  // [s] between warnings about what may last
/// What could not be read is not tried again for so long: it is asked for with each message.
const ros::WallDuration failure_memory(5.0);
constexpr std::size_t most_failures = 100;
constexpr std::size_t most_triangles = 2'000'000;  // of all obstacles of the topic

std::size_t triangles_of(const Obstacle& obstacle) {
  const MeshShape* shape = std::get_if<MeshShape>(&obstacle.shape);
  return shape ? shape->mesh->triangles().size() : 0;
}

}  // namespace

ObstacleListener::ObstacleListener(ros::NodeHandle& private_node, Simulation& simulation)
    : simulation_(simulation),
      subscriber_(private_node.subscribe<visualization_msgs::MarkerArray>(
          "obstacles", queue_size, [this](const visualization_msgs::MarkerArrayConstPtr& markers) { receive(*markers); })) {}

void ObstacleListener::receive(const visualization_msgs::MarkerArray& markers) {
  // What a message deletes and adds again is moved: what lies on it goes on lying.
  std::set<std::string> gone;
  for (const Marker& marker : markers.markers) {
    const std::string problem = apply(marker, gone);
    if (problem.empty()) continue;
    ++refused_count_;
    last_problem_ = "marker " + quoted(marker.ns + "/" + std::to_string(marker.id)) + ": " + problem;
    ROS_WARN_THROTTLE(log_period, "obstacles: refused %s", last_problem_.c_str());
  }
  for (const std::string& name : gone) simulation_.remove_obstacle(name);
}

std::string ObstacleListener::apply(const Marker& marker, std::set<std::string>& gone) {
  const std::string name = marker.ns + "/" + std::to_string(marker.id);
  switch (marker.action) {
    case Marker::ADD:
      if (std::string problem = add(marker); !problem.empty()) return problem;
      gone.erase(name);
      return "";
    case Marker::DELETE:
      gone.insert(name);
      return "";
    case Marker::DELETEALL:
      for (const auto& added : simulation_.added_obstacles()) gone.insert(added.first);
      return "";
    default:
      return "action: " + std::to_string(marker.action) + "; allowed: ADD (0), DELETE (2), DELETEALL (3)";
  }
}

std::string ObstacleListener::add(const Marker& marker) {
  MarkerObstacle wanted = obstacle_of(marker);
  if (!wanted.problem.empty()) return wanted.problem;
  if (std::holds_alternative<MeshShape>(wanted.obstacle.shape)) {
    if (std::string problem = find_mesh(wanted.obstacle); !problem.empty()) return problem;
  }
  return simulation_.set_obstacle(wanted.obstacle, marker.header.frame_id).message;
}

/// A mesh that an obstacle of the topic has already is not read again: markers come with each change of a pose.
std::string ObstacleListener::find_mesh(Obstacle& obstacle) {
  MeshShape& shape = std::get<MeshShape>(obstacle.shape);
  std::size_t triangles = 0;
  for (const auto& [name, added] : simulation_.added_obstacles()) {
    triangles += name == obstacle.name ? 0 : triangles_of(added.obstacle);
    const MeshShape* other = std::get_if<MeshShape>(&added.obstacle.shape);
    if (other && other->uri == shape.uri && other->scale == shape.scale) shape.mesh = other->mesh;
  }
  const ros::WallTime now = ros::WallTime::now();
  const auto failed = failures_.find(shape.uri);
  if (!shape.mesh && failed != failures_.end() && now < failed->second.time + failure_memory) return failed->second.problem;
  try {
    if (!shape.mesh) shape.mesh = read_mesh_file(file_of(shape.uri, {false, simulation_.scene().scene_directory}), shape.scale);
    if (triangles + shape.mesh->triangles().size() <= most_triangles) return "";
    return "mesh_resource: more than " + std::to_string(most_triangles) + " triangles in all";
  } catch (const ResourceError& error) {
    const std::string problem =
        "mesh_resource: " + verlet_cable::quoted(shape.uri) + ": " + error.what() + "; allowed: " + std::string(mesh_words);
    if (failures_.size() >= most_failures) failures_.clear();
    failures_[shape.uri] = {now, problem};
    return problem;
  }
}

}  // namespace verlet_cable
