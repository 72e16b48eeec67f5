#include "camera/pixels.h"

#include <sensor_msgs/image_encodings.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

namespace verlet_cable {
namespace {

constexpr double millimetres_per_metre = 1000;

bool is_big_endian() {
  const std::uint16_t one = 1;
  std::uint8_t first = 0;
  std::memcpy(&first, &one, 1);
  return first == 0;
}

}  // namespace

sensor_msgs::ImagePtr make_image(const std_msgs::Header& header, int width, int height, const std::string& encoding) {
  namespace encodings = sensor_msgs::image_encodings;
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->header = header;
  image->width = static_cast<std::uint32_t>(width);
  image->height = static_cast<std::uint32_t>(height);
  image->encoding = encoding;
  image->is_bigendian = is_big_endian();
  image->step = image->width * static_cast<std::uint32_t>(encodings::numChannels(encoding) * encodings::bitDepth(encoding) / 8);
  image->data.resize(std::size_t{image->step} * image->height);
  return image;
}

void round_to_millimetres(sensor_msgs::Image& depth) {
  float* const pixels = pixels_of<float>(depth);
  const std::size_t count = std::size_t{depth.width} * depth.height;
  for (std::size_t i = 0; i < count; ++i) {
    const double rounded = std::round(millimetres_per_metre * pixels[i]);
    const bool fits = rounded >= 1 && rounded <= std::numeric_limits<std::uint16_t>::max();
    pixels[i] = fits ? static_cast<float>(rounded / millimetres_per_metre) : std::numeric_limits<float>::quiet_NaN();
  }
}

sensor_msgs::ImagePtr in_millimetres(const sensor_msgs::Image& depth) {
  const int width = static_cast<int>(depth.width), height = static_cast<int>(depth.height);
  const auto image = make_image(depth.header, width, height, sensor_msgs::image_encodings::TYPE_16UC1);
  std::uint16_t* const pixels = pixels_of<std::uint16_t>(*image);
  const std::size_t count = std::size_t{depth.width} * depth.height;
  for (std::size_t i = 0; i < count; ++i) {
    const double metres = pixel_of<float>(depth, i);
    pixels[i] = std::isnan(metres) ? 0 : static_cast<std::uint16_t>(std::lround(millimetres_per_metre * metres));
  }
  return image;
}

}  // namespace verlet_cable
