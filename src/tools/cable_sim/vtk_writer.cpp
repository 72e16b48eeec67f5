#include "vtk_writer.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>

#include "common/messages.h"
#include "common/output_file.h"
#include "scene/surface.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable::cable_sim {
namespace {

constexpr const char* xml_start = "<?xml version=\"1.0\"?>\n";
constexpr double radius_of_net = 1e-3;  // [m] of its threads, which have none

/// The numbers of one <DataArray>.
class DataArray {
 public:
  DataArray(const char* type, const char* name, int components = 1) : type_(type), name_(name), components_(components) {}

  void add(double number) {
    char text[number_text_size];
    text_.append(text, write_number(text, number));
    text_ += ' ';
  }
  void add(const Vector3& vector) {
    for (const double number : vector) add(number);
  }
  void add_integer(std::size_t number) { text_ += std::to_string(number) + ' '; }

  std::string xml() const {
    std::string xml = std::string("<DataArray type=\"") + type_ + "\" Name=\"" + name_ + "\"";
    if (components_ > 1) xml += " NumberOfComponents=\"" + std::to_string(components_) + "\"";
    return xml + " format=\"ascii\">\n" + text_ + "\n</DataArray>\n";
  }

 private:
  const char* type_;
  const char* name_;
  int components_;
  std::string text_;
};

/// Cells of one kind: their points, and where each ends.
struct Cells {
  DataArray connectivity{"Int64", "connectivity"}, offsets{"Int64", "offsets"};
  std::size_t count = 0, end = 0;

