#include "publish/contact_publisher.h"

#include <geometry_msgs/WrenchStamped.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "publish/conversions.h"

namespace verlet_cable {

ContactPublisher::ContactPublisher(ros::NodeHandle& private_node) : topics_(ros::NodeHandle(private_node, "contact")) {}

void ContactPublisher::note_step(const World& world) {
  if (std::exchange(shown_, false))
    for (Sum& sum : sums_) sum = {std::move(sum.name)};
  for (Sum& sum : sums_) {
    const ContactWrench wrench = world.contact_wrench(sum.name);
    sum.force += wrench.force;
    sum.torque += wrench.torque;
    ++sum.steps;
  }
}

void ContactPublisher::publish(const World& world, const ros::Time& stamp) {
  const std::vector<std::string> names = solid_names(world);
  topics_.follow({names.begin(), names.end()});
  std::vector<Sum> listened;
  for (const std::string& name : names) {
    const ros::Publisher* const topic = topics_.listened(name);
    if (topic == nullptr) continue;
    const auto known = std::find_if(sums_.begin(), sums_.end(), [&](const Sum& sum) { return sum.name == name; });
    listened.push_back(known != sums_.end() ? *known : Sum{name});
    const ContactWrench last = world.contact_wrench(name);
    if (!world.frame_known(last.frame)) continue;
    const Sum& sum = listened.back();
    const Vector3 force = sum.steps > 0 ? Vector3(sum.force / sum.steps) : last.force;
    const Vector3 torque = sum.steps > 0 ? Vector3(sum.torque / sum.steps) : last.torque;
    if (!force.allFinite() || !torque.allFinite()) continue;
    const Quaternion into_frame = world.frame_pose(last.frame).orientation.conjugate();
    const auto message = boost::make_shared<geometry_msgs::WrenchStamped>();
    message->header.stamp = stamp;
    message->header.frame_id = world.frames()[last.frame];
    message->wrench.force = to_vector(into_frame * force);
    message->wrench.torque = to_vector(into_frame * torque);
    topic->publish(message);
  }
  sums_ = std::move(listened);
  shown_ = true;
}

}  // namespace verlet_cable
