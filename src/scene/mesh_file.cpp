#include "mesh_file.h"

#include <dlfcn.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cfloat>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "child_process.h"
#include "mesh_protocol.h"
#include "text.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "weld.h"

namespace verlet_cable {
namespace {

namespace fs = std::filesystem;

constexpr double least_weld = 1e-6, largest_weld = 1e-3;  // of the mesh's size

/// The program beside this library, in development and install space: lib/libverlet_cable_scene.so, lib/verlet_cable/mesh_reader.
/// Where the library is part of a program, that is beside it.
std::string mesh_reader_program() {
  std::vector<fs::path> directories;
  std::error_code error;
  Dl_info library;
  if (dladdr(reinterpret_cast<const void*>(&read_mesh_file), &library) && library.dli_fname) {
    const fs::path directory = fs::absolute(library.dli_fname, error).parent_path();
    directories = {directory / "verlet_cable", directory};
  }
  directories.push_back(fs::read_symlink("/proc/self/exe", error).parent_path());
  for (const fs::path& directory : directories) {
    const fs::path program = directory / "mesh_reader";
    if (fs::is_regular_file(program, error)) return program.string();
  }
  throw ResourceError("the program mesh_reader, which reads meshes, is not in " + directories.front().string());
}

/// stl, obj or dae, by the name.
std::string format_of(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const char* format : {"stl", "obj", "dae"})
    if (extension == std::string(".") + format) return format;
  throw ResourceError("its name ends neither with .stl, .obj nor .dae");
}

[[noreturn]] void fail_ended(int status) {
  const int signal = status >= 0 && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGXCPU || signal == SIGKILL)
    throw ResourceError("it takes more than " + std::to_string(mesh_protocol::processor_time) + " s to read");
  throw ResourceError("its reader crashed" + (signal ? " (signal " + std::to_string(signal) + ")" : std::string()));
}

void read_whole(ChildProcess& reader, void* data, std::size_t size, const Patience& patience) {
  if (reader.read(data, size, patience) < size) fail_ended(reader.wait());
}

template <class Element>
std::vector<Element> read_elements(ChildProcess& reader, std::size_t count, const Patience& patience) {
  std::vector<Element> elements(count);
  read_whole(reader, elements.data(), count * sizeof(Element), patience);
  return elements;
}

struct Triangles {
  std::vector<Vector3> vertices;
  std::vector<TriangleMesh::Triangle> triangles;
};

/// In the file's units. What the other process says is not trusted: sizes and numbers are checked here; indices by TriangleMesh.
Triangles read_triangles(const std::string& path, const Patience& patience) {
  const std::string format = format_of(path);
  patience.check();
  ChildProcess reader(mesh_reader_program(), {format}, open_regular_file(path));
  char outcome;
  read_whole(reader, &outcome, 1, patience);
  if (outcome != mesh_protocol::success) {
    std::string text(mesh_protocol::longest_refusal, ' ');
    text.resize(reader.read(text.data(), text.size(), patience));
    throw ResourceError(escaped(text, longest_message));
  }
  mesh_protocol::Header header;
  read_whole(reader, &header, sizeof header, patience);
  if (header.vertices > mesh_protocol::most_vertices || header.triangles > mesh_protocol::most_triangles)
    throw ResourceError("its reader returned more vertices or triangles than are allowed");
  const auto vertices = read_elements<mesh_protocol::Vertex>(reader, header.vertices, patience);
  const auto triangles = read_elements<mesh_protocol::Triangle>(reader, header.triangles, patience);
  Triangles result;
  for (const auto& [x, y, z] : vertices) result.vertices.emplace_back(x, y, z);
  result.triangles.assign(triangles.begin(), triangles.end());
  for (const Vector3& vertex : result.vertices)
    if (!vertex.allFinite()) throw ResourceError("a vertex is not finite");
  return result;
}

std::shared_ptr<const TriangleMesh> scaled(const Triangles& mesh, const Vector3& scale) {
  std::vector<Vector3> vertices;
  for (const Vector3& vertex : mesh.vertices) {
    vertices.push_back(vertex.cwiseProduct(scale));
    const double farthest = vertices.back().cwiseAbs().maxCoeff();
    if (!(farthest <= coordinate.highest))
      throw ResourceError("a vertex has a coordinate of " + number_text(farthest) + " m, beyond " +
                          number_text(coordinate.highest) + " m");
  }
  std::vector<TriangleMesh::Triangle> triangles = mesh.triangles;
  if (scale.prod() < 0)  // a mirror image
    for (TriangleMesh::Triangle& triangle : triangles) std::swap(triangle[1], triangle[2]);
  try {
    return std::make_shared<TriangleMesh>(std::move(vertices), std::move(triangles));
  } catch (const std::invalid_argument& error) {
    throw ResourceError(error.what());
  }
}

/// How far apart two vertices may be that are one but for rounding: to single precision, in a file or on reading it, or by the
/// program that computed each triangle's corners anew.
double rounding_of(const std::vector<Vector3>& vertices) {
  Aabb box;
  for (const Vector3& vertex : vertices) box.extend(vertex);
  const double farthest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  const double size = box.sizes().maxCoeff();
  return std::clamp(4 * FLT_EPSILON * farthest, least_weld * size, largest_weld * size);
}

}  // namespace

void Patience::check() const {
  if (cancelled && *cancelled) throw ResourceError("reading it was cancelled");
  if (std::chrono::steady_clock::now() >= until) throw ResourceError("it takes too long to read");
}

std::shared_ptr<const TriangleMesh> read_mesh_file(const std::string& path, const Vector3& scale, const Patience& patience) {
  Triangles mesh = read_triangles(path, patience);
  auto as_given = scaled(mesh, scale);
  const double tolerance = as_given->is_closed() ? 0 : rounding_of(mesh.vertices);
  if (!(tolerance > 0)) return as_given;
  weld(tolerance, mesh.vertices, mesh.triangles);
  return mesh.triangles.empty() ? as_given : scaled(mesh, scale);
}

}  // namespace verlet_cable
