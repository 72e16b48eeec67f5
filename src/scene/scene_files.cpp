#include "scene_files.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "mesh_file.h"
#include "robot_model.h"
#include "verlet_cable/core/name_list.h"

namespace verlet_cable {
namespace {

constexpr const char* urdf_words = "a URDF";
constexpr std::chrono::seconds patience_for_meshes(60);
constexpr std::size_t most_triangles = 2'000'000;  // of all meshes

/// Meshes by file and scale, each read once, within limits for all.
class MeshReader {
 public:
  explicit MeshReader(const FileAccess& files) : files_(files) {}

  std::shared_ptr<const TriangleMesh> read(const ShapeDesc& shape) {
    const std::string file = file_of(shape.uri, files_);
    const Vector3& scale = shape.scale;
    std::shared_ptr<const TriangleMesh>& mesh = meshes_[{file, scale.x(), scale.y(), scale.z()}];
    if (mesh) return mesh;
    const auto read = read_mesh_file(file, scale, patience_);
    triangles_ += read->triangles().size();
    if (triangles_ > most_triangles)
      throw ResourceError("with it all meshes have more than " + std::to_string(most_triangles) + " triangles");
    return mesh = read;
  }

 private:
  const FileAccess& files_;
  const Patience patience_{std::chrono::steady_clock::now() + patience_for_meshes};
  std::size_t triangles_ = 0;
  std::map<std::tuple<std::string, double, double, double>, std::shared_ptr<const TriangleMesh>> meshes_;
};

void read_mesh(const std::string& key, MeshReader& reader, ErrorList& errors, ShapeDesc& shape) {
  const bool unread = errors.is_unread(key + ".uri") || errors.is_unread(key + ".scale");
  const Vector3& scale = shape.scale;
  const bool scaled = positive.contains(scale.minCoeff()) && positive.contains(scale.maxCoeff());
  if (shape.type != ShapeType::mesh || unread || !scaled) return errors.mark(key + ".uri");
  try {
    shape.mesh = reader.read(shape);
  } catch (const ResourceError& error) {
    errors.add_unread(key + ".uri", quoted(shape.uri) + ": " + error.what(), mesh_words);
  }
}

/// The URDF's text and the key that it comes from. The parameter comes before the file: a scene with both is for the node and for
/// cable_sim.
struct Description {
  std::string key;
  std::string text;
};
Description read_description(const RobotDesc& robot, const SceneSources& sources, ErrorList& errors) {
  if (sources.parameter) {
    if (const auto text = sources.parameter(robot.description)) return {"robot.description", *text};
  }
  if (!robot.file.empty()) {
    try {
      return {"robot.file", read_file(file_of(robot.file, sources.files))};
    } catch (const ResourceError& error) {
      errors.add_unread("robot.file", quoted(robot.file) + ": " + error.what(), urdf_words);
    }
  } else if (sources.parameter) {
    errors.add_unread("robot.description", quoted(robot.description) + " is not set, or is no text", "a parameter with a URDF");
  } else {
    errors.add_unread("robot.file", "missing", "a file with a URDF: there are no parameters here");
  }
  return {};
}

void check_links(const Value& root, const RobotDesc& robot) {
  NameList names;
  std::set<std::string> known;
  for (const LinkDesc& link : robot.tree) {
    names.add(link.name);
    known.insert(link.name);
  }
  const std::string allowed = "a link of the robot: " + names.text();
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    if (known.count(robot.links[i]) > 0) continue;
    const Value key = root.child("robot", {}).child("links", {}).element(i, {});
    if (!root.errors->is_unread(key.key)) root.errors->add(key.key, quoted(robot.links[i]), allowed);
  }
}

void read_robot(const Value& root, const SceneSources& sources, MeshReader& meshes, RobotDesc& robot) {
  const Description description = read_description(robot, sources, *root.errors);
  if (description.key.empty()) return;
  try {
    robot.tree = read_urdf(description.text, robot);
  } catch (const ResourceError& error) {
    const std::string& name = description.key == "robot.file" ? robot.file : robot.description;
    return root.errors->add_unread(description.key, quoted(name) + ": " + error.what(), urdf_words);
  }
  check_links(root, robot);
  for (LinkDesc& link : robot.tree)
    for (ObstacleDesc& obstacle : link.obstacles) read_mesh("robot." + escaped(obstacle.name), meshes, *root.errors, obstacle);
}

}  // namespace

void read_scene_files(const Value& root, const SceneSources& sources, SceneDesc& scene) {
  MeshReader meshes(sources.files);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i)
    read_mesh(root.child("obstacles", {}).element(i, {}).key, meshes, *root.errors, scene.obstacles[i]);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Value shapes = root.child("bodies", {}).element(i, {}).child("shapes", {});
    for (std::size_t k = 0; k < scene.bodies[i].shapes.size(); ++k)
      read_mesh(shapes.element(k, {}).key, meshes, *root.errors, scene.bodies[i].shapes[k]);
  }
  if (scene.robot && !root.errors->is_unread("robot")) read_robot(root, sources, meshes, *scene.robot);
}

std::vector<std::string> named_files(const SceneDesc& scene, const FileAccess& access) {
  std::vector<std::string> files;
  const auto add = [&](const std::string& uri) {
    if (uri.empty()) return;
    try {
      files.push_back(file_of(uri, access));
    } catch (const ResourceError&) {
      return;  // nothing is there
    }
  };
  for (const ObstacleDesc& obstacle : scene.obstacles) add(obstacle.uri);
  for (const BodyDesc& body : scene.bodies)
    for (const auto& shape : body.shapes) add(shape.uri);
  if (!scene.robot) return files;
  add(scene.robot->file);
  for (const LinkDesc& link : scene.robot->tree)
    for (const ObstacleDesc& obstacle : link.obstacles) add(obstacle.uri);
  return files;
}

}  // namespace verlet_cable
