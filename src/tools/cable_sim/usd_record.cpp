#include "usd_record.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "scene/surface.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable::cable_sim {
namespace {

constexpr double code_tolerance = 1e-6;  // of rounding in time codes
constexpr double width_of_net = 2e-3;    // [m] of its threads, which have none
constexpr std::array<double, 4> color_of_bodies{0.9, 0.5, 0.15, 1}, color_of_obstacles{0.7, 0.7, 0.7, 1};

std::string tuple(std::initializer_list<double> numbers) {
  std::string text = "(";
  for (const double number : numbers) text += (text.size() > 1 ? ", " : "") + number_text(number);
  return text + ")";
}

std::string tuple(const Vector3& v) {
  return tuple({v.x(), v.y(), v.z()});
}

/// A list of `text_of` each item.
template <class Items, class Text>
std::string list(const Items& items, const Text& text_of) {
  std::string text = "[";
  for (const auto& item : items) {
    if (text.size() > 1) text += ", ";
    text += text_of(item);
  }
  return text + "]";
}

std::string points_text(const std::vector<Vector3>& points) {
  return list(points, [](const Vector3& point) { return tuple(point); });
}

/// Quotes, and what would end them or the line, escaped.
std::string usd_string(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + '"';
}

/// `metadata` as USD writes it behind an attribute.
std::string in_brackets(const std::string& indent, const std::string& metadata) {
  return metadata.empty() ? "" : " (\n" + indent + "    " + metadata + "\n" + indent + ")";
}

std::string color_text(const std::string& indent, const std::array<double, 4>& color) {
  const std::string constant = in_brackets(indent, "interpolation = \"constant\"") + "\n";
  std::string text = indent + "color3f[] primvars:displayColor = [" + tuple({color[0], color[1], color[2]}) + "]" + constant;
  if (color[3] < 1) text += indent + "float[] primvars:displayOpacity = [" + number_text(color[3]) + "]" + constant;
  return text;
}

std::string mesh_text(const Surface& surface, const std::string& indent) {
  const auto counts = list(surface.faces, [](const std::vector<int>& face) { return std::to_string(face.size()); });
  std::vector<int> indices;
  for (const std::vector<int>& face : surface.faces) indices.insert(indices.end(), face.begin(), face.end());
  return indent + "int[] faceVertexCounts = " + counts + "\n" + indent +
         "int[] faceVertexIndices = " + list(indices, [](int index) { return std::to_string(index); }) + "\n" + indent +
         "point3f[] points = " + points_text(surface.points) + "\n" + indent + "uniform token subdivisionScheme = \"none\"\n" +
         indent + "uniform bool doubleSided = 1\n";
}

std::string round_text(double radius, double length, const std::string& indent) {
  return indent + "double radius = " + number_text(radius) + "\n" + indent + "double height = " + number_text(length) + "\n" +
         indent + "uniform token axis = \"Z\"\n";
}

struct TypeOfShape {
  const char* operator()(const PlaneShape&) const { return "Mesh"; }
  const char* operator()(const SphereShape&) const { return "Sphere"; }
  const char* operator()(const CapsuleShape&) const { return "Capsule"; }
  const char* operator()(const CylinderShape&) const { return "Cylinder"; }
  const char* operator()(const BoxShape&) const { return "Cube"; }
  const char* operator()(const MeshShape&) const { return "Mesh"; }
};

/// A solid at a pose in its parent, as a prim with a name that is an identifier already.
std::string shape_text(const std::string& name, const Shape& shape, const Pose& pose, const std::array<double, 4>& color,
                       double plane_reach, const std::string& indent) {
  const std::string inner = indent + "    ";
  std::string text = indent + "def " + std::visit(TypeOfShape{}, shape) + " \"" + name + "\"\n" + indent + "{\n";
  Vector3 scale = Vector3::Ones();
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
    text += inner + "double radius = " + number_text(sphere->radius) + "\n";
  } else if (const auto* capsule = std::get_if<CapsuleShape>(&shape)) {
    text += round_text(capsule->radius, capsule->length, inner);
  } else if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
    text += round_text(cylinder->radius, cylinder->length, inner);
  } else if (const auto* box = std::get_if<BoxShape>(&shape)) {
    text += inner + "double size = 1\n";
    scale = box->size;
  } else {
    text += mesh_text(surface_of(shape, plane_reach), inner);
  }
  text += color_text(inner, color);
  const Quaternion& q = pose.orientation;
  text += inner + "double3 xformOp:translate = " + tuple(pose.position) + "\n";
  text += inner + "quatd xformOp:orient = " + tuple({q.w(), q.x(), q.y(), q.z()}) + "\n";
  text += inner + "double3 xformOp:scale = " + tuple(scale) + "\n";
  text += inner + "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\", \"xformOp:scale\"]\n";
  return text + indent + "}\n";
}

