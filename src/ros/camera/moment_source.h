#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <string>

#include "camera/camera_settings.h"
#include "camera/moment.h"

namespace verlet_cable {

/// Subscribed topic `/cable/state` (verlet_cable/CableArray), or that which the parameter `state` names, and `appearance` beside
/// it, as long as somebody listens to the camera. One state is taken in each period of `rate`, with the appearance of the same
/// stamp.
class MomentSource {
 public:
  /// Takes a moment, or returns why it cannot be taken yet. `is_last`: it is not offered again.
  using Take = std::function<std::string(const Moment&, bool is_last)>;

  MomentSource(const ros::NodeHandle& node, const CameraSettings& settings, Take take);

  void listen(bool wanted);  ///< subscribes, or no longer

 private:
  struct Waiting {
    CableArrayConstPtr state;
    ros::WallTime deadline;
  };

  void receive_state(const CableArrayConstPtr& state);
  void receive_appearance(const AppearanceConstPtr& appearance);
  bool is_due(const ros::Time& stamp);
  void offer_all();
  std::string offer(const CableArrayConstPtr& state, bool is_last);
  void warn_of_silence();

  ros::NodeHandle node_;
  const std::string state_topic_;
  const std::string appearance_topic_;
  const double rate_;
  const ros::WallDuration patience_;
  const Take take_;
  std::deque<Waiting> waiting_;  ///< oldest first
  std::deque<AppearanceConstPtr> received_;
  bool has_appearance_ = true;  ///< until a state came, and nobody published any
  ros::Time last_stamp_;        ///< of what was due last
  ros::WallTime last_due_;
  bool has_state_ = false;      ///< since it listens
  ros::WallTime next_warning_;  ///< of the lack of states
  ros::Subscriber states_;      ///< it and those below call this, and go first
  ros::Subscriber appearances_;
  ros::WallTimer retry_, watch_;
};

}  // namespace verlet_cable