  template <class Indices>
  void add(const Indices& indices, std::size_t first) {
    for (const auto index : indices) connectivity.add_integer(first + static_cast<std::size_t>(index));
    end += std::size(indices);
    offsets.add_integer(end);
    ++count;
  }
  std::string xml(const char* kind) const {
    return std::string("<") + kind + ">\n" + connectivity.xml() + offsets.xml() + "</" + kind + ">\n";
  }
};

/// Texts as VTK has them in XML: the codes of their bytes, with a zero after each.
std::string names_xml(const std::vector<std::string>& names) {
  std::string xml = "<FieldData>\n<Array type=\"String\" Name=\"names\" NumberOfTuples=\"" + std::to_string(names.size()) +
                    "\" format=\"ascii\">\n";
  for (const std::string& name : names) {
    for (const char c : name) xml += std::to_string(static_cast<unsigned char>(c)) + ' ';
    xml += "0 ";
  }
  return xml + "\n</Array>\n</FieldData>\n";
}

std::string file_xml(const char* type, const std::string& content) {
  return std::string(xml_start) + "<VTKFile type=\"" + type + "\" version=\"1.0\" byte_order=\"LittleEndian\">\n" + content +
         "</VTKFile>\n";
}

/// `parts`: all of a piece but its points.
std::string poly_data_xml(const std::vector<std::string>& names, const DataArray& points, std::size_t point_count,
                          const Cells& verts, const Cells& lines, const Cells& polys, const std::string& data) {
  return file_xml("PolyData", "<PolyData>\n" + names_xml(names) + "<Piece NumberOfPoints=\"" + std::to_string(point_count) +
                                  "\" NumberOfVerts=\"" + std::to_string(verts.count) + "\" NumberOfLines=\"" +
                                  std::to_string(lines.count) + "\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
                                  std::to_string(polys.count) + "\">\n" + data + "<Points>\n" + points.xml() + "</Points>\n" +
                                  verts.xml("Verts") + lines.xml("Lines") + polys.xml("Polys") + "</Piece>\n</PolyData>\n");
}

/// Cables and nets as lines, particles as vertices; their points are the rows of --output, in its order.
std::string curves_xml(const World& world) {
  std::vector<std::string> names;
  DataArray points{"Float64", "points", 3}, velocity{"Float64", "velocity", 3}, node_tensions{"Float64", "tension"};
  DataArray node_radii{"Float64", "radius"};
  // Cells are numbered by kind: vertices first.
  DataArray radius{"Float64", "radius"}, tension{"Float64", "tension"}, object{"Int64", "object"};
  Cells verts, lines;
  const auto add_cell = [&](double its_radius, double its_tension, std::size_t its_object) {
    radius.add(its_radius);
    tension.add(its_tension);
    object.add_integer(its_object);
  };
  std::size_t count = 0;
  for (const SimulatedCable& cable : world.cables()) count += static_cast<std::size_t>(cable.state.nodes());
  for (const SimulatedNet& net : world.nets()) count += net.state.positions.size();
  const std::size_t first_particle_object = world.cables().size() + world.nets().size();
  for (std::size_t k = 0; k < world.particles().size(); ++k) {
    verts.add(std::vector<std::size_t>{k}, count);
    add_cell(world.particles()[k].desc.radius, 0, first_particle_object + k);
  }
  std::size_t first = 0;
  for (const SimulatedCable& cable : world.cables()) {
    const CableState& state = cable.state;
    const CableMaterials materials(cable);
    for (int i = 0; i < state.segments(); ++i) {
      lines.add(std::array<int, 2>{i, i + 1}, first);
      add_cell(materials[i].radius, state.tension[i], names.size());
    }
    for (int node = 0; node < state.nodes(); ++node) {
      points.add(state.positions[node]);
      velocity.add(state.velocities[node]);
      node_tensions.add(state.tension[std::min(node, state.segments() - 1)]);
      node_radii.add(materials.mean_at(node, [](const MaterialDesc& material) { return material.radius; }));
    }
    first += static_cast<std::size_t>(state.nodes());
    names.push_back(cable.model->name);
  }
  for (const SimulatedNet& net : world.nets()) {
    for (std::size_t link = 0; link < net.model.links.size(); ++link) {
      lines.add(net.model.links[link], first);
      add_cell(radius_of_net, net.state.tension[link], names.size());
    }
    const std::vector<double> tensions = node_tension(net);
    for (std::size_t node = 0; node < tensions.size(); ++node) {
      points.add(net.state.positions[node]);
      velocity.add(net.state.velocities[node]);
      node_tensions.add(tensions[node]);
      node_radii.add(radius_of_net);
    }
    first += tensions.size();
    names.push_back(net.model.name);
  }
  for (const SimulatedParticle& particle : world.particles()) {
    points.add(particle.position);
    velocity.add(particle.velocity);
    node_tensions.add(0);
    node_radii.add(particle.desc.radius);
    names.push_back(particle.desc.name);
  }
  const std::string data = "<PointData>\n" + velocity.xml() + node_tensions.xml() + node_radii.xml() +
                           "</PointData>\n<CellData>\n" + radius.xml() + tension.xml() + object.xml() + "</CellData>\n";
  return poly_data_xml(names, points, count + world.particles().size(), verts, lines, {}, data);
}

/// Solids as polygons.
class Solids {
 public:
  bool is_empty() const { return names_.empty(); }
  /// What is added until the next has that name.
  void begin(const std::string& name) { names_.push_back(name); }
  void add(const Shape& shape, const Pose& pose, double plane_reach) {
    const Surface surface = surface_of(shape, plane_reach);
    for (const Vector3& point : surface.points) points_.add((pose * Pose{point, Quaternion::Identity()}).position);
    for (const std::vector<int>& face : surface.faces) {
      polys_.add(face, count_);
      object_.add_integer(names_.size() - 1);
    }
    count_ += surface.points.size();
  }
  std::string xml() const {
    return poly_data_xml(names_, points_, count_, {}, {}, polys_, "<CellData>\n" + object_.xml() + "</CellData>\n");
  }

 private:
  std::vector<std::string> names_;
  DataArray points_{"Float64", "points", 3}, object_{"Int64", "object"};
  Cells polys_;
  std::size_t count_ = 0;
};

Solids bodies_of(const World& world, double plane_reach) {
  Solids solids;
  for (const SimulatedBody& body : world.bodies()) {
    if (body.is_junction) continue;
    solids.begin(body.name);
    for (const BodyShape& shape : body.shapes) solids.add(shape.shape, body.pose * shape.pose, plane_reach);
  }
  return solids;
}

Solids obstacles_of(const World& world, double plane_reach) {
  Solids solids;
  for (const Obstacle& obstacle : world.obstacles()) {
    if (!obstacle.present) continue;
    solids.begin(obstacle.name);
    solids.add(obstacle.shape, world.frame_pose(obstacle.frame) * obstacle.pose, plane_reach);
  }
  return solids;
}

std::string numbered(const std::string& name, std::size_t number) {
  char digits[24];
  std::snprintf(digits, sizeof digits, "%04zu", number);
  return name + "_" + digits + ".vtp";
}

}  // namespace

