#include "camera/camera_info.h"

#include <sensor_msgs/distortion_models.h>

#include <algorithm>
#include <vector>

#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

bool is_distorted(const sensor_msgs::CameraInfo& info) {
  return std::any_of(info.D.begin(), info.D.end(), [](double coefficient) { return coefficient != 0; });
}

std::vector<std::string> problems_of(const sensor_msgs::CameraInfo& info) {
  std::vector<std::string> problems;
  const auto require = [&](bool is_good, const std::string& problem) {
    if (!is_good) problems.push_back(problem);
  };
  const bool is_plumb_bob = info.distortion_model == sensor_msgs::distortion_models::PLUMB_BOB;
  require(!is_distorted(info) || is_plumb_bob,
          "distortion_model: " + in_quotes(info.distortion_model) + "; allowed: plumb_bob, or D without distortion");
  require(!is_distorted(info) || !is_plumb_bob || info.D.size() == 5,
          "D: " + std::to_string(info.D.size()) + " numbers; allowed: 5 for plumb_bob");
  const auto binning = std::max(info.binning_x, info.binning_y);
  require(binning <= 1, "binning_x, binning_y: " + std::to_string(binning) + "; allowed: 0 or 1");
  const sensor_msgs::RegionOfInterest& roi = info.roi;
  require(roi.x_offset == 0 && roi.y_offset == 0 && (roi.width == 0 || roi.width == info.width) &&
              (roi.height == 0 || roi.height == info.height),
          "roi: a part of the image; allowed: all of it");
  require(info.K[1] == 0, "K[1]: " + number_text(info.K[1]) + "; allowed: 0, no skew");
  return problems;
}

}  // namespace

sensor_msgs::CameraInfo info_of(const view::CameraModel& model) {
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(model.width);
  info.height = static_cast<std::uint32_t>(model.height);
  info.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  info.D.assign(model.distortion.begin(), model.distortion.end());
  info.K = {model.fx, 0, model.cx, 0, model.fy, model.cy, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {model.fx, 0, model.cx, 0, 0, model.fy, model.cy, 0, 0, 0, 1, 0};
  return info;
}

ReceivedModel model_of(const sensor_msgs::CameraInfo& info, double near, double far) {
  ReceivedModel received;
  std::vector<std::string> problems = problems_of(info);
  view::CameraModel& model = received.model;
  // What is too large stays too large.
  const auto size = [](std::uint32_t pixels) { return static_cast<int>(std::min<std::uint32_t>(pixels, 1000000)); };
  model.width = size(info.width);
  model.height = size(info.height);
  model.fx = info.K[0];
  model.cx = info.K[2];
  model.fy = info.K[4];
  model.cy = info.K[5];
  if (is_distorted(info) && info.D.size() == model.distortion.size())
    std::copy(info.D.begin(), info.D.end(), model.distortion.begin());
  model.near = near;
  model.far = far;
  for (const std::string& line : view::validate(model)) problems.push_back(line);
  for (const std::string& line : problems) received.problem += (received.problem.empty() ? "" : "; ") + line;
  return received;
}

}  // namespace verlet_cable
