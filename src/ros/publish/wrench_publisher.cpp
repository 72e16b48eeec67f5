#include "publish/wrench_publisher.h"

#include <geometry_msgs/WrenchStamped.h>

#include <chrono>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "publish/conversions.h"
#include "publish/queue_size.h"

namespace verlet_cable {
namespace {

/// Each topic is registered with the master by a call: those of a large scene come with the next ticks.
constexpr std::size_t most_at_once = 50;
/// For others that wait for the topics.
const ros::WallDuration between_calls(0.001);

}  // namespace

WrenchPublisher::WrenchPublisher(ros::NodeHandle& private_node) : node_(private_node, "wrench") {}

void WrenchPublisher::follow_attachments(const World& world) {
  if (new_topics_.valid()) {
    if (new_topics_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    topics_.merge(new_topics_.get());
  }
  std::unordered_set<std::string_view> names;
  for (const Attachment& attachment : world.attachments())
    if (is_named(attachment)) names.insert(attachment.name);
  Topics gone;
  for (auto topic = topics_.begin(); topic != topics_.end() && gone.size() < most_at_once;) {
    const auto next = std::next(topic);
    if (names.count(topic->first) == 0) gone.insert(topics_.extract(topic));
    topic = next;
  }
  std::vector<std::string> missing;
  for (const Attachment& attachment : world.attachments()) {
    if (missing.size() >= most_at_once) break;
    if (is_named(attachment) && topics_.count(attachment.name) == 0) missing.push_back(attachment.name);
  }
  if (gone.empty() && missing.empty()) return;
  new_topics_ = std::async(std::launch::async, [node = node_, gone = std::move(gone), missing = std::move(missing)]() mutable {
    // Each locks all topics as long as the master takes.
    for (; !gone.empty(); gone.erase(gone.begin())) between_calls.sleep();
    Topics topics;
    for (const std::string& name : missing)
      topics[name] = node.advertise<geometry_msgs::WrenchStamped>(name, publisher_queue_size);
    return topics;
  });
}

void WrenchPublisher::publish(const World& world, const ros::Time& stamp) {
  follow_attachments(world);
  for (const Attachment& attachment : world.attachments()) {
    if (!is_named(attachment)) continue;
    const auto topic = topics_.find(attachment.name);
    if (topic == topics_.end() || topic->second.getNumSubscribers() == 0) continue;
    // What holds a body is there before the frame that it holds it to.
    if (!world.frame_known(attachment.frame)) continue;
    const Attachment mean = means_.mean(attachment);
    if (!mean.force.allFinite() || !mean.torque.allFinite()) continue;
    const auto message = boost::make_shared<geometry_msgs::WrenchStamped>();
    message->header.stamp = stamp;
    message->header.frame_id = world.frames()[attachment.frame];
    message->wrench = wrench_on_frame(mean, world.frame_pose(attachment.frame));
    topic->second.publish(message);
  }
  means_.end_tick();
}

}  // namespace verlet_cable