std::string numbers_text(const std::vector<double>& numbers) {
  return list(numbers, [](double number) { return number_text(number); });
}

/// At each node.
std::vector<double> widths_of(const SimulatedCable& cable) {
  const CableMaterials materials(cable);
  const auto radius = [](const MaterialDesc& material) { return material.radius; };
  std::vector<double> widths(cable.state.nodes());
  for (std::size_t node = 0; node < widths.size(); ++node) widths[node] = 2 * materials.mean_at(static_cast<int>(node), radius);
  return widths;
}

}  // namespace

std::string usd_identifier(const std::string& name, std::set<std::string>& used) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::string identifier;
  for (const char c : name) identifier += is_letter(c) || is_digit(c) ? c : '_';
  if (identifier.empty() || is_digit(identifier[0])) identifier.insert(0, 1, '_');
  const std::string start = identifier;
  for (int number = 2; !used.insert(identifier).second; ++number) identifier = start + "_" + std::to_string(number);
  return identifier;
}

void UsdSamples::add(const std::string& time_code, std::string value) {
  // Between samples USD interpolates: where a value that stood changes, the last time at which it stood has one, too.
  if (!samples_.empty() && samples_.back().value == value) {
    last_time_ = time_code;
    return;
  }
  if (!samples_.empty() && samples_.back().time_code != last_time_) samples_.push_back({last_time_, samples_.back().value});
  samples_.push_back({time_code, std::move(value)});
  last_time_ = time_code;
}

std::string UsdSamples::statement(const std::string& indent, const std::string& declaration, const std::string& metadata) const {
  if (samples_.size() == 1) return indent + declaration + " = " + samples_[0].value + in_brackets(indent, metadata) + "\n";
  std::string text;
  if (!metadata.empty()) text += indent + declaration + in_brackets(indent, metadata) + "\n";
  text += indent + declaration + ".timeSamples = {\n";
  for (const Sample& sample : samples_) text += indent + "    " + sample.time_code + ": " + sample.value + ",\n";
  return text + indent + "}\n";
}

UsdRecord::UsdRecord(const World& world, const std::string& title, double rate)
    : title_(title), rate_(rate), plane_reach_(plane_reach(world)) {}

UsdRecord::Prim& UsdRecord::prim_at(Folder& folder, const std::string& key, const std::string& type, const std::string& name) {
  const auto [found, is_new] = folder.index_of.try_emplace(key, folder.prims.size());
  if (is_new) {
    folder.prims.emplace_back();
    folder.prims.back().type = type;
    folder.prims.back().name = name;
    folder.identifiers.push_back(usd_identifier(name, folder.used));
    if (time_code_ != first_code_) folder.prims.back().visibility.add(first_code_, "\"invisible\"");
  }
  folder.present.insert(found->second);
  return folder.prims[found->second];
}

void UsdRecord::add_curves(const std::string& key, const std::string& name, const std::array<double, 4>& color,
                           const std::string& counts, const std::vector<Vector3>& points, const std::vector<double>& widths) {
  Prim& prim = prim_at(cables_, key, "BasisCurves", name);
  if (prim.constants.empty()) {
    const std::string indent(12, ' ');
    prim.constants = indent + "uniform token type = \"linear\"\n" + indent + "uniform token wrap = \"nonperiodic\"\n" +
                     color_text(indent, color);
  }
  prim.attributes["int[] curveVertexCounts"].add(time_code_, counts);
  prim.attributes["point3f[] points"].add(time_code_, points_text(points));
  // Interpolation does not change over time, and where it is that of vertices, each has a width at all times.
  const auto differs = [&](double width) { return width != widths.front(); };
  prim.has_one_width = prim.has_one_width && std::none_of(widths.begin(), widths.end(), differs);
  prim.width.add(time_code_, numbers_text({widths.front()}));
  prim.widths.add(time_code_, numbers_text(widths));
}

void UsdRecord::add_solid(Folder& folder, const std::string& key, const std::string& name, const Pose& pose,
                          const std::string& children) {
  Prim& prim = prim_at(folder, key, "Xform", name);
  if (prim.constants.empty()) {
    prim.constants = std::string(12, ' ') + "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]\n";
    prim.children = children;
  }
  const Quaternion& q = pose.orientation;
  prim.attributes["double3 xformOp:translate"].add(time_code_, tuple(pose.position));
  prim.attributes["quatd xformOp:orient"].add(time_code_, tuple({q.w(), q.x(), q.y(), q.z()}));
}

