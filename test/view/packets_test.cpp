#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "closed_forms.h"
#include "packets/passes.h"
#include "random.h"

namespace verlet_cable::view {
namespace {

/// Those that this machine can run.
std::vector<const PacketPasses*> all_passes() {
  std::vector<const PacketPasses*> all{&passes_of_2()};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) all.push_back(&passes_of_4());
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) all.push_back(&passes_of_8());
#endif
  return all;
}

/// Numbers of a test, some of them such that rays just meet, just miss, or begin inside.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : random_(seed) {}

  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Lanes lanes(double low, double high) {
    Lanes lanes;
    for (double& value : lanes.values) value = (*this)(low, high);
    return lanes;
  }
  VectorLanes vectors(double low, double high) { return {lanes(low, high), lanes(low, high), lanes(low, high)}; }

 private:
  std::mt19937 random_;
};

template <class Value>
void add_bytes(const Value& value, std::vector<unsigned char>& bytes) {
  const auto* first = reinterpret_cast<const unsigned char*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof(value));
}

/// Whatever `passes` make of some numbers.
std::vector<unsigned char> bytes_of(const PacketPasses& passes, unsigned seed) {
  Numbers numbers(seed);
  std::vector<unsigned char> bytes;
  const double axes[]{0.6, 0.8, 0, -0.8, 0.6, 0, 0, 0, 1}, start[]{0.1, -0.2, 0.3}, aim[]{-0.4, -0.6, 0.9};
  VectorLanes direction;
  passes.turn(axes, numbers.lanes(-0.5, 0.5), numbers.lanes(-0.5, 0.5), direction);
  add_bytes(direction, bytes);
  Lanes highest = numbers.lanes(1, 3), nearest = numbers.lanes(-1, -1);
  passes.meet_plane({{0.1, 0.2, -0.97}, -1.5}, 3, direction, highest, nearest);
  add_bytes(highest, bytes);
  add_bytes(nearest, bytes);
  alignas(64) RTCRayHit16 query = {};
  passes.ask(start, direction, highest, query);
  add_bytes(query, bytes);
  const Vector3 shift(numbers(-0.1, 0.1), numbers(-0.1, 0.1), numbers(-0.9, -0.7));
  const LineNumbers line = RoundLine({0, 0, 0}, {numbers(-0.3, 0.3), 0.1, 0.05}, numbers(0.01, 0.3)).numbers();
  alignas(64) double t[rays] = {};
  add_bytes(passes.meet_line(line, shift.data(), reinterpret_cast<RTCRayN*>(&query.ray), rays, t), bytes);
  add_bytes(t, bytes);
  Lanes found, cosine, second;
  VectorLanes normal;
  const Lanes about = numbers.lanes(0.5, 2);
  const std::int64_t of_ray[rays]{0, 0, 0, 1, -1, 0, 0, 0, 1, 0, 0, 0, -1, 0, 0, 0};
  const Viewers viewers{of_ray, 0};
  found = cosine = second = about;
  normal = numbers.vectors(-1, 1);
  passes.meet_flat({{0.1, 0.2, -0.97}, -1.5}, viewers, direction, numbers.lanes(1.3, 1.9), found, normal);
  add_bytes(found, bytes);
  add_bytes(normal, bytes);
  LineLanes lines{numbers.vectors(-0.3, 1), numbers.vectors(-0.5, 0.5), numbers.lanes(0.01, 0.8)};
  lines.radius[3] = 0;
  passes.meet_round(lines, direction, about, found, normal);
  add_bytes(found, bytes);
  add_bytes(normal, bytes);
  passes.find_cosines(direction, normal, cosine);
  add_bytes(cosine, bytes);
  alignas(64) RTCRay16 hidden = {};
  for (const bool is_place : {false, true}) {
    passes.ask_hidden(start, aim, is_place, 2e-5, 1e-5, direction, found, normal, hidden);
    add_bytes(hidden, bytes);
  }
  passes.find_checks({{0.6, 0.8, 0}, {-0.8, 0.6, 0}, 0.2, 0.1, 0.1, 0.002}, viewers, direction, found, cosine, second);
  add_bytes(second, bytes);
  int steps[3 * rays] = {};
  passes.find_light({{-0.36, -0.53, 0.77}, 0.4}, {{0.2, 0.5, 0.8}, {0.9, 0.1, 0.4}, 0.3}, viewers, second, numbers.lanes(0, 1),
                    direction, normal, steps);
  add_bytes(steps, bytes);
  constexpr int count = 101;
  std::vector<float> depth(count), seen(count), measured(count), points(3 * count);
  std::vector<double> sights(2 * count);
  for (float& value : depth) value = static_cast<float>(numbers(0.1, 4));
  for (float& value : seen) value = static_cast<float>(numbers(-0.1, 1));
  for (double& value : sights) value = numbers(-0.5, 0.5);
  for (const double step : {0.0, 0.125}) {
    const SensorNumbers sensor{{0.001, 0, 0.002}, 0.3, 3.5, 0.17, 30, step, random_key(seed, 2), 1234};
    passes.measure(sensor, depth.data(), seen.data(), count, measured.data());
    for (const float value : measured) add_bytes(value, bytes);
  }
  passes.find_points(sights.data(), depth.data(), count, points.data());
  for (const float value : points) add_bytes(value, bytes);
  return bytes;
}

