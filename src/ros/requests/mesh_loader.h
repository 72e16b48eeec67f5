#pragma once

#include <ros/callback_queue_interface.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "verlet_cable/core/triangle_mesh.h"

namespace verlet_cable {

/// A mesh that a marker names.
struct MeshRequest {
  std::string uri;
  Vector3 scale;
};
bool operator<(const MeshRequest& a, const MeshRequest& b);
bool operator==(const MeshRequest& a, const MeshRequest& b);

struct LoadedMesh {
  MeshRequest request;
  std::shared_ptr<const TriangleMesh> mesh;  ///< none if it could not be read
  std::string problem;                       ///< then why not: the URI, what is wrong, what is allowed
};

/// Reads meshes on a thread of its own, one after the other, in the order in which they were asked for. All its functions are for
/// the thread that serves the queue.
class MeshLoader {
 public:
  /// `receive` is called from `queue`. Files are read as a scene's may be that is read from `scene_directory`.
  MeshLoader(ros::CallbackQueueInterface* queue, std::string scene_directory, std::function<void(const LoadedMesh&)> receive);
  ~MeshLoader();
  MeshLoader(const MeshLoader&) = delete;
  MeshLoader& operator=(const MeshLoader&) = delete;

  /// Has it read, if it is not being read already. Whether there was room among those that wait.
  bool request(const MeshRequest& request);
  void forget(const MeshRequest& request);  ///< nobody needs it any more: it is not read, unless that has begun

  static constexpr std::size_t most_waiting = 100;

 private:
  class Delivery;

  void run();
  void deliver();

  ros::CallbackQueueInterface* const queue_;
  const std::string scene_directory_;
  const std::function<void(const LoadedMesh&)> receive_;
  std::atomic<bool> stopped_{false};
  std::mutex mutex_;  ///< of those below
  std::condition_variable changed_;
  std::deque<MeshRequest> waiting_;
  std::optional<MeshRequest> reading_;
  std::vector<LoadedMesh> loaded_;  ///< not received yet
  std::thread thread_;
};

}  // namespace verlet_cable
