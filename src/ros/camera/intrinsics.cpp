#include "camera/intrinsics.h"

#include <algorithm>

#include "camera/camera_info.h"
#include "time/log_period.h"

namespace verlet_cable {
namespace {

constexpr std::uint32_t info_queue_size = 5;

bool are_equal(const view::CameraModel& a, const view::CameraModel& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy && a.cx == b.cx && a.cy == b.cy &&
         a.distortion == b.distortion;
}

}  // namespace

Intrinsics::Intrinsics(ros::NodeHandle& node, const CameraSettings& settings, const ros::SubscriberStatusCallback& changed)
    : frame_(settings.optical_frame), near_(settings.camera.near), far_(settings.camera.far), topic_(settings.camera_info_topic) {
  for (const char* name : {"camera_info", "depth/camera_info", "rgb/camera_info", "mask/camera_info"})
    if (topic_ != node.resolveName(name))
      publishers_.push_back(node.advertise<sensor_msgs::CameraInfo>(name, info_queue_size, changed, changed));
  if (!topic_.empty()) {
    subscriber_ = node.subscribe(topic_, info_queue_size, &Intrinsics::receive, this);
    return;
  }
  const view::CameraModel model = view::camera_model(settings.camera);
  info_ = info_of(model);
  lens_ = std::make_shared<view::Lens>(model);
}

void Intrinsics::receive(const sensor_msgs::CameraInfoConstPtr& info) {
  const ReceivedModel received = model_of(*info, near_, far_);
  if (!received.problem.empty()) {
    warn_of(received.problem);
    return;
  }
  info_ = *info;
  if (!lens_ || !are_equal(lens_->model(), received.model)) lens_ = std::make_shared<view::Lens>(received.model);
}

void Intrinsics::warn_of(const std::string& problem) {
  const ros::WallTime now = ros::WallTime::now();
  if (problem == last_problem_ && now < next_warning_) return;
  last_problem_ = problem;
  next_warning_ = now + reminder_period;
  ROS_WARN("topic %s: refused %s%s", topic_.c_str(), problem.c_str(),
           lens_ ? "; the camera goes on with what came before" : "; there are no images until one can be used");
}

bool Intrinsics::are_wanted() const {
  return std::any_of(publishers_.begin(), publishers_.end(),
                     [](const auto& publisher) { return publisher.getNumSubscribers() > 0; });
}

void Intrinsics::publish(const ros::Time& stamp) const {
  if (!are_wanted()) return;
  const auto message = boost::make_shared<sensor_msgs::CameraInfo>(info_);
  message->header.stamp = stamp;
  message->header.frame_id = frame_;
  for (const ros::Publisher& publisher : publishers_) publisher.publish(message);
}

}  // namespace verlet_cable
