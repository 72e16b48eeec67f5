#pragma once

#include <cmath>
#include <cstdint>

namespace verlet_cable::view {
// Without linkage: what is compiled for one processor is not to be used for another.
namespace {

/// Random numbers depend on where they are used and not on how many there were before: on any number of threads they are the
/// same.

constexpr std::uint64_t for_noise = 0, for_edges = 1;  // uses of random numbers in a pixel, of 8

/// Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators, 2014.
[[gnu::always_inline]] inline std::uint64_t mixed(std::uint64_t bits) {
  bits += 0x9e3779b97f4a7c15;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111eb;
  return bits ^ (bits >> 31);
}

[[gnu::always_inline]] inline std::uint64_t random_key(std::uint64_t seed, std::uint64_t image) {
  return mixed(mixed(seed) + image);
}

/// 53 bits for the `use`-th use in a pixel.
[[gnu::always_inline]] inline std::uint64_t random_bits(std::uint64_t key, std::uint64_t pixel, std::uint64_t use) {
  return mixed(key ^ mixed(8 * pixel + use)) >> 11;
}

/// A number in (0, 1) of 53 bits.
[[gnu::always_inline]] inline double uniform_of_bits(std::int64_t bits) {
  return (static_cast<double>(bits) + 0.5) * 0x1p-53;
}

/// The number below which a standard normal variable is with a probability, to seven digits (Wichura, Algorithm AS 241, 1988,
/// PPND7): where that is no further than this from 1/2, and further out.
constexpr double half_of_middle = 0.425;

[[gnu::always_inline]] inline double middle_quantile(double probability) {
  const double q = probability - 0.5, r = half_of_middle * half_of_middle - q * q;
  return q * (((59.109374720 * r + 159.29113202) * r + 50.434271938) * r + 3.3871327179) /
         (((67.187563600 * r + 78.757757664) * r + 17.895169469) * r + 1);
}

inline double outer_quantile(double probability) {
  const bool is_low = probability < 0.5;
  double r = std::sqrt(-std::log(is_low ? probability : 1 - probability));
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
  return is_low ? -quantile : quantile;
}

}  // namespace
}  // namespace verlet_cable::view