void UsdRecord::add(const World& world) {
  const double code = world.time() * rate_;
  const double whole = std::round(code);
  time_code_ = number_text(std::abs(code - whole) < code_tolerance ? whole : code);
  if (first_code_.empty()) first_code_ = time_code_;
  for (const SimulatedCable& cable : world.cables()) {
    const std::string& name = cable.model->name;
    add_curves("cable " + name, name, cable.model->color, "[" + std::to_string(cable.state.nodes()) + "]", cable.state.positions,
               widths_of(cable));
  }
  for (const SimulatedNet& net : world.nets()) {
    std::vector<Vector3> ends;
    for (const auto& link : net.model.links)
      for (const int node : link) ends.push_back(net.state.positions[node]);
    const std::string counts = list(net.model.links, [](const auto&) { return "2"; });
    add_curves("net " + net.model.name, net.model.name, net.model.color, counts, ends, {width_of_net});
  }
  const std::string indent(12, ' ');
  for (const SimulatedParticle& particle : world.particles()) {
    const std::string& name = particle.desc.name;
    std::string children;
    if (!particles_.index_of.count(name))
      children = shape_text("shape", SphereShape{particle.desc.radius}, {}, particle.desc.color, plane_reach_, indent);
    add_solid(particles_, name, name, {particle.position, Quaternion::Identity()}, children);
  }
  for (const SimulatedBody& body : world.bodies()) {
    if (body.is_junction) continue;
    std::string children;
    if (!bodies_.index_of.count(body.name))
      for (std::size_t k = 0; k < body.shapes.size(); ++k)
        children += shape_text("shape" + (k == 0 ? "" : "_" + std::to_string(k + 1)), body.shapes[k].shape, body.shapes[k].pose,
                               color_of_bodies, plane_reach_, indent);
    add_solid(bodies_, body.name, body.name, body.pose, children);
  }
  for (const Obstacle& obstacle : world.obstacles()) {
    if (!obstacle.present) continue;
    const std::string key = std::to_string(obstacle.id);  // links of robots have several of one name
    std::string children;
    if (!obstacles_.index_of.count(key))
      children = shape_text("shape", obstacle.shape, obstacle.pose, color_of_obstacles, plane_reach_, indent);
    add_solid(obstacles_, key, obstacle.name, world.frame_pose(obstacle.frame), children);
  }
  for (Folder* folder : {&cables_, &particles_, &bodies_, &obstacles_}) end_time(*folder);
}

void UsdRecord::end_time(Folder& folder) {
  for (std::size_t k = 0; k < folder.prims.size(); ++k)
    folder.prims[k].visibility.add(time_code_, folder.present.count(k) ? "\"inherited\"" : "\"invisible\"");
  folder.present.clear();
}

std::string UsdRecord::text_of(const std::string& folder_name, const Folder& folder) {
  if (folder.prims.empty()) return "";
  const std::string indent(8, ' '), inner(12, ' ');
  std::string text = "\n    def Scope \"" + folder_name + "\"\n    {\n";
  for (std::size_t k = 0; k < folder.prims.size(); ++k) {
    const Prim& prim = folder.prims[k];
    text += indent + "def " + prim.type + " \"" + folder.identifiers[k] + "\" (\n" + inner + "customData = {\n" + inner +
            "    string name = " + usd_string(prim.name) + "\n" + inner + "}\n" + indent + ")\n" + indent + "{\n";
    text += prim.constants;
    if (prim.type == "BasisCurves")
      text += (prim.has_one_width ? prim.width : prim.widths)
                  .statement(inner, "float[] widths",
                             std::string("interpolation = \"") + (prim.has_one_width ? "constant" : "vertex") + "\"");
    for (const auto& [declaration, samples] : prim.attributes) text += samples.statement(inner, declaration);
    text += prim.visibility.statement(inner, "token visibility");
    text += prim.children + indent + "}\n";
  }
  return text + "    }\n";
}

std::string UsdRecord::text() const {
  return "#usda 1.0\n(\n    doc = " + usd_string(title_ + ", simulated by cable_sim") +
         "\n    defaultPrim = \"World\"\n    metersPerUnit = 1\n    upAxis = \"Z\"\n    startTimeCode = " + first_code_ +
         "\n    endTimeCode = " + time_code_ + "\n    timeCodesPerSecond = " + number_text(rate_) +
         "\n    framesPerSecond = " + number_text(rate_) + "\n)\n\ndef Xform \"World\"\n{" + text_of("Cables", cables_) +
         text_of("Particles", particles_) + text_of("Bodies", bodies_) + text_of("Obstacles", obstacles_) + "}\n";
}

}  // namespace verlet_cable::cable_sim
