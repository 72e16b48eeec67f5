#include "publish/legend_publisher.h"

namespace verlet_cable {

LegendPublisher::LegendPublisher(ros::NodeHandle& private_node, const ColorScale& colors)
    : publisher_(private_node.advertise<Legend>("legend", 1, true)) {
  show(colors);
}

void LegendPublisher::show(const ColorScale& colors) {
  publisher_.publish(colors.legend());
}

}  // namespace verlet_cable
