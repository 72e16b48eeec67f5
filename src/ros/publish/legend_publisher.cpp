#include "publish/legend_publisher.h"

#include "publish/color.h"

namespace verlet_cable {

LegendPublisher::LegendPublisher(ros::NodeHandle& private_node, const SceneDesc& scene)
    : publisher_(private_node.advertise<Legend>("legend", 1, true)) {
  show(scene);
}

void LegendPublisher::show(const SceneDesc& scene) {
  publisher_.publish(ColorScale(scene).legend());
}

}  // namespace verlet_cable
