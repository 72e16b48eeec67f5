#include "publish/publishers.h"

#include "publish/body_frames.h"
#include "publish/legend_publisher.h"
#include "publish/marker_publisher.h"
#include "publish/point_publisher.h"
#include "publish/state_publisher.h"
#include "publish/surface_publisher.h"
#include "publish/wrench_publisher.h"

namespace verlet_cable {

struct Publishers::Implementation {
  Implementation(ros::NodeHandle& private_node, const SceneDesc& scene)
      : body_frames(private_node, scene),
        legend(private_node, scene),
        markers(private_node, scene),
        points(private_node, scene),
        state(private_node, scene),
        surface(private_node, scene),
        wrenches(private_node) {}

  BodyFrames body_frames;
  LegendPublisher legend;
  MarkerPublisher markers;
  PointPublisher points;
  StatePublisher state;
  SurfacePublisher surface;
  WrenchPublisher wrenches;
};

Publishers::Publishers(ros::NodeHandle& private_node, const SceneDesc& scene)
    : implementation_(std::make_unique<Implementation>(private_node, scene)) {}

Publishers::~Publishers() = default;

void Publishers::show(const SceneDesc& scene) {
  implementation_->body_frames.show(scene);
  implementation_->legend.show(scene);
  implementation_->markers.show(scene);
  implementation_->points.show(scene);
  implementation_->state.show(scene);
  implementation_->surface.show(scene);
}

void Publishers::note_step(const World& world) {
  implementation_->state.note_step(world);
  implementation_->wrenches.means().add(world);
}

void Publishers::forget_steps() {
  implementation_->state.forget_steps();
  implementation_->wrenches.means().forget();
}

void Publishers::publish(const World& world, const ros::Time& stamp) {
  implementation_->body_frames.publish(world, stamp);
  implementation_->markers.publish(world, stamp);
  implementation_->points.publish(world, stamp);
  implementation_->state.publish(world, stamp);
  implementation_->surface.publish(world, stamp);
  implementation_->wrenches.publish(world, stamp);
}

}  // namespace verlet_cable
