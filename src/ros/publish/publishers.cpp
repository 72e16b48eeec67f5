#include "publish/publishers.h"

#include <optional>
#include <string>

#include "publish/appearance_publisher.h"
#include "publish/body_frames.h"
#include "publish/color.h"
#include "publish/contact_publisher.h"
#include "publish/drawing_frame.h"
#include "publish/legend_publisher.h"
#include "publish/marker_publisher.h"
#include "publish/origin_frame.h"
#include "publish/point_publisher.h"
#include "publish/state_publisher.h"
#include "publish/surface_publisher.h"
#include "publish/wrench_publisher.h"

namespace verlet_cable {

struct Publishers::Implementation {
  Implementation(ros::NodeHandle& private_node, const SceneDesc& scene)
      : node(private_node.getNamespace()),
        frame(scene, node),
        body_frames(private_node, scene),
        colors(scene),
        legend(private_node, colors),
        markers(private_node, scene, frame),
        points(private_node, scene, frame),
        appearance(private_node, scene),
        state(private_node, scene),
        surface(private_node, scene, frame),
        wrenches(private_node),
        contacts(private_node) {
    origin_frame.send(frame, scene.frame_id);
  }

  void warn_where_coarse(const World& world) {
    if (is_coarse) return;
    const std::optional<std::string> warning = coarse_drawing(world, frame);
    if (warning) ROS_WARN("%s", warning->c_str());
    is_coarse = warning.has_value();
  }

  void follow_colors(const World& world, const ros::Time& stamp) {
    // ROS's durations are no longer than 68 years, its times are.
    if (colors.follow(world, stamp.toSec() - colored.toSec())) legend.show(colors);
    colored = stamp;
  }

  std::string node;
  DrawingFrame frame;
  bool is_coarse = false;  // which has been said
  OriginFrame origin_frame;
  BodyFrames body_frames;
  ColorScale colors;
  ros::Time colored;  ///< the last tick
  LegendPublisher legend;
  MarkerPublisher markers;
  PointPublisher points;
  AppearancePublisher appearance;
  StatePublisher state;
  SurfacePublisher surface;
  WrenchPublisher wrenches;
  ContactPublisher contacts;
};

Publishers::Publishers(ros::NodeHandle& private_node, const SceneDesc& scene)
    : implementation_(std::make_unique<Implementation>(private_node, scene)) {}

Publishers::~Publishers() = default;

void Publishers::show(const SceneDesc& scene) {
  const DrawingFrame& frame = implementation_->frame = DrawingFrame(scene, implementation_->node);
  implementation_->origin_frame.send(frame, scene.frame_id);
  implementation_->body_frames.show(scene);
  implementation_->colors = ColorScale(scene);
  implementation_->legend.show(implementation_->colors);
  implementation_->markers.show(scene, frame);
  implementation_->points.show(scene, frame);
  implementation_->appearance.show(scene);
  implementation_->state.show(scene);
  implementation_->surface.show(scene, frame);
}

void Publishers::note_step(const World& world) {
  implementation_->state.note_step(world);
  implementation_->wrenches.means().add(world);
  implementation_->contacts.note_step(world);
}

void Publishers::forget_steps() {
  implementation_->state.forget_steps();
  implementation_->wrenches.means().forget();
  implementation_->contacts.forget_steps();
}

void Publishers::publish(const World& world, const ros::Time& stamp) {
  implementation_->warn_where_coarse(world);
  implementation_->body_frames.publish(world, stamp);
  implementation_->follow_colors(world, stamp);
  const ColorScale& colors = implementation_->colors;
  implementation_->markers.publish(world, colors, stamp);
  implementation_->points.publish(world, colors, stamp);
  implementation_->appearance.publish(world, stamp);
  implementation_->state.publish(world, stamp);
  implementation_->surface.publish(world, colors, stamp);
  implementation_->wrenches.publish(world, stamp);
  implementation_->contacts.publish(world, stamp);
}

}  // namespace verlet_cable