TEST(Packets, AllWidthsOfVectorsGiveTheSameBytes) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const std::vector<unsigned char> expected = bytes_of(passes_of_2(), seed);
    for (const PacketPasses* passes : all_passes()) EXPECT_EQ(bytes_of(*passes, seed), expected) << seed;
  }
}

/// Rays of single precision, in packets of each size, meet a line where a ray alone does; those from the inside, or along it, are
/// left to that.
TEST(Packets, LinesAreMetByManyRaysAsByOne) {
  int met = 0, missed = 0, inside = 0;
  for (unsigned seed = 1; seed <= 500; ++seed) {
    Numbers numbers(seed);
    const Vector3 start(numbers(-0.2, 0.2), numbers(-0.2, 0.2), numbers(0.2, 1)), origin(100, -200, 300);
    const Vector3 end =
        seed % 5 == 0 ? start : Vector3(start + Vector3(numbers(-0.3, 0.3), numbers(-0.3, 0.3), numbers(-0.3, 0.3)));
    const RoundLine line(origin + start, origin + end, numbers(0.01, 0.3));
    for (const unsigned count : {4u, 8u, 16u}) {
      std::vector<float> asked(12 * count);
      auto* const query = reinterpret_cast<RTCRayN*>(asked.data());
      for (unsigned i = 0; i < count; ++i) {
        RTCRayN_dir_x(query, count, i) = static_cast<float>(numbers(-0.3, 0.3));
        RTCRayN_dir_y(query, count, i) = static_cast<float>(numbers(-0.3, 0.3));
        RTCRayN_dir_z(query, count, i) = 1;
      }
      for (const PacketPasses* passes : all_passes()) {
        double t[rays];
        const Vector3 shift = origin - line.start();
        const bool any = passes->meet_line(line.numbers(), shift.data(), query, count, t);
        for (unsigned i = 0; i < count; ++i) {
          const Vector3 direction(RTCRayN_dir_x(query, count, i), RTCRayN_dir_y(query, count, i), 1);
          const auto first = line.first({origin, direction}, 0);
          if (any && t[i] == from_inside) {
            ++inside;
          } else if (any && t[i] < never) {
            ASSERT_TRUE(first);
            EXPECT_NEAR(t[i], *first, 1e-12);
            ++met;
          } else {
            EXPECT_FALSE(first) << *first;
            ++missed;
          }
        }
      }
    }
  }
  EXPECT_GT(met, 1000);
  EXPECT_GT(missed, 1000);
  EXPECT_GT(inside, 100);
}

}  // namespace
}  // namespace verlet_cable::view
