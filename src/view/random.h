#pragma once

#include <cmath>
#include <cstdint>

namespace verlet_cable::view {

/// Random numbers that depend on where they are used and not on how many there were before: on any number of threads they are the
/// same.
class CountedRandom {
 public:
  CountedRandom(std::uint64_t seed, std::uint64_t image) : key_(mixed(mixed(seed) + image)) {}

  /// A number in (0, 1) for the `use`-th use, of 8, in a pixel.
  double uniform(std::uint64_t pixel, unsigned use) const {
    const std::uint64_t bits = mixed(key_ ^ mixed(8 * pixel + use)) >> 11;
    return (static_cast<double>(bits) + 0.5) * 0x1p-53;
  }

 private:
  /// Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators, 2014.
  static std::uint64_t mixed(std::uint64_t bits) {
    bits += 0x9e3779b97f4a7c15;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111eb;
    return bits ^ (bits >> 31);
  }

  std::uint64_t key_;
};

/// The number below which a standard normal variable is with this probability, to seven digits (Wichura, Algorithm AS 241, 1988,
/// PPND7).
inline double normal_quantile(double probability) {
  const double q = probability - 0.5;
  if (std::abs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q * (((59.109374720 * r + 159.29113202) * r + 50.434271938) * r + 3.3871327179) /
           (((67.187563600 * r + 78.757757664) * r + 17.895169469) * r + 1);
  }
  double r = std::sqrt(-std::log(q < 0 ? probability : 1 - probability));
  double quantile;
  if (r <= 5) {
    r -= 1.6;
    quantile = (((0.17023821103 * r + 1.3067284816) * r + 2.7568153900) * r + 1.4234372777) /
               ((0.12021132975 * r + 0.73700164250) * r + 1);
  } else {
    r -= 5;
    quantile = (((0.017337203997 * r + 0.42868294337) * r + 3.0812263860) * r + 6.6579051150) /
               ((0.012258202635 * r + 0.24197894225) * r + 1);
  }
  return q < 0 ? -quantile : quantile;
}

}  // namespace verlet_cable::view
