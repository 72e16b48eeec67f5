#include "publish/wrench_topics.h"

#include <geometry_msgs/WrenchStamped.h>

#include <chrono>
#include <iterator>
#include <unordered_set>
#include <utility>

#include "publish/queue_size.h"

namespace verlet_cable {
namespace {

/// Each topic is registered with the master by a call: those of a large scene come with the next ticks.
constexpr std::size_t most_at_once = 50;
/// For others that wait for the topics.
const ros::WallDuration between_calls(0.001);

bool is_allowed(const std::string& name) {
  std::string error;
  return ros::names::validate("a/" + name, error);
}

}  // namespace

void WrenchTopics::follow(const std::vector<std::string_view>& names) {
  if (new_topics_.valid()) {
    if (new_topics_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    topics_.merge(new_topics_.get());
  }
  const std::unordered_set<std::string_view> present(names.begin(), names.end());
  Topics gone;
  for (auto topic = topics_.begin(); topic != topics_.end() && gone.size() < most_at_once;) {
    const auto next = std::next(topic);
    if (present.count(topic->first) == 0) gone.insert(topics_.extract(topic));
    topic = next;
  }
  std::vector<std::string> missing;
  for (const std::string_view name : names) {
    if (missing.size() >= most_at_once) break;
    if (const std::string text(name); topics_.count(text) == 0 && is_allowed(text)) missing.push_back(text);
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

const ros::Publisher* WrenchTopics::listened(const std::string& name) const {
  const auto topic = topics_.find(name);
  return topic == topics_.end() || topic->second.getNumSubscribers() == 0 ? nullptr : &topic->second;
}

}  // namespace verlet_cable
