#include "camera/moment_source.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "threads/guarded_queue.h"
#include "time/log_period.h"

namespace verlet_cable {
namespace {

constexpr std::uint32_t state_queue_size = 1;  // a camera that cannot keep up sees what is newest
constexpr std::uint32_t appearance_queue_size = 100;
constexpr std::size_t most_waiting = 100;     // a second of states, as many as a cable node has in its queue
const ros::WallDuration retry_period(0.002);  // tf has no call for what comes
const ros::WallDuration first_warning(5.0);   // a cable node may have been started together with the camera, and may need so long
constexpr double rounding = 1e-6;             // of a period: stamps are on its edges

std::string beside(const std::string& topic, const std::string& name) {
  return ros::names::append(ros::names::parentNamespace(topic), name);
}

}  // namespace

MomentSource::MomentSource(const ros::NodeHandle& node, const CameraSettings& settings, Take take)
    : node_(node),
      state_topic_(settings.state),
      appearance_topic_(beside(state_topic_, "appearance")),
      rate_(settings.rate),
      patience_(settings.tf_timeout),
      take_(std::move(take)),
      retry_(node_.createWallTimer(
          retry_period, [this](const ros::WallTimerEvent&) { run_guarded("a try", [this] { offer_all(); }); }, false, false)),
      watch_(node_.createWallTimer(
          ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { run_guarded("a look", [this] { warn_of_silence(); }); },
          false, false)) {}

void MomentSource::listen(bool wanted) {
  if (wanted == static_cast<bool>(states_)) return;
  waiting_.clear();
  received_.clear();
  has_appearance_ = true;
  has_state_ = false;
  next_warning_ = ros::WallTime::now() + first_warning;
  if (!wanted) {
    watch_.stop();
    states_.shutdown();
    appearances_.shutdown();
    states_ = appearances_ = ros::Subscriber();
    return;
  }
  const auto now = ros::TransportHints().tcpNoDelay();
  appearances_ = node_.subscribe(appearance_topic_, appearance_queue_size, &MomentSource::receive_appearance, this, now);
  states_ = node_.subscribe(state_topic_, state_queue_size, &MomentSource::receive_state, this, now);
  watch_.start();
}

/// Nobody publishes it, or nothing has come: the name may be wrong. Of a bag that stands, states need not come for a while.
void MomentSource::warn_of_silence() {
  const ros::WallTime now = ros::WallTime::now();
  const bool has_publisher = states_.getNumPublishers() > 0;
  if (has_publisher && has_state_) next_warning_ = now + first_warning;
  if (now < next_warning_) return;
  next_warning_ = now + reminder_period;
  ROS_WARN("no images: %s %s, the topic of the parameter state; allowed: that of a cable node, such as /cable/state",
           has_publisher ? "nothing comes on" : "nobody publishes", state_topic_.c_str());
}

void MomentSource::receive_state(const CableArrayConstPtr& state) {
  has_state_ = true;
  if (!is_due(state->header.stamp)) return;
  if (waiting_.size() == most_waiting) waiting_.pop_front();
  waiting_.push_back({state, ros::WallTime::now() + patience_});
  offer_all();
}

void MomentSource::receive_appearance(const AppearanceConstPtr& appearance) {
  has_appearance_ = true;
  if (received_.size() == most_waiting) received_.pop_front();
  received_.push_back(appearance);
  offer_all();
}

/// The first of each period, by its stamp, so that it is the same one each time a bag is played. While time stands, what is
/// edited shows, too.
bool MomentSource::is_due(const ros::Time& stamp) {
  const auto period = [this](const ros::Time& time) { return std::floor(time.toSec() * rate_ + rounding); };
  const ros::WallTime now = ros::WallTime::now();
  const bool stands = stamp == last_stamp_ && (now - last_due_).toSec() >= 1 / rate_;
  if (period(stamp) == period(last_stamp_) && !stands) return false;
  last_stamp_ = stamp;
  last_due_ = now;
  return true;
}

/// The newest that can be taken; older ones are late.
void MomentSource::offer_all() {
  for (auto newest = waiting_.rbegin(); newest != waiting_.rend(); ++newest) {
    if (!offer(newest->state, false).empty()) continue;
    waiting_.erase(waiting_.begin(), newest.base());
    break;
  }
  while (!waiting_.empty() && waiting_.front().deadline < ros::WallTime::now()) {
    const CableArrayConstPtr state = waiting_.front().state;
    waiting_.pop_front();
    if (appearances_.getNumPublishers() == 0) has_appearance_ = false;
    const std::string problem = offer(state, true);
    if (!problem.empty()) ROS_WARN_THROTTLE(log_period, "no images: %s", problem.c_str());
  }
  waiting_.empty() ? retry_.stop() : retry_.start();
}

std::string MomentSource::offer(const CableArrayConstPtr& state, bool is_last) {
  const auto is_of_it = [&](const AppearanceConstPtr& appearance) { return appearance->header.stamp == state->header.stamp; };
  const auto found = std::find_if(received_.rbegin(), received_.rend(), is_of_it);
  if (found != received_.rend()) return take_({state, *found}, is_last);
  if (!has_appearance_) return take_({state, nullptr}, is_last);
  return "nothing on " + appearance_topic_ + " with the stamp of a message on " + state_topic_;
}

}  // namespace verlet_cable
