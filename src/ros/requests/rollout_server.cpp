#include "requests/rollout_server.h"

#include <actionlib/server/action_server.h>

#include <utility>

#include "threads/guarded_queue.h"
#include "time/ros_time.h"

namespace verlet_cable {
namespace {

// As actionlib's.
constexpr std::uint32_t rollout_queue_size = 50;
const ros::WallDuration status_period(0.2);
/// How long a goal that has ended is listed still.
constexpr Nanoseconds status_memory = 5'000'000'000;
constexpr std::size_t most_listed = 1000;
constexpr std::size_t longest_id = 1000;  // characters

bool is_too_long(const actionlib_msgs::GoalID& goal, const char* field) {
  if (goal.id.size() <= longest_id) return false;
  ROS_WARN("%s: %zu characters; allowed: at most %zu", field, goal.id.size(), longest_id);
  return true;
}

}  // namespace

RolloutServer::RolloutServer(const ros::NodeHandle& node, const std::string& name, std::function<void(GoalHandle)> accept,
                             std::function<void(GoalHandle)> cancel)
    : ActionServerBase(std::move(accept), std::move(cancel), false), node_(node, name) {}

void RolloutServer::initialize() {
  result_ = node_.advertise<RolloutActionResult>("result", rollout_queue_size);
  feedback_ = node_.advertise<RolloutActionFeedback>("feedback", rollout_queue_size);
  status_ = node_.advertise<actionlib_msgs::GoalStatusArray>("status", rollout_queue_size, true);
  goals_ = node_.subscribe<RolloutActionGoal>("goal", rollout_queue_size, [this](const RolloutActionGoalConstPtr& goal) {
    if (!is_too_long(goal->goal_id, "rollout/goal: goal_id.id")) goalCallback(goal);
  });
  cancels_ = node_.subscribe<actionlib_msgs::GoalID>(
      "cancel", rollout_queue_size, [this](const actionlib_msgs::GoalIDConstPtr& goal) { receive_cancel(goal); });
  timer_ = node_.createWallTimer(status_period,
                                 [this](const ros::WallTimerEvent&) { run_guarded("a status", [this] { publishStatus(); }); });
}

/// A stamp cancels every goal from before it: one in the future would cancel those that are still to come.
void RolloutServer::receive_cancel(const actionlib_msgs::GoalIDConstPtr& goal) {
  if (is_too_long(*goal, "rollout/cancel: id")) return;
  const Nanoseconds now = from_ros_time(ros::Time::now()), stamp = from_ros_time(goal->stamp);
  {
    // Each cancel of an unknown goal is listed.
    const boost::recursive_mutex::scoped_lock lock(lock_);
    if (status_list_.size() >= most_listed) {
      ROS_WARN("rollout/cancel: more than %zu goals are listed", most_listed);
      return;
    }
  }
  if (stamp <= now + status_memory) return cancelCallback(goal);
  ROS_WARN("rollout/cancel: stamp %u s; allowed: 0, or up to ROS time, %lld s", goal->stamp.sec,
           static_cast<long long>(now / 1'000'000'000));
}

void RolloutServer::publishResult(const actionlib_msgs::GoalStatus& status, const RolloutResult& result) {
  const boost::recursive_mutex::scoped_lock lock(lock_);
  const auto message = boost::make_shared<RolloutActionResult>();
  message->header.stamp = ros::Time::now();
  message->status = status;
  message->result = result;
  result_.publish(message);
  publishStatus();
}

void RolloutServer::publishFeedback(const actionlib_msgs::GoalStatus& status, const RolloutFeedback& feedback) {
  const boost::recursive_mutex::scoped_lock lock(lock_);
  const auto message = boost::make_shared<RolloutActionFeedback>();
  message->header.stamp = ros::Time::now();
  message->status = status;
  message->feedback = feedback;
  feedback_.publish(message);
}

void RolloutServer::publishStatus() {
  const boost::recursive_mutex::scoped_lock lock(lock_);
  const ros::Time now = ros::Time::now();
  actionlib_msgs::GoalStatusArray message;
  message.header.stamp = now;
  for (auto goal = status_list_.begin(); goal != status_list_.end();) {
    message.status_list.push_back(goal->status_);
    // actionlib would list a cancel of what is no goal, or none any longer, for ever.
    if (goal->handle_tracker_.empty() && goal->handle_destruction_time_.isZero()) goal->handle_destruction_time_ = now;
    const bool ended = !goal->handle_destruction_time_.isZero();
    const bool old = from_ros_time(goal->handle_destruction_time_) + status_memory < from_ros_time(now);
    // Nor do they become more and more while ROS time stands.
    const bool forgotten = ended && (old || status_list_.size() > most_listed);
    goal = forgotten ? status_list_.erase(goal) : std::next(goal);
  }
  status_.publish(message);
}

}  // namespace verlet_cable
