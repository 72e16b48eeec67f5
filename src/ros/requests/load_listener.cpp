#include "requests/load_listener.h"

#include <set>

#include "edit_requests/checked_load.h"
#include "edit_requests/error_text.h"
#include "requests/requested.h"
#include "time/log_period.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

/// What comes while a step takes long: a second of a thousand a second.
constexpr int load_queue_size = 1000;
/// Each topic is registered with the master by a call: those of a large scene come with the next updates.
constexpr int most_loads_at_once = 20;

const LoadWords& topic_words() {
  static const LoadWords words{"body", "wrench.force", "wrench.torque", "header.frame_id"};
  return words;
}

}  // namespace

LoadListener::LoadListener(ros::NodeHandle& private_node, Simulation& simulation)
    : simulation_(simulation), node_(private_node, "apply") {
  node_.setCallbackQueue(private_node.getCallbackQueue());
  follow_scene();
}

void LoadListener::follow_scene() {
  if (scene_version_ == simulation_.scene_version()) return;
  std::set<std::string> names;
  for (const BodyDesc& body : simulation_.scene().bodies) names.insert(body.name);
  int left = most_loads_at_once;
  for (auto subscriber = subscribers_.begin(); subscriber != subscribers_.end() && left > 0;) {
    const bool is_gone = names.count(subscriber->first) == 0;
    if (is_gone) --left;
    subscriber = is_gone ? subscribers_.erase(subscriber) : std::next(subscriber);
  }
  for (const std::string& name : names) {
    if (left == 0) return;
    if (subscribers_.count(name) > 0) continue;
    --left;
    subscribers_[name] = node_.subscribe<geometry_msgs::WrenchStamped>(
        name, load_queue_size, [this, name](const geometry_msgs::WrenchStampedConstPtr& message) { receive(name, *message); });
  }
  if (left > 0) scene_version_ = simulation_.scene_version();
}

void LoadListener::receive(const std::string& body, const geometry_msgs::WrenchStamped& message) {
  RequestedLoad request;
  request.frame_id = message.header.frame_id;
  request.force = requested_vector(message.wrench.force);
  request.torque = requested_vector(message.wrench.torque);
  request.duration = simulation_.scene().apply_timeout;
  request.words = &topic_words();
  RequestedPlace place;
  place.cable = body;
  EditResult result = simulation_.refused_before_start();
  if (simulation_.started()) {
    CheckedLoad load = simulation_.check_load(request, place);
    load.load.name = "apply/" + body;  // no name of a request has a slash
    result = load.errors.empty() ? simulation_.apply_load(load.load) : refused(load.errors);
  }
  if (!result.ok) ROS_WARN_THROTTLE(log_period, "topic apply/%s: refused: %s", body.c_str(), result.message.c_str());
}

}  // namespace verlet_cable
