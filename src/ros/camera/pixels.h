#pragma once

#include <sensor_msgs/Image.h>

#include <cstring>
#include <string>

namespace verlet_cable {

/// An image without its pixels' values.
sensor_msgs::ImagePtr make_image(const std_msgs::Header& header, int width, int height, const std::string& encoding);

/// The value of a pixel of one channel, counted row by row.
template <class Value>
Value pixel_of(const sensor_msgs::Image& image, std::size_t pixel) {
  Value value;
  std::memcpy(&value, &image.data[pixel * sizeof(Value)], sizeof(Value));
  return value;
}

/// Where a renderer writes the pixels.
template <class Value>
Value* pixels_of(sensor_msgs::Image& image) {
  return reinterpret_cast<Value*>(image.data.data());  // as large as operator new aligns, for any number
}

/// Rounds depths [m] to whole mm; none where 16 bits do not hold them.
void round_to_millimetres(sensor_msgs::Image& depth);
/// An image 16UC1 of one in m that is rounded: 0 where there is none.
sensor_msgs::ImagePtr in_millimetres(const sensor_msgs::Image& depth);

}  // namespace verlet_cable
