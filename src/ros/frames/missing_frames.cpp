#include "frames/missing_frames.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "frames/frame_watch.h"
#include "time/log_period.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

/// Whoever publishes frames may have been started together with the node, and may need so long.
const ros::WallDuration first_warning(5.0);
/// Between warnings that something waits for frames.
/// Between looks at the trees of tf.
const ros::WallDuration look_period(1.0);
/// Longer lists are cut off in messages.
constexpr std::size_t most_listed = 8;

/// In quotes, with "and" before the last; the first of many.
std::string list(const std::vector<std::string>& names) {
  const std::size_t shown = names.size() > most_listed ? most_listed : names.size();
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) {
    const bool last = i + 1 == names.size();
    text += (i == 0 ? "" : last ? " and " : ", ") + in_quotes(names[i]);
  }
  return shown < names.size() ? text + " and " + std::to_string(names.size() - shown) + " more" : text;
}

/// The frames that cables and nets wait for, each once, in the scene's order.
std::vector<std::string> missing_frames(const std::vector<WaitingAttachment>& waiting) {
  std::set<std::string> seen;
  std::vector<std::string> missing;
  for (const WaitingAttachment& attachment : waiting) {
    if (seen.insert(attachment.frame).second) missing.push_back(attachment.frame);
  }
  return missing;
}

/// Commands to be typed that put frames side by side, as far from the first to the last as a cable that hangs between them well
/// allows.
std::string commands_for(const std::vector<std::string>& missing, const SceneDesc& scene) {
  constexpr double span = 0.7;     // of the shortest cable's length
  constexpr std::size_t most = 4;  // that people read
  double shortest = infinity;
  for (const CableDesc& cable : scene.cables) shortest = std::min(shortest, cable.length);
  const double spacing = std::isfinite(shortest) && missing.size() > 1 ? span * shortest / (missing.size() - 1) : 0;
  std::string commands;
  for (std::size_t i = 0; i < std::min(missing.size(), most); ++i)
    commands += "\n  rosrun tf2_ros static_transform_publisher " + number_text(i * spacing) + " 0 1 0 0 0 " +
                escaped(scene.frame_id) + " " + escaped(missing[i]) + " &";
  return commands;
}

/// Frames that tf has, but in trees without the fixed frame: by the root of their tree.
using OtherTrees = std::map<std::string, std::vector<std::string>>;

OtherTrees other_trees(const std::vector<std::string>& names, const FrameBuffer& buffer) {
  OtherTrees trees;
  for (const std::string& name : names)
    if (const std::optional<std::string> root = buffer.other_root(name)) trees[*root].push_back(name);
  return trees;
}

std::string unconnected_words(const OtherTrees& trees, const std::string& fixed_frame) {
  std::string words;
  for (const auto& [root, names] : trees)
    words += (words.empty() ? "" : "; ") + list(names) + (names.size() > 1 ? " are" : " is") + " on tf, but not connected to " +
             in_quotes(fixed_frame) + ": set frame_id in the scene (to the root of " + (names.size() > 1 ? "their" : "its") +
             " tree: " + in_quotes(root) + "), or publish a transform between the two";
  return words;
}

}  // namespace

void MissingFrames::watch() {
  next_look_ = next_warning_ = ros::WallTime();
  unconnected_.clear();
}

void MissingFrames::report(const World& world, const TfInputs& frames) const {
  const std::vector<FrameReport> reports = frames.report();
  const std::string fixed = in_quotes(world.frames().front());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    if (reports[i].status != FrameStatus::never_seen) continue;
    const std::string frame = in_quotes(reports[i].name);
    if (frames.inputs()[i].known) {
      ROS_INFO("tf has no transform from %s to %s yet: what it holds stays at its initial_pose until there is one", fixed.c_str(),
               frame.c_str());
    } else if (has_obstacles(static_cast<int>(i), world)) {
      ROS_INFO("tf has no transform from %s to %s yet: its obstacles appear when there is one", fixed.c_str(), frame.c_str());
    }
  }
}