std::string why_no_directory(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0) {
    if (!S_ISDIR(status.st_mode)) return "it is not a directory";
    return access(path.c_str(), W_OK | X_OK) == 0 ? "" : tools::error_text(errno);
  }
  if (errno != ENOENT) return tools::error_text(errno);
  const std::size_t end = path.find_last_not_of('/') + 1;
  const std::size_t slash = path.substr(0, end).find_last_of('/');
  const std::string parent = slash == std::string::npos ? "." : path.substr(0, std::max<std::size_t>(slash, 1));
  if (access(parent.c_str(), W_OK | X_OK) == 0) return "";
  return "it cannot be made: " + tools::error_text(errno);
}

std::string cannot_write_directory(const std::string& path, const std::string& why) {
  return "cannot write " + tools::quoted_path(path) + ": " + why +
         "; allowed: a directory that can be written, or a new one in such a directory";
}

bool is_vtk_name(const std::string& name) {
  for (const std::string series : {"cables", "bodies", "obstacles"}) {
    if (name.compare(0, series.size(), series) != 0) continue;
    const std::string rest = name.substr(series.size());
    const std::size_t digits = rest.find_first_not_of("0123456789", 1);
    if (rest == ".pvd" || (rest[0] == '_' && digits > 1 && digits != std::string::npos && rest.substr(digits) == ".vtp"))
      return true;
  }
  return false;
}

VtkWriter::VtkWriter(const World& world, const std::string& directory) : directory_(directory), plane_reach_(plane_reach(world)) {
  constexpr mode_t everyone = 0777;
  if (mkdir(directory.c_str(), everyone) != 0 && errno != EEXIST) {
    problem_ = cannot_write_directory(directory, tools::error_text(errno));
    return;
  }
  if (const std::string why = why_no_directory(directory); !why.empty()) problem_ = cannot_write_directory(directory, why);
}

void VtkWriter::write(const std::string& name, const std::string& text) {
  if (problem_.empty()) problem_ = tools::write_file(directory_ + "/" + name, text);
}

bool VtkWriter::remove(const std::string& name) const {
  return ::unlink((directory_ + "/" + name).c_str()) == 0;
}

void VtkWriter::add_file(const World& world, Series& series, const std::optional<std::string>& content) {
  const std::string name = numbered(series.name, times_);
  if (!content) {
    remove(name);
    return;
  }
  write(name, *content);
  if (problem_.empty())
    series.index += "<DataSet timestep=\"" + number_text(world.time()) + "\" part=\"0\" file=\"" + name + "\"/>\n";
}

void VtkWriter::add(const World& world) {
  if (!problem_.empty()) return;
  const auto xml = [](const Solids& solids) { return solids.is_empty() ? std::nullopt : std::optional(solids.xml()); };
  add_file(world, cables_, curves_xml(world));
  add_file(world, bodies_, xml(bodies_of(world, plane_reach_)));
  add_file(world, obstacles_, xml(obstacles_of(world, plane_reach_)));
  ++times_;
}

void VtkWriter::finish() {
  // Also after an error: what is there can be shown.
  for (const Series* series : {&cables_, &bodies_, &obstacles_}) {
    for (std::size_t number = times_; remove(numbered(series->name, number));) ++number;
    const std::string name = std::string(series->name) + ".pvd";
    if (series->index.empty()) {
      remove(name);
      continue;
    }
    const std::string problem =
        tools::write_file(directory_ + "/" + name, file_xml("Collection", "<Collection>\n" + series->index + "</Collection>\n"));
    if (problem_.empty()) problem_ = problem;
  }
}

}  // namespace verlet_cable::cable_sim
