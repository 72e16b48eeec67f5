#include "camera/images.h"

#include <sensor_msgs/image_encodings.h>

#include "camera/pixels.h"

namespace verlet_cable {

namespace encodings = sensor_msgs::image_encodings;

Images::Images(ros::NodeHandle& node, const CameraSettings& settings, const ros::SubscriberStatusCallback& changed)
    : sensor_(settings.sensor),
      seed_(static_cast<std::uint64_t>(settings.seed)),
      depth_encoding_(settings.depth_encoding),
      depth_(node, settings.depth_encoding, changed),
      color_(node, changed),
      mask_(node, changed),
      cloud_(node, changed),
      truth_(node, changed) {}

bool Images::are_wanted() const {
  return depth_.is_wanted() || color_.is_wanted() || mask_.is_wanted() || cloud_.is_wanted() || truth_.is_wanted();
}

/// Who listens is asked once: others may come meanwhile.
void Images::publish(const Shot& shot) const {
  const bool with_depth = depth_.is_wanted(), with_color = color_.is_wanted(), with_mask = mask_.is_wanted();
  const bool with_cloud = cloud_.is_wanted();
  const int width = shot.lens.model().width, height = shot.lens.model().height;
  const auto image = [&](bool is_wanted, const std::string& encoding) {
    return is_wanted || with_cloud ? make_image(shot.header, width, height, encoding) : nullptr;
  };
  const sensor_msgs::ImagePtr depth = image(with_depth, encodings::TYPE_32FC1);
  const sensor_msgs::ImagePtr rgb = image(with_color, encodings::RGB8);
  const sensor_msgs::ImagePtr mask = image(with_mask, encodings::TYPE_16UC1);
  view::ImageBuffers buffers;
  if (depth) buffers.depth = pixels_of<float>(*depth);
  if (rgb) buffers.rgb = rgb->data.data();
  if (mask) buffers.mask = pixels_of<std::uint16_t>(*mask);
  if (depth || rgb || mask) view::render(shot.stage, shot.lens, shot.pose, sensor_, {seed_, shot.header.stamp.toNSec()}, buffers);
  if (depth && depth_encoding_ == DepthEncoding::millimetres) round_to_millimetres(*depth);
  if (with_depth) depth_.publish(depth);
  if (with_color) color_.publish(rgb);
  if (with_mask) mask_.publish(mask);
  if (with_cloud) cloud_.publish(shot.lens, *depth, *rgb, *mask);
  if (truth_.is_wanted()) truth_.publish(shot);
}

}  // namespace verlet_cable