void MissingFrames::warn(const SceneDesc& scene, const World& world, const TfInputs& frames) {
  const ros::WallTime now = ros::WallTime::now();
  warn_of_waiting(scene, world, frames, now);
  if (now < next_look_) return;
  next_look_ = now + look_period;
  warn_of_unconnected(scene, world, frames, now);
}

void MissingFrames::warn_of_waiting(const SceneDesc& scene, const World& world, const TfInputs& frames, ros::WallTime now) {
  if (world.findings().waiting.empty()) {
    next_warning_ = ros::WallTime();
    return;
  }
  if (next_warning_.isZero()) next_warning_ = now + first_warning;
  if (now < next_warning_) return;
  next_warning_ = now + reminder_period;
  std::vector<std::string> missing = missing_frames(waiting_attachments(scene, world, frames.inputs()));
  if (missing.empty()) return;
  const OtherTrees trees = other_trees(missing, frames.buffer());
  std::string advice = list(missing);
  if (!trees.empty()) advice += ": " + unconnected_words(trees, scene.frame_id);
  // Those would get a second parent.
  missing.erase(
      std::remove_if(missing.begin(), missing.end(), [&](const auto& name) { return frames.buffer().other_root(name); }),
      missing.end());
  if (!missing.empty())
    advice += ". If nothing else is to publish them, type, with x, y, z [m] as you like:" + commands_for(missing, scene);
  ROS_WARN("not shown yet: %s, because tf has no transform from %s to %s", list(world.findings().waiting).c_str(),
           in_quotes(scene.frame_id).c_str(), advice.c_str());
}

/// Those of waiting cables and nets are left to `warn_of_waiting`.
void MissingFrames::warn_of_unconnected(const SceneDesc& scene, const World& world, const TfInputs& frames, ros::WallTime now) {
  const std::vector<std::string> awaited = missing_frames(waiting_attachments(scene, world, frames.inputs()));
  std::map<std::string, Unconnected> unconnected;
  std::vector<std::string> untold;
  for (const FrameReport& frame : frames.report()) {
    if (frame.status != FrameStatus::never_seen || !frames.buffer().other_root(frame.name)) continue;
    if (std::find(awaited.begin(), awaited.end(), frame.name) != awaited.end()) continue;
    const auto known = unconnected_.find(frame.name);
    Unconnected& entry = unconnected[frame.name] = known == unconnected_.end() ? Unconnected{now} : known->second;
    if (entry.told || now - entry.since < first_warning) continue;
    entry.told = true;
    untold.push_back(frame.name);
  }
  unconnected_ = std::move(unconnected);
  if (!untold.empty()) ROS_WARN("%s", unconnected_words(other_trees(untold, frames.buffer()), scene.frame_id).c_str());
}

std::vector<WaitingAttachment> waiting_attachments(const SceneDesc& scene, const World& world, const BoundaryInputs& inputs) {
  std::set<std::string> unknown;
  for (std::size_t i = 0; i < std::min(inputs.size(), world.frames().size()); ++i) {
    if (!inputs[i].known && !world.is_body_frame(static_cast<int>(i))) unknown.insert(world.frames()[i]);
  }
  const std::set<std::string> waiting(world.findings().waiting.begin(), world.findings().waiting.end());
  std::vector<WaitingAttachment> attachments;
  const auto add_of = [&](const auto& held) {
    for (const auto& desc : held) {
      if (waiting.count(desc.name) == 0) continue;
      for (const auto& attachment : desc.attachments) {
        if (unknown.count(attachment.frame) > 0) attachments.push_back({attachment.name, desc.name, attachment.frame});
      }
    }
  };
  add_of(scene.cables);
  add_of(scene.nets);
  add_of(scene.bodies);
  return attachments;
}

}  // namespace verlet_cable
