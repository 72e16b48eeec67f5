#include "camera/camera_node.h"

#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "camera/images.h"
#include "camera/intrinsics.h"
#include "camera/moment_source.h"
#include "camera/stage_maker.h"
#include "camera/tf_frames.h"
#include "threads/guarded_queue.h"
#include "time/log_period.h"

namespace verlet_cable {
namespace {

ros::NodeHandle guarded(ros::NodeHandle node, GuardedQueue& guard) {
  node.setCallbackQueue(&guard);
  return node;
}

}  // namespace

struct CameraNode::Parts {
  explicit Parts(ros::NodeHandle private_node);
  ~Parts();
  void follow_subscribers();
  std::string take(const Moment& moment, bool is_last);
  std::string find_links(const Moment& moment, bool is_last, std::vector<std::optional<Pose>>& poses);

  std::mutex mutex;  ///< a nodelet is loaded and unloaded by other threads than that of its callbacks
  std::unique_lock<std::mutex> loading{mutex};
  bool is_ending = false;
  GuardedQueue guard;
  ros::NodeHandle node;
  const CameraSettings settings;
  const ros::SubscriberStatusCallback changed;
  std::shared_ptr<StageMaker> stages;
  TfFrames frames;
  std::set<std::string> lost_links;  ///< nobody waits for them
  Images images;
  Intrinsics intrinsics;
  MomentSource moments;
};

CameraNode::Parts::Parts(ros::NodeHandle private_node)
    : guard(*private_node.getCallbackQueue()),
      node(guarded(private_node, guard)),
      settings(read_camera_parameters(node)),
      changed([this](const ros::SingleSubscriberPublisher&) { follow_subscribers(); }),
      stages(StageMaker::shared(settings)),
      images(node, settings, changed),
      intrinsics(node, settings, changed),
      moments(node, settings, [this](const Moment& moment, bool is_last) { return take(moment, is_last); }) {
  loading.unlock();
}

CameraNode::Parts::~Parts() {
  const std::lock_guard<std::mutex> lock(mutex);
  is_ending = true;
}

void CameraNode::Parts::follow_subscribers() {
  const std::lock_guard<std::mutex> lock(mutex);
  if (is_ending) return;
  moments.listen(images.are_wanted() || intrinsics.are_wanted());
}

std::string CameraNode::Parts::take(const Moment& moment, bool is_last) {
  const std::lock_guard<std::mutex> lock(mutex);
  if (is_ending) return "";
  const std_msgs::Header& header = moment.state->header;
  const std::shared_ptr<const view::Lens> lens = intrinsics.lens();
  if (!lens) return "nothing on " + intrinsics.awaited_topic() + " yet that can be used";
  std::string why;
  const std::optional<Pose> camera = frames.pose(header.frame_id, settings.optical_frame, header.stamp, why);
  if (!camera) return "optical_frame: " + why;
  std::vector<std::optional<Pose>> links;
  why = find_links(moment, is_last, links);
  if (!why.empty()) return why;
  try {
    const std::shared_ptr<const view::Stage> stage = stages->stage(moment, links);
    Shot shot{header, *moment.state, *stage, *lens, *camera};
    shot.header.frame_id = settings.optical_frame;
    intrinsics.publish(header.stamp);
    images.publish(shot);
  } catch (const std::exception& problem) {
    ROS_ERROR_THROTTLE(log_period, "no images of a state that cannot be drawn: %s", problem.what());
  }
  return "";
}

/// Why the pose of a link is worth waiting for, empty if none is.
std::string CameraNode::Parts::find_links(const Moment& moment, bool is_last, std::vector<std::optional<Pose>>& poses) {
  const std_msgs::Header& header = moment.state->header;
  for (const std::string& link : stages->links()) {
    std::string why;
    poses.push_back(frames.pose(header.frame_id, link, header.stamp, why));
    if (poses.back()) {
      lost_links.erase(link);
    } else if (!is_last && lost_links.count(link) == 0) {
      return "link " + link + ": " + why;
    } else if (lost_links.insert(link).second) {
      ROS_WARN("without the robot's link %s: %s", link.c_str(), why.c_str());
    }
  }
  return "";
}

CameraNode::CameraNode(ros::NodeHandle private_node) : parts_(std::make_unique<Parts>(private_node)) {}
CameraNode::~CameraNode() = default;

}  // namespace verlet_cable
