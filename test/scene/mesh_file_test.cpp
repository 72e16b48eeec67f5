#include "scene/mesh_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "../support/meshes.h"
#include "scene/mesh_cache.h"
#include "scene_text.h"

namespace verlet_cable {
namespace {

namespace fs = std::filesystem;
using test::replaced;

const Vector3 unscaled(1, 1, 1);

std::string obj_of(const Triangles& mesh) {
  std::ostringstream text;
  text.precision(17);
  for (const Vector3& v : mesh.vertices) text << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const auto& [a, b, c] : mesh.triangles) text << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  return text.str();
}

std::string binary_stl_of(const Triangles& mesh, std::uint32_t count) {
  std::string bytes(80, '\0');
  const auto append = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  append(count);
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) append(0.0f);
    for (const int corner : triangle)
      for (int i = 0; i < 3; ++i) append(static_cast<float>(mesh.vertices[corner][i]));
    append(std::uint16_t{0});
  }
  return bytes;
}

/// Each triangle with corners of its own, moved by up to `rounding`: what a program writes that computes each corner anew.
Triangles torn(const Triangles& mesh, double rounding) {
  Triangles result;
  for (const auto& triangle : mesh.triangles) {
    const int first = static_cast<int>(result.vertices.size());
    for (int i = 0; i < 3; ++i)
      result.vertices.push_back(mesh.vertices[triangle[i]] + rounding * Vector3(i - 1, first % 2, i % 2));
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

Triangles moved(Triangles mesh, const Vector3& by) {
  for (Vector3& vertex : mesh.vertices) vertex += by;
  return mesh;
}

const std::string collada = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_geometries><geometry id="box"><mesh>
<source id="p"><float_array id="a" count="24">0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1</float_array>
<technique_common><accessor source="#a" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 1 2 3 4 5 6 5 7 6 0 1 4 1 5 4 2 6 3 3 6 7 0 4 2 2 4 6 1 3 5 3 7 5</p></triangles>
</mesh></geometry></library_geometries><library_nodes/>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#box"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";

std::string repeated(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

/// Twice as much for each of its levels.
std::string doubling_collada() {
  std::string nodes;
  for (int i = 0; i < 40; ++i) {
    const std::string next = "<instance_node url=\"#n" + std::to_string(i + 1) + "\"/>";
    nodes += "<node id=\"n" + std::to_string(i) + "\">" + next + next + "</node>";
  }
  nodes += "<node id=\"n40\"><instance_geometry url=\"#box\"/></node>";
  return replaced(replaced(collada, "<library_nodes/>", "<library_nodes>" + nodes + "</library_nodes>"),
                  "<node><instance_geometry url=\"#box\"/></node>", "<node><instance_node url=\"#n0\"/></node>");
}

class MeshFile : public testing::Test {
 protected:
  MeshFile() {
    std::string pattern = testing::TempDir() + "meshes_XXXXXX";
    directory_ = mkdtemp(pattern.data());
  }
  ~MeshFile() override { fs::remove_all(directory_); }

  std::string path(const std::string& name) const { return directory_ + "/" + name; }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }
  std::shared_ptr<const TriangleMesh> read(const std::string& name, const std::string& content) const {
    return read_mesh_file(write(name, content), unscaled);
  }
  /// Why a file is refused, empty if it is not.
  std::string problem_of(const std::string& file, const Patience& patience = {}) const {
    try {
      read_mesh_file(file, unscaled, patience);
    } catch (const ResourceError& error) {
      return error.what();
    }
    return "";
  }
  void expect_refused(const std::string& name, const std::string& content, const std::string& problem) const {
    const std::string found = problem_of(write(name, content));
    EXPECT_EQ(found.rfind(problem, 0), 0u) << name << ": " << found;
  }

  std::string directory_;
};

TEST_F(MeshFile, formatsAreStlObjAndDae) {
  const Triangles box = box_triangles({1, 1, 1});
  for (const auto& mesh : {read("a.stl", binary_stl_of(box, 12)), read("b.STL", binary_stl_of(box, 12)),
                           read("a.obj", obj_of(box)), read("a.dae", collada)}) {
    EXPECT_EQ(mesh->vertices().size(), 8u);
    EXPECT_EQ(mesh->triangles().size(), 12u);
    EXPECT_EQ(mesh->bounds().sizes(), Vector3(1, 1, 1));
  }
  for (const char* name : {"a.x3d", "a.ply", "a.gltf", "a.zae", "a", "stl"})
    expect_refused(name, collada, "its name ends neither with .stl, .obj nor .dae");
}

TEST_F(MeshFile, nodesOfColladaPlaceTheirMeshes) {
  const auto placed = [&](const std::string& place) { return read("placed.dae", replaced(collada, "<node>", "<node>" + place)); };
  // Also by millimetres and by less than a hundredth of a radian. Coordinates are read in single precision.
  for (const double shift : {1e-4, 0.003, 0.3}) {
    const auto mesh = placed("<translate>0 " + std::to_string(shift) + " 0</translate>");
    EXPECT_NEAR(mesh->bounds().min().y(), shift, 1e-7);
    EXPECT_NEAR(mesh->bounds().max().y(), 1 + shift, 1e-7);
  }
  EXPECT_NEAR(placed("<rotate>0 0 1 0.5</rotate>")->bounds().min().x(), -std::sin(M_PI / 360), 1e-7);
  // By the nodes above it, too. A mirror image is not turned inside out.
  const std::string instance = "<node><instance_geometry url=\"#box\"/></node>";
  const auto mirrored =
      read("mirrored.dae", replaced(collada, instance, "<node><scale>-1 1.005 1</scale>" + instance + "</node>"));
  EXPECT_NEAR(mirrored->bounds().min().x(), -1, 1e-7);
  EXPECT_NEAR(mirrored->bounds().max().y(), 1.005, 1e-7);
  EXPECT_LT(mirrored->closest_point(Vector3(-0.5, 0.5, 0.5)).distance, 0);
}

TEST_F(MeshFile, verticesThatDifferByRoundingAreOne) {
  const Triangles box = moved(box_triangles({1, 1, 1}), {0.5, 0.5, 0.5});
  EXPECT_EQ(read("zero.obj", obj_of(torn(box, 1e-17)))->vertices().size(), 8u);
  EXPECT_EQ(read("single.obj", obj_of(torn(box, 6e-8)))->vertices().size(), 8u);
  // Tiny and huge alike, and far from the file's origin.
  for (const double size : {1e-6, 1e6}) {
    const Triangles other = box_triangles(Vector3::Constant(size));
    EXPECT_EQ(read("scaled.obj", obj_of(torn(other, 6e-8 * size)))->vertices().size(), 8u) << size;
  }
  EXPECT_EQ(read("far.obj", obj_of(torn(moved(box, {100, 0, 0}), 4e-6)))->vertices().size(), 8u);
  const Triangles small = box_triangles(Vector3::Constant(0.4));
  EXPECT_EQ(read("jitter.obj", obj_of(torn(small, 1.5e-7)))->vertices().size(), 8u);
  // What is further apart is no rounding: of 36 corners those that are torn the same way are one.
  EXPECT_EQ(read("gap.obj", obj_of(torn(box, 1e-5)))->vertices().size(), 30u);
}

TEST_F(MeshFile, trianglesThatEndAsLinesAreLeftOut) {
  // A side of the box cut at a point that is a corner but for rounding.
  Triangles box = box_triangles({1, 1, 1});
  const auto [a, b, c] = box.triangles.back();
  box.triangles.pop_back();
  const int near_a = static_cast<int>(box.vertices.size());
  box.vertices.push_back(box.vertices[a] + Vector3(6e-8, 0, 0));
  box.triangles.push_back({near_a, b, c});
  box.triangles.push_back({a, near_a, c});
  const auto mesh = read("sliver.obj", obj_of(box));
  EXPECT_EQ(mesh->vertices().size(), 8u);
  EXPECT_EQ(mesh->triangles().size(), 12u);
}

TEST_F(MeshFile, whatIsClosedIsNotWelded) {
  EXPECT_EQ(read("tiny.obj", obj_of(torus_triangles(3e-9, 1e-9, 12, 8)))->vertices().size(), 96u);
  // Beside something much larger.
  Triangles both = box_triangles({1, 1, 1});
  const Triangles crumb = moved(box_triangles(Vector3::Constant(2e-7)), {0.7, 0, 0});
  for (const auto& [a, b, c] : crumb.triangles) both.triangles.push_back({a + 8, b + 8, c + 8});
  both.vertices.insert(both.vertices.end(), crumb.vertices.begin(), crumb.vertices.end());
  EXPECT_EQ(read("crumb.obj", obj_of(both))->vertices().size(), 16u);
}

TEST_F(MeshFile, badFilesAreRefusedByName) {
  const Triangles box = box_triangles({1, 1, 1});
  expect_refused("indices.dae", replaced(collada, ">0 2 1 1", ">0 2 1U 1"), "no mesh: <p> at byte ");
  expect_refused("hidden.dae", replaced(collada, ">0 2 1 1", "><!-- -->0 2 x 1"), "no mesh: <p> at byte ");
  expect_refused("count.dae", replaced(collada, "count=\"24\"", "count = '4000000000'"), "no mesh: count 4000000000 at byte ");
  for (const auto& [was, is] : {std::pair("count=\"24\"", "size=\"24\""),
                                {"count=\"24\"", "count=\"23\""},
                                {"count=\"8\"", "count=\"9\""},
                                {"stride=\"3\"", "stride=\"4\""},
                                {"stride=\"3\"", "stride=\"3\" offset='1'"},
                                {"stride=\"3\"", "offset = \"22\""},
                                {"stride=\"3\"", "stride=\"-3\""},
                                {"count=\"24\">", "count=\"24\">0</float_array><float_array id=\"a\" count=\"1\">"}})
    expect_refused("accessor.dae", replaced(collada, was, is), "no mesh: <accessor> at byte ");
  expect_refused("doubling.dae", doubling_collada(), "it takes ");  // more than 1 GB or 15 s, or on a busy machine too long
  const std::string circle = "<library_nodes><node id=\"n\"><instance_node url=\"#n\"/></node></library_nodes>";
  expect_refused("circle.dae",
                 replaced(replaced(collada, "<library_nodes/>", circle), "<instance_geometry url=\"#box\"/></node>",
                          "<instance_node url=\"#n\"/></node>"),
                 "its reader crashed (signal 11)");
  expect_refused("deep.dae",
                 replaced(replaced(collada, "<node>", repeated("<node>", 20000)), "</node></visual",
                          repeated("</node>", 20000) + "</visual"),
                 "its elements are nested 20004 levels deep, more than 256");
  expect_refused("scene.dae", "<X3D>" + repeated("<Transform>", 20000), "no mesh: a .dae without an element COLLADA");
  expect_refused("cut_off.dae", collada.substr(0, 600), "no mesh: ");
  std::string face = "f";
  for (int i = 1; i <= 200'000; ++i) face += ' ' + std::to_string(i);
  expect_refused("face.obj", repeated("v 0 1 2\n", 200'000) + face + "\n", "a face has 200000 corners, more than 4096");
  expect_refused("nan.obj", "v nan 0 0\n" + obj_of(box) + "f 1 2 3\n", "a vertex is not finite");
  expect_refused("far.obj", "v 1e300 0 0\n" + obj_of(box) + "f 1 2 3\n", "a vertex is not finite");
  expect_refused("beyond.obj", obj_of(moved(box, {1e20, 0, 0})), "a vertex has a coordinate of 1");
  expect_refused("binary.obj", std::string(100, '\0'), "no mesh: an .obj that is no text");
  expect_refused("count.stl", binary_stl_of(box, 4'000'000'000),
                 "no mesh: an STL of 684 bytes, but the 4000000000 triangles of its header");
  expect_refused("cut_off.stl", binary_stl_of(box, 12).substr(0, 680), "no mesh: an STL of 680 bytes");
  expect_refused("dae.stl", collada, "no mesh: neither binary STL nor text that starts with \"solid\"");
  for (const char* name : {"empty.stl", "empty.obj", "empty.dae"}) expect_refused(name, "", "no mesh: it is empty");
}

TEST_F(MeshFile, accessorsWithoutParametersHaveNoneOfTheNext) {
  const std::string weights =
      "<source id=\"w\"><float_array id=\"b\" count=\"2\">1 2</float_array>"
      "<technique_common><accessor source=\"#b\" count=\"2\"/></technique_common></source>";
  EXPECT_EQ(read("weights.dae", replaced(collada, "<source id=\"p\">", weights + "<source id=\"p\">"))->vertices().size(), 8u);
}

TEST_F(MeshFile, noFileThatItNamesIsOpened) {
  fs::create_directory(path("inside"));
  ASSERT_EQ(mkfifo(path("x").c_str(), 0600), 0);
  EXPECT_EQ(read("inside/a.obj", "mtllib ../x\n" + obj_of(box_triangles({1, 1, 1})))->vertices().size(), 8u);
}

TEST_F(MeshFile, onlyRegularFilesAreRead) {
  ASSERT_EQ(mkfifo(path("pipe.stl").c_str(), 0600), 0);
  EXPECT_EQ(problem_of(path("pipe.stl")), "it is not a file");
  EXPECT_THROW(read_file(path("pipe.stl")), ResourceError);
  fs::create_symlink("/dev/zero", path("zero.stl"));
  EXPECT_EQ(problem_of(path("zero.stl")), "it is not a file");
  fs::create_directory(path("directory.stl"));
  EXPECT_EQ(problem_of(path("directory.stl")), "it is not a file");
  EXPECT_EQ(problem_of(path("none.stl")), "No such file or directory");
  ASSERT_EQ(truncate(write("large.stl", "").c_str(), 65 << 20), 0);
  EXPECT_EQ(problem_of(path("large.stl")), "it is larger than 64 MB");
  const FileAccess here{false, directory_};
  EXPECT_THROW(file_of("file://" + write("a.stl", "") + std::string("\0.txt", 5), here), ResourceError);
  EXPECT_THROW(file_of("file://" + replaced(path("a.stl"), "a.stl", "%61.stl"), here), ResourceError);
  EXPECT_THROW(file_of("http://localhost/a.stl", here), ResourceError);
}

/// As if a file grew while it is read.
TEST_F(MeshFile, theReaderStopsWhereTheFileIsTooLarge) {
  const std::string command = std::string("head -c 70000000 /dev/zero | ") + MESH_READER_PROGRAM + " stl > " + path("answer");
  EXPECT_NE(std::system(command.c_str()), 0);
  EXPECT_EQ(read_file(path("answer")), "Eit is larger than 64 MB");
}

TEST_F(MeshFile, patienceEnds) {
  const std::string slow = write("slow.dae", doubling_collada());
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(problem_of(slow, {begin + std::chrono::milliseconds(100)}), "it takes too long to read");
  std::atomic<bool> cancelled{false};
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    cancelled = true;
  });
  EXPECT_EQ(problem_of(slow, {begin + std::chrono::minutes(1), &cancelled}), "reading it was cancelled");
  other.join();
  // Nothing is left of the processes.
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
}

TEST_F(MeshFile, noDescriptorStaysOpen) {
  const auto open = [] { return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()); };
  const auto before = open();
  const std::string good = write("good.dae", collada), bad = write("bad.dae", replaced(collada, "count=\"24\"", "count=\"-1\""));
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(problem_of(good), "");
    EXPECT_NE(problem_of(bad), "");
  }
  EXPECT_EQ(open(), before);
}

TEST_F(MeshFile, isReadAgainWhenItHasChanged) {
  MeshCache cache;
  const std::string file = write("a.obj", obj_of(box_triangles({1, 1, 1})));
  const auto first = cache.read(file, unscaled, {});
  EXPECT_EQ(cache.read(file, unscaled, {}), first);
  EXPECT_EQ(cache.read(file, Vector3(2, 2, 2), {})->bounds().sizes(), Vector3(2, 2, 2));
  EXPECT_EQ(cache.read(file, unscaled, {}), first);
  write("a.obj", obj_of(box_triangles({1, 1, 3})));
  EXPECT_EQ(cache.read(file, unscaled, {})->bounds().sizes(), Vector3(1, 1, 3));
}

}  // namespace
}  // namespace verlet_cable
