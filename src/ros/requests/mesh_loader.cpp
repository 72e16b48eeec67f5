#include "requests/mesh_loader.h"

#include <algorithm>
#include <new>
#include <tuple>
#include <utility>

#include "scene/mesh_cache.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

auto as_tuple(const MeshRequest& request) {
  return std::make_tuple(request.uri, request.scale.x(), request.scale.y(), request.scale.z());
}

LoadedMesh load(const MeshRequest& request, const std::string& scene_directory, const std::atomic<bool>& stopped,
                MeshCache& cache) {
  LoadedMesh loaded{request, nullptr, ""};
  Patience patience;
  patience.cancelled = &stopped;
  const auto fail = [&](const std::string& what) {
    loaded.problem = verlet_cable::in_quotes(request.uri) + ": " + what + "; allowed: " + std::string(mesh_words);
  };
  try {
    loaded.mesh = cache.read(file_of(request.uri, {false, scene_directory}), request.scale, patience);
  } catch (const ResourceError& error) {
    fail(error.what());
  } catch (const std::bad_alloc&) {
    fail("there is not enough memory for it");
  }
  return loaded;
}

}  // namespace

bool operator<(const MeshRequest& a, const MeshRequest& b) {
  return as_tuple(a) < as_tuple(b);
}

bool operator==(const MeshRequest& a, const MeshRequest& b) {
  return as_tuple(a) == as_tuple(b);
}

/// In the queue of the node.
class MeshLoader::Delivery : public ros::CallbackInterface {
 public:
  explicit Delivery(MeshLoader& loader) : loader_(loader) {}
  CallResult call() override {
    loader_.deliver();
    return Success;
  }

 private:
  MeshLoader& loader_;
};

MeshLoader::MeshLoader(ros::CallbackQueueInterface* queue, std::string scene_directory,
                       std::function<void(const LoadedMesh&)> receive)
    : queue_(queue), scene_directory_(std::move(scene_directory)), receive_(std::move(receive)), thread_([this] { run(); }) {}

MeshLoader::~MeshLoader() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  thread_.join();
  queue_->removeByID(reinterpret_cast<std::uint64_t>(this));
}

bool MeshLoader::request(const MeshRequest& request) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto is_of_it = [&](const LoadedMesh& loaded) { return loaded.request == request; };
  if (reading_ == request || std::find(waiting_.begin(), waiting_.end(), request) != waiting_.end() ||
      std::any_of(loaded_.begin(), loaded_.end(), is_of_it))
    return true;
  if (waiting_.size() >= most_waiting) return false;
  waiting_.push_back(request);
  changed_.notify_all();
  return true;
}

void MeshLoader::forget(const MeshRequest& request) {
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_.erase(std::remove(waiting_.begin(), waiting_.end(), request), waiting_.end());
}

void MeshLoader::run() {
  MeshCache cache;
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return stopped_ || !waiting_.empty(); });
    if (stopped_) return;
    const MeshRequest request = waiting_.front();
    waiting_.pop_front();
    reading_ = request;
    lock.unlock();
    LoadedMesh loaded = load(request, scene_directory_, stopped_, cache);
    lock.lock();
    reading_.reset();
    loaded_.push_back(std::move(loaded));
    lock.unlock();
    queue_->addCallback(ros::CallbackInterfacePtr(new Delivery(*this)), reinterpret_cast<std::uint64_t>(this));
    lock.lock();
  }
}

void MeshLoader::deliver() {
  std::vector<LoadedMesh> loaded;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    loaded.swap(loaded_);
  }
  for (const LoadedMesh& mesh : loaded) receive_(mesh);
}

}  // namespace verlet_cable
