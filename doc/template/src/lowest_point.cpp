// Publishes the height [m] of the lowest node of the cable `~cable` on `~height`, whenever `state` comes.
#include <ros/ros.h>
#include <std_msgs/Float64.h>
#include <verlet_cable/CableArray.h>

#include <algorithm>
#include <string>

int main(int argc, char** argv) {
  ros::init(argc, argv, "lowest_point");
  ros::NodeHandle node, private_node("~");
  const auto name = private_node.param<std::string>("cable", "rope");
  ros::Publisher publisher = private_node.advertise<std_msgs::Float64>("height", 10);
  const auto lower = [](const geometry_msgs::Point& a, const geometry_msgs::Point& b) { return a.z < b.z; };
  ros::Subscriber subscriber =
      node.subscribe<verlet_cable::CableArray>("state", 10, [&](const verlet_cable::CableArray::ConstPtr& state) {
        for (const verlet_cable::Cable& cable : state->cables) {
          if (cable.name != name) continue;
          std_msgs::Float64 height;
          height.data = std::min_element(cable.positions.begin(), cable.positions.end(), lower)->z;
          publisher.publish(height);
        }
      });
  ros::spin();
}
