#pragma once

#include <ros/time.h>

#include <map>
#include <string>
#include <vector>

#include "frames/tf_inputs.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Tells of the frames that a scene names and tf has not had: where they are expected, and what waits for them.
class MissingFrames {
 public:
  /// Tells of another scene's frames from now on.
  void watch();

  /// At a start: logs which frames are missing still.
  void report(const World& world, const TfInputs& frames) const;
  /// Warns, once they have been missing for 5 s of wall time: of cables and nets that wait for frames, every 10 s; and, once for
  /// each frame, of others that tf has, but not connected to the fixed frame.
  void warn(const SceneDesc& scene, const World& world, const TfInputs& frames);

 private:
  struct Unconnected {
    ros::WallTime since;
    bool told = false;
  };

  void warn_of_waiting(const SceneDesc& scene, const World& world, const TfInputs& frames, ros::WallTime now);
  void warn_of_unconnected(const SceneDesc& scene, const World& world, const TfInputs& frames, ros::WallTime now);

  ros::WallTime next_look_;
  ros::WallTime next_warning_;                      ///< that something waits for frames; zero while nothing does
  std::map<std::string, Unconnected> unconnected_;  ///< by frame
};

/// What holds a cable or net that is not there yet, in a frame that tf has not had yet.
struct WaitingAttachment {
  std::string name;
  std::string holds;  ///< name of the cable or net
  std::string frame;
};

/// In the scene's order.
std::vector<WaitingAttachment> waiting_attachments(const SceneDesc& scene, const World& world, const BoundaryInputs& inputs);

}  // namespace verlet_cable
