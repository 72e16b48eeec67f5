#include "arbitrary.h"

#include <cmath>
#include <limits>

namespace verlet_cable::fuzz {

int Arbitrary::index(std::size_t count) {
  if (count == 0 || is_odd()) return input_.ConsumeIntegral<int>() >> below(31);
  return below(static_cast<int>(count));
}

double Arbitrary::between(double low, double high) {
  constexpr double steps = std::numeric_limits<std::uint16_t>::max();
  return low + (high - low) * (input_.ConsumeIntegral<std::uint16_t>() / steps);
}

double Arbitrary::positive(double low, double high) {
  return is_odd() ? odd_number() : low * std::pow(high / low, between(0, 1));
}

double Arbitrary::odd_number() {
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  return one_of({0.0, -1.0, not_a_number, infinity, -infinity, 1e300, -1e9, 1e9, 1e-300, 1e-12, 1e12, 5e-324});
}

Vector3 Arbitrary::vector(double most) {
  if (is_odd()) return {odd_number(), odd_number(), odd_number()};
  const double x = between(-most, most), y = between(-most, most);
  return {x, y, between(-most, most)};
}

Quaternion Arbitrary::rotation() {
  if (flip()) return Quaternion::Identity();
  if (is_odd()) return {odd_number(), odd_number(), odd_number(), odd_number()};
  return quaternion_from_rpy(vector(3.2));
}

Pose Arbitrary::pose(const Vector3& near, double most_away) {
  const Vector3 away = vector(most_away);
  return {near + away, rotation()};
}

std::string Arbitrary::one_of(const std::vector<std::string>& names) {
  const int i = index(names.size());
  return i >= 0 && i < static_cast<int>(names.size()) ? names[i] : "nobody";
}

}  // namespace verlet_cable::fuzz
