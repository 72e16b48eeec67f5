#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace verlet_cable {

/// What `mesh_reader FORMAT`, FORMAT being stl, obj or dae, makes of the file on its standard input, on its standard output:
/// either `refusal` and why, as text; or `success`, a header, the vertices and the triangles. The byte order is this machine's.
namespace mesh_protocol {

constexpr char refusal = 'E';
constexpr char success = 'M';

struct Header {
  std::uint64_t vertices;
  std::uint64_t triangles;
};
using Vertex = std::array<float, 3>;
using Triangle = std::array<std::int32_t, 3>;  ///< indices of vertices

constexpr std::size_t most_triangles = 1'000'000;
constexpr std::size_t most_vertices = 3 * most_triangles;
constexpr std::size_t largest_file = std::size_t{64} << 20;
constexpr std::size_t longest_refusal = 300;

// Limits of the process.
constexpr std::size_t memory = std::size_t{1} << 30;  ///< [byte]
constexpr unsigned processor_time = 15;               ///< [s]

}  // namespace mesh_protocol
}  // namespace verlet_cable
