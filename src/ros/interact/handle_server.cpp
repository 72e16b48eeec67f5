#include "interact/handle_server.h"

#include <utility>

#include "threads/guarded_queue.h"

namespace verlet_cable {
namespace {

using visualization_msgs::InteractiveMarkerInit;
using visualization_msgs::InteractiveMarkerPose;
using visualization_msgs::InteractiveMarkerUpdate;

// As the library's.
constexpr std::uint32_t handle_queue_size = 100;
const ros::WallDuration sign_of_life(0.5);
const ros::WallDuration hold_time(1.0);   // in which nobody else drags what a client has dragged
constexpr std::size_t longest_id = 1000;  // of a client, that is kept
/// After feedback on a marker, in which its pose is sent though it is where it was.
const ros::WallDuration correction_time(2.0);

}  // namespace

HandleServer::HandleServer(const ros::NodeHandle& parent, const std::string& topic, std::function<void(const Feedback&)> receive)
    : receive_(std::move(receive)) {
  ros::NodeHandle node(parent, topic);
  // Not latched: who comes gets all that is there, and as long as nobody listens none of it is put together and sent.
  all_ = node.advertise<InteractiveMarkerInit>("update_full", handle_queue_size,
                                               [this](const ros::SingleSubscriberPublisher& viewer) { viewer.publish(all()); });
  updates_ = node.advertise<InteractiveMarkerUpdate>("update", handle_queue_size);
  feedback_ =
      node.subscribe<Feedback>("feedback", handle_queue_size, [this](const Feedback::ConstPtr& feedback) { take(*feedback); });
  timer_ = node.createWallTimer(sign_of_life, [this](const ros::WallTimerEvent&) {
    run_guarded("a sign of life", [this] {
      InteractiveMarkerUpdate update;
      update.server_id = ros::this_node::getName();
      update.seq_num = sequence_;
      update.type = InteractiveMarkerUpdate::KEEP_ALIVE;
      updates_.publish(update);
    });
  });
  apply_changes();
}

void HandleServer::insert(const visualization_msgs::InteractiveMarker& marker) {
  markers_[marker.name] = marker;
  changes_.markers.push_back(marker);
}

void HandleServer::set_pose(const std::string& name, const geometry_msgs::Pose& pose) {
  visualization_msgs::InteractiveMarker& marker = markers_.at(name);
  marker.pose = pose;
  InteractiveMarkerPose& change = changes_.poses.emplace_back();
  change.header = marker.header;
  change.name = name;
  change.pose = pose;
}

void HandleServer::erase(const std::string& marker) {
  markers_.erase(marker);
  clients_.erase(marker);
  heard_of_.erase(marker);
  changes_.erases.push_back(marker);
}

void HandleServer::clear() {
  changes_ = {};
  for (const auto& [name, marker] : markers_) changes_.erases.push_back(name);
  markers_.clear();
  clients_.clear();
  heard_of_.clear();
}

bool HandleServer::may_be_elsewhere(const std::string& marker) const {
  const auto heard = heard_of_.find(marker);
  return heard != heard_of_.end() && ros::WallTime::now() - heard->second < correction_time;
}

void HandleServer::apply_changes() {
  InteractiveMarkerUpdate update = std::exchange(changes_, {});
  update.type = InteractiveMarkerUpdate::UPDATE;
  update.server_id = ros::this_node::getName();
  update.seq_num = ++sequence_;
  updates_.publish(update);
  if (all_.getNumSubscribers() > 0) all_.publish(all());
}

InteractiveMarkerInit HandleServer::all() const {
  InteractiveMarkerInit all;
  all.server_id = ros::this_node::getName();
  all.seq_num = sequence_;
  for (const auto& [name, marker] : markers_) all.markers.push_back(marker);
  return all;
}

void HandleServer::take(const Feedback& feedback) {
  if (markers_.count(feedback.marker_name) == 0) return;
  Client& client = clients_[feedback.marker_name];
  const ros::WallTime now = ros::WallTime::now();
  heard_of_[feedback.marker_name] = now;
  const std::string id = feedback.client_id.substr(0, longest_id);
  if (client.id != id && now - client.last < hold_time) return;
  client = {id, now};
  receive_(feedback);
}

}  // namespace verlet_cable
