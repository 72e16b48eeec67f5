#include "shipped_scenes.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "scene/frame_source.h"
#include "scene/frame_speed.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/scene/scene_reader.h"
#include "yaml-cpp/yaml.h"

namespace verlet_cable {
namespace {

namespace fs = std::filesystem;

bool is_scene(const fs::path& path) {
  if (path.extension() != ".yaml") return false;
  const YAML::Node root = YAML::LoadFile(path);
  for (const char* key : {"cables", "nets", "particles", "bodies"})
    if (root[key]) return true;
  return false;
}

/// Their paths, by their names.
const std::map<std::string, std::string>& shipped_scenes() {
  static const std::map<std::string, std::string> scenes = [] {
    std::map<std::string, std::string> found;
    const fs::path package = PACKAGE_DIRECTORY;
    for (const char* directory : {"config", "fuzz/worlds", "test/soak"})
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(package / directory)) {
        if (!is_scene(entry.path())) continue;
        std::string name = entry.path().lexically_relative(package).replace_extension().string();
        for (char& letter : name)
          if (!std::isalnum(static_cast<unsigned char>(letter))) letter = '_';
        found[name] = entry.path();
      }
    return found;
  }();
  return scenes;
}

/// FNV's steps, over bytes.
class Bytes {
 public:
  void add(const void* data, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ static_cast<const unsigned char*>(data)[i]) * 1099511628211ull;
  }
  template <class... Numbers>
  void operator()(const Numbers&... numbers) {
    (add(&numbers, sizeof numbers), ...);
  }
  void operator()(const Vector3& v) { (*this)(v.x(), v.y(), v.z()); }
  void operator()(const std::string& text) { add(text.data(), text.size()); }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037ull;
};

void add_findings(const Findings& findings, Bytes& bytes) {
  for (const auto* names : {&findings.waiting, &findings.unsettled, &findings.misfits})
    for (const std::string& name : *names) bytes(name);
  for (const Break& b : findings.breaks) bytes(b.cable, b.segment, b.new_cable, b.limit);
  for (const Excursion& e : findings.excursions) bytes(e.cable, e.node, e.kind, e.value, e.allowed);
  for (const auto* guides : {&findings.caught, &findings.released})
    for (const int guide : *guides) bytes(guide);
  for (const Jump& j : findings.jumps) bytes(j.attachment, j.distance, j.time, j.duration);
  for (const Intrusion& i : findings.intrusions) bytes(i.cable, i.segment, i.obstacle, i.depth);
  for (const BodyIntrusion& i : findings.body_intrusions) bytes(i.body, i.obstacle, i.depth);
  for (const SimulatedContact& c : findings.contacts) {
    bytes(c.cable, c.segment, c.obstacle, c.other_cable, c.other_segment, c.body);
    bytes(c.position);
    bytes(c.normal);
    bytes(c.force);
  }
}

}  // namespace

std::vector<std::string> shipped_scene_names() {
  std::vector<std::string> names;
  for (const auto& [name, path] : shipped_scenes()) names.push_back(name);
  return names;
}

std::string shipped_scene_path(const std::string& name) {
  return shipped_scenes().at(name);
}

std::string motion_of_shipped_scene(const std::string& path, const SceneDesc& scene, double duration) {
  std::ostringstream csv;
  for (const char* ending : {"_motion.csv", ".csv"}) {
    const std::ifstream beside(fs::path(path).replace_extension().string() + ending);
    if (!beside) continue;
    csv << beside.rdbuf();
    return csv.str();
  }
  constexpr double interval = 0.02;                                             // [s] of rows
  constexpr double period = 0.4, amplitude = 0.02, angle = 0.15, apart = 0.25;  // [s], [m], [rad], [m]
  const std::vector<std::string> names = frame_names(scene), unplaced = unplaced_frames(scene, {});
  const BoundaryInputs resting = FrameSource(scene, {}).at(0);
  if (names.size() < 2) return "";
  csv << "t,frame,x,y,z,qx,qy,qz,qw\n";
  for (int row = 0; row * interval < duration + interval; ++row)
    for (std::size_t i = 1; i < names.size(); ++i) {
      const double number = static_cast<double>(i), phase = 2 * M_PI * row * interval / (period * (1 + 0.2 * number));
      const Vector3 direction = Vector3(std::cos(number), std::sin(number), 0.5).normalized();
      Pose pose = resting[i].pose;
      if (std::count(unplaced.begin(), unplaced.end(), names[i]) > 0) pose.position.x() += apart * number;
      pose.position += amplitude * (1 - std::cos(phase)) * direction;
      pose.orientation = pose.orientation * Eigen::AngleAxisd(angle * (1 - std::cos(1.3 * phase)), direction);
      csv << number_text(row * interval) << ',' << names[i];
      for (const double x : {pose.position.x(), pose.position.y(), pose.position.z(), pose.orientation.x(), pose.orientation.y(),
                             pose.orientation.z(), pose.orientation.w()})
        csv << ',' << number_text(x);
      csv << '\n';
    }
  return csv.str();
}

ShippedRun run_shipped_scene(const std::string& path, const std::string& motion, int steps) {
  const SceneDesc scene = read_scene_file(path);
  const FrameSource source(scene, motion.empty() ? Motion{} : read_motion_file(motion));
  std::vector<BoundaryInputs> frames = {source.at(0)};
  limit_frame_velocities(scene.max_frame_speed, frames.front());
  const World start(scene, frames.front());
  World world = start;
  std::vector<std::uint64_t> bytes = {bytes_of(world)};
  for (int step = 1; step <= steps; ++step) {
    BoundaryInputs next = source.at(step * scene.time_step);
    limit_frame_motion(frames.back(), scene.max_frame_speed * scene.time_step, next);
    frames.push_back(std::move(next));
    const StepResult result = world.step(frames.back());
    bytes.push_back(bytes_of(world, result));
  }
  return {scene, start, std::move(frames), std::move(bytes)};
}

std::uint64_t bytes_of(const World& world, const StepResult& result) {
  Bytes bytes;
  bytes(world.hash(), world.time(), world.frames().size());
  bytes(result.status, result.body.kind, result.body.index, result.node, result.ignored_frame, result.substeps, result.iterations,
        result.exhausted, result.max_strain);
  add_findings(world.findings(), bytes);
  std::vector<JointView> joints;
  for (int cable = 0; cable < static_cast<int>(world.cables().size()); ++cable) {
    world.view_joints(cable, joints);
    for (const JointView& joint : joints) bytes(joint.arc_length, joint.curvature, joint.twist);
  }
  for (int guide = 0; guide < static_cast<int>(world.guides().size()); ++guide) {
    const GuideView view = world.view_guide(guide);
    bytes(view.cable, view.arc_length, view.tension[0], view.tension[1]);
  }
  const Energy energy = world.energy();
  bytes(energy.kinetic, energy.gravity, energy.stretch, energy.bend, energy.twist);
  return bytes.value();
}

}  // namespace verlet_cable
