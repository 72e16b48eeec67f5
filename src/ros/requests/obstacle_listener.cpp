#include "requests/obstacle_listener.h"

#include <algorithm>
#include <set>
#include <variant>

#include "publish/obstacle_markers.h"
#include "time/log_period.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

using visualization_msgs::Marker;

constexpr int obstacle_queue_size = 10;
/// What could not be read is not tried again for so long: it is asked for with each message.
const ros::WallDuration failure_memory(5.0);
constexpr std::size_t most_failures = 100;
constexpr std::size_t most_pending = 1000;
constexpr std::size_t most_markers = 5000;         // of a message: all obstacles there can be, several times
constexpr std::size_t most_meshes = 1000;          // that are remembered
constexpr std::size_t most_triangles = 2'000'000;  // of all obstacles of the topic

std::size_t triangles_of(const Obstacle& obstacle) {
  const MeshShape* shape = std::get_if<MeshShape>(&obstacle.shape);
  return shape ? shape->mesh->triangles().size() : 0;
}

}  // namespace

ObstacleListener::ObstacleListener(ros::NodeHandle& private_node, Simulation& simulation)
    : simulation_(simulation),
      loader_(private_node.getCallbackQueue(), simulation.scene().scene_directory,
              [this](const LoadedMesh& loaded) { receive_mesh(loaded); }),
      subscriber_(private_node.subscribe<visualization_msgs::MarkerArray>(
          "obstacles", obstacle_queue_size,
          [this](const visualization_msgs::MarkerArrayConstPtr& markers) { receive(*markers); })) {}

void ObstacleListener::receive(const visualization_msgs::MarkerArray& markers) {
  if (markers.markers.size() > most_markers) {
    return refuse("message of " + std::to_string(markers.markers.size()) + " markers; allowed: at most " +
                  std::to_string(most_markers));
  }
  // What a message deletes and adds again is moved: what lies on it goes on lying.
  std::set<std::string> gone;
  for (const Marker& marker : markers.markers) {
    const std::string problem = apply(marker, gone);
    if (!problem.empty()) refuse_marker(marker.ns + "/" + std::to_string(marker.id), problem);
  }
  for (const std::string& name : gone) simulation_.remove_obstacle(name);
}

void ObstacleListener::refuse_marker(const std::string& name, const std::string& problem) {
  refuse("marker " + in_quotes(name) + ": " + problem);
}

void ObstacleListener::refuse(const std::string& problem) {
  ++refused_count_;
  last_problem_ = problem;
  ROS_WARN_THROTTLE(log_period, "topic obstacles: refused %s", last_problem_.c_str());
}

std::string ObstacleListener::apply(const Marker& marker, std::set<std::string>& gone) {
  const std::string name = marker.ns + "/" + std::to_string(marker.id);
  switch (marker.action) {
    case Marker::ADD:
      return add(marker, gone);
    case Marker::DELETE:
      drop_pending(name);
      if (simulation_.added_obstacles().count(name) > 0) gone.insert(name);
      return "";
    case Marker::DELETEALL:
      while (!pending_.empty()) drop_pending(std::string(pending_.begin()->first));
      if (gone.size() == simulation_.added_obstacles().size()) return "";  // all of them already, however often it is said
      for (const auto& added : simulation_.added_obstacles()) gone.insert(added.first);
      return "";
    default:
      return "action: " + std::to_string(marker.action) + "; allowed: ADD (0), DELETE (2), DELETEALL (3)";
  }
}

std::string ObstacleListener::add(const Marker& marker, std::set<std::string>& gone) {
  MarkerObstacle wanted = obstacle_of(marker);
  if (!wanted.problem.empty()) return wanted.problem;
  Obstacle& obstacle = wanted.obstacle;
  if (MeshShape* shape = std::get_if<MeshShape>(&obstacle.shape)) {
    // Markers come with each change of a pose.
    const MeshRequest request{shape->uri, shape->scale};
    const auto known = meshes_.find(request);
    if (known != meshes_.end()) shape->mesh = known->second.lock();
    if (!shape->mesh) return wait_for_mesh({obstacle, marker.header.frame_id, request});
  }
  if (std::string problem = place(obstacle, marker.header.frame_id); !problem.empty()) return problem;
  drop_pending(obstacle.name);
  gone.erase(obstacle.name);
  return "";
}

std::string ObstacleListener::wait_for_mesh(const Pending& wanted) {
  const std::string& name = wanted.obstacle.name;
  const auto failed = failures_.find(wanted.mesh.uri);
  if (failed != failures_.end() && ros::WallTime::now() < failed->second.time + failure_memory) return failed->second.problem;
  if ((pending_.size() >= most_pending && !pending_.count(name)) || !loader_.request(wanted.mesh)) {
    return "mesh_resource: " + verlet_cable::in_quotes(wanted.mesh.uri) +
           ": too many obstacles wait to be read; allowed: at most " + std::to_string(most_pending) + ", with " +
           std::to_string(MeshLoader::most_waiting) + " meshes";
  }
  const auto before = pending_.find(name);
  if (before != pending_.end() && !(before->second.mesh == wanted.mesh)) drop_pending(name);
  pending_.insert_or_assign(name, wanted);
  return "";
}

void ObstacleListener::receive_mesh(const LoadedMesh& loaded) {
  std::string unread;
  if (loaded.mesh) {
    if (meshes_.size() >= most_meshes) meshes_.clear();
    meshes_[loaded.request] = loaded.mesh;
  } else {
    unread = "mesh_resource: " + loaded.problem;
    if (failures_.size() >= most_failures) failures_.clear();
    failures_[loaded.request.uri] = {ros::WallTime::now(), unread};
  }
  for (auto it = pending_.begin(); it != pending_.end();) {
    if (!(it->second.mesh == loaded.request)) {
      ++it;
      continue;
    }
    Obstacle& obstacle = it->second.obstacle;
    std::get<MeshShape>(obstacle.shape).mesh = loaded.mesh;
    const std::string problem = loaded.mesh ? place(obstacle, it->second.frame) : unread;
    if (!problem.empty()) refuse_marker(obstacle.name, problem);
    it = pending_.erase(it);
  }
}

std::string ObstacleListener::place(const Obstacle& obstacle, const std::string& frame) {
  const auto before = simulation_.added_obstacles().find(obstacle.name);
  std::size_t triangles = triangles_of(obstacle);
  if (triangles > 0 && (before == simulation_.added_obstacles().end() || triangles > triangles_of(before->second.obstacle))) {
    for (const auto& [name, added] : simulation_.added_obstacles())
      triangles += name == obstacle.name ? 0 : triangles_of(added.obstacle);
    if (triangles > most_triangles) return "mesh_resource: more than " + std::to_string(most_triangles) + " triangles in all";
  }
  return simulation_.set_obstacle(obstacle, frame).message;
}

/// What nobody waits for any more is not read.
void ObstacleListener::drop_pending(const std::string& name) {
  const auto found = pending_.find(name);
  if (found == pending_.end()) return;
  const MeshRequest mesh = found->second.mesh;
  pending_.erase(found);
  const auto waits_for_it = [&](const auto& entry) { return entry.second.mesh == mesh; };
  if (std::none_of(pending_.begin(), pending_.end(), waits_for_it)) loader_.forget(mesh);
}

}  // namespace verlet_cable
