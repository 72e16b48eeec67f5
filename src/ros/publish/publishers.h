#pragma once

#include <ros/ros.h>

#include <memory>

#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What the node shows of a world: `markers`, `points` and `surface` in the drawing frame (drawing_frame.h), which is on
/// /tf_static where it is not the scene's fixed frame; `state` and `appearance` in the fixed frame, `wrench/<attachment>` in the
/// attachment's; `legend`, and the bodies' frames on /tf. The log says once where single precision makes what is drawn coarse.
/// Nothing but the range of the colors is computed for a topic without subscribers, and no cable with a value that is not finite
/// is published.
class Publishers {
 public:
  /// Advertises under `private_node`. Of the scene: `frame_id`, `origin`, `marker_style`, `color_by`, and what the color scale is
  /// made from, and `broadcast_tf`.
  Publishers(ros::NodeHandle& private_node, const SceneDesc& scene);
  ~Publishers();

  /// Shows another scene from now on; what is gone is deleted at the next tick.
  void show(const SceneDesc& scene);

  /// After each step: a tick shows wrenches as their means over the steps since the one before, and the
  /// worst status of these.
  void note_step(const World& world);
  /// What comes next does not go on from the steps before: a reset, a restored snapshot, a jump of time.
  void forget_steps();
  /// Publishes one tick: every message carries `stamp`, the simulated time. Wrench topics come and go with the attachments.
  void publish(const World& world, const ros::Time& stamp);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace verlet_cable
