#include "scene_files.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "mesh_file.h"
#include "robot_model.h"
#include "verlet_cable/core/name_list.h"

namespace verlet_cable {
namespace {

constexpr const char* urdf_words = "a URDF";
constexpr std::chrono::seconds patience_for_meshes(600);
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

bool is_scaled(const ShapeDesc& shape) {
  return std::all_of(shape.scale.begin(), shape.scale.end(), [](double factor) { return positive.contains(std::abs(factor)); });
}

void read_mesh(const std::string& key, MeshReader& reader, ErrorList& errors, ShapeDesc& shape) {
  const bool unread = errors.is_unread(key + ".uri") || errors.is_unread(key + ".scale");
  if (shape.type != ShapeType::mesh || unread || !is_scaled(shape)) return errors.mark(key + ".uri");
  try {
    shape.mesh = reader.read(shape);
  } catch (const ResourceError& error) {
    errors.add_unread(key + ".uri", in_quotes(shape.uri) + ": " + error.what(), mesh_words);
  }
}

/// Why a robot can do without a geometry: it has no size, or its mesh cannot be read, which is done here. None: there is nothing
/// to say, or an error that `validate` names.
std::optional<std::string> problem_of(ObstacleDesc& obstacle, MeshReader& reader) {
  if (obstacle.type == ShapeType::box && obstacle.size.cwiseAbs().minCoeff() == 0) return "a box with an edge of length 0";
  const bool is_round = obstacle.type == ShapeType::sphere || obstacle.type == ShapeType::cylinder;
  if (is_round && obstacle.radius == 0) return "a radius of 0";
  if (obstacle.type == ShapeType::cylinder && obstacle.length == 0) return "a cylinder of length 0";
  if (obstacle.type != ShapeType::mesh) return std::nullopt;
  if (obstacle.scale.cwiseAbs().minCoeff() == 0) return in_quotes(obstacle.uri) + ": a scale of 0";
  if (!is_scaled(obstacle)) return std::nullopt;
  try {
    obstacle.mesh = reader.read(obstacle);
  } catch (const ResourceError& error) {
    return in_quotes(obstacle.uri) + ": " + error.what();
  }
  return std::nullopt;
}

/// The file of `description: file:PATH`; empty: it is the name of a parameter, which has no colon.
std::string file_of_description(const RobotDesc& robot) {
  const std::string prefix = "file:";
  if (robot.description.compare(0, prefix.size(), prefix) != 0) return "";
  const bool is_uri = robot.description.compare(0, prefix.size() + 2, prefix + "//") == 0;
  return is_uri ? robot.description : robot.description.substr(prefix.size());
}

/// The URDF's text, the key that it comes from and the file's name, which a parameter does not have. The parameter comes before
/// the file: a scene with both is for the node and for cable_sim.
struct Description {
  std::string key;
  std::string text;
  std::string file;
};
Description read_description(const RobotDesc& robot, const SceneSources& sources, ErrorList& errors) {
  const std::string named = file_of_description(robot);
  if (sources.parameter && named.empty()) {
    if (const auto text = sources.parameter(robot.description)) return {"robot.description", *text, ""};
  }
  const std::string& file = named.empty() ? robot.file : named;
  const std::string key = named.empty() ? "robot.file" : "robot.description";
  if (!file.empty()) {
    try {
      return {key, read_file(file_of(file, sources.files)), file};
    } catch (const ResourceError& error) {
      errors.add_unread(key, in_quotes(file) + ": " + error.what(), urdf_words);
    }
  } else if (sources.parameter) {
    errors.add_unread("robot.description", in_quotes(robot.description) + " is not set, or is no text",
                      "a parameter with a URDF");
  } else {
    errors.add_unread("robot.file", "missing", "a file with a URDF: there are no parameters here");
  }
  return {};
}

/// The name of a mesh in a URDF: a relative path starts at the URDF's file.
std::string named_beside(const std::string& file, const std::string& uri) {
  const bool is_relative = uri.find("://") == std::string::npos && !uri.empty() && uri.front() != '/';
  return is_relative ? file.substr(0, file.rfind('/') + 1) + uri : uri;
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
    if (!root.errors->is_unread(key.key)) root.errors->add(key.key, in_quotes(robot.links[i]), allowed);
  }
}

void read_robot(const Value& root, const SceneSources& sources, MeshReader& meshes, RobotDesc& robot) {
  const Description description = read_description(robot, sources, *root.errors);
  if (description.key.empty()) return;
  try {
    robot.tree = read_urdf(description.text, robot);
  } catch (const ResourceError& error) {
    const std::string& name = description.key == "robot.file" ? robot.file : robot.description;
    return root.errors->add_unread(description.key, in_quotes(name) + ": " + error.what(), urdf_words);
  }
  check_links(root, robot);
  for (LinkDesc& link : robot.tree) {
    const auto is_left_out = [&](ObstacleDesc& obstacle) {
      const bool is_mesh = obstacle.type == ShapeType::mesh;
      if (is_mesh) obstacle.uri = named_beside(description.file, obstacle.uri);
      const auto problem = problem_of(obstacle, meshes);
      if (!problem) return false;
      const std::string key = "robot." + escaped(obstacle.name) + (is_mesh ? ".uri" : "");
      if (robot.on_bad_mesh == RobotDesc::OnBadMesh::error)
        root.errors->add_unread(key, *problem, "geometry with a size, or robot.on_bad_mesh: warn");
      else
        robot.left_out.push_back(key + " is left out: " + *problem);
      return true;
    };
    link.obstacles.erase(std::remove_if(link.obstacles.begin(), link.obstacles.end(), is_left_out), link.obstacles.end());
  }
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

void read_robot_files(const Value& root, const SceneSources& sources, RobotDesc& robot) {
  MeshReader meshes(sources.files);
  read_robot(root, sources, meshes, robot);
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
  add(file_of_description(*scene.robot));
  for (const LinkDesc& link : scene.robot->tree)
    for (const ObstacleDesc& obstacle : link.obstacles) add(obstacle.uri);
  return files;
}

}  // namespace verlet_cable
