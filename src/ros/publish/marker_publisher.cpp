#include "publish/marker_publisher.h"

#include <algorithm>
#include <cmath>

#include "publish/cable_markers.h"
#include "publish/conversions.h"
#include "publish/guide_markers.h"
#include "publish/light.h"
#include "publish/net_look.h"
#include "publish/obstacle_markers.h"
#include "publish/queue_size.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/view/drawing.h"

namespace verlet_cable {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double aluminium_density = 2700;  // [kg/m^3]
constexpr double pin_size = 2.2;            // of a pin to the cable it holds, radius to radius
constexpr int cable_marker_id = 0;
constexpr int net_lines_id = 0, particle_marker_id = 0;
constexpr int net_triangles_id = -1;   // markers that share a namespace with a net, as pins may, have ids from 0
constexpr double net_pin_size = 0.4;   // of the first link's length
constexpr double body_pin_size = 0.3;  // of a body's radius of gyration
constexpr double text_size = 0.05;     // of the longest cable
constexpr std::array<double, 4> text_color{0.6, 0.1, 0.1, 1};
constexpr double load_size = 4;      // of the text's height: the length of the greatest load's arrow
constexpr double load_width = 0.05;  // of that length
constexpr double least_load = 1e-3;  // likewise: shorter arrows are not seen
constexpr std::array<double, 4> force_color{0.9, 0.35, 0.1, 1};
constexpr std::array<double, 4> torque_color{0.55, 0.25, 0.8, 1};

std_msgs::ColorRGBA grey(float level) {
  std_msgs::ColorRGBA color;
  color.r = color.g = color.b = level;
  color.a = 1;
  return color;
}

void set_scale(Marker& marker, double x, double y, double z) {
  marker.scale.x = x;
  marker.scale.y = y;
  marker.scale.z = z;
}

/// [kg] What a node weighs beyond the segments that meet there. The half segments that cuts leave on the ends do not count.
double payload(const SimulatedCable& cable, int node) {
  const CableMaterials materials(cable);
  const double heaviest = materials.largest([](const MaterialDesc& material) { return material.linear_density; });
  double share = 0, largest_half = 0;
  for (int segment = std::max(node - 1, 0); segment <= std::min(node, cable.state.segments() - 1); ++segment) {
    const double half = cable.state.rest_lengths[segment] / 2;
    share += materials[segment].linear_density * half;
    largest_half = std::max(largest_half, heaviest * half);
  }
  const double excess = cable.state.masses[node] - share;
  return excess > 1.5 * largest_half ? excess : 0;
}

/// [m] Of the thicker of the segments beside a node.
double radius_at(const SimulatedCable& cable, int node) {
  const CableMaterials materials(cable);
  return std::max(materials[std::max(node - 1, 0)].radius, materials[std::min(node, cable.state.segments() - 1)].radius);
}

/// [m] The width of what shows how something is held.
double pin_width(const World& world, const Attachment& attachment) {
  const BodyId& held = attachment.body;
  const auto index = static_cast<std::size_t>(held.index);
  if (held.is_rigid_body()) return body_pin_size * radius_of_gyration(world.bodies()[index]);
  if (held.is_net()) return net_pin_size * link_length(world.nets()[index].model);
  return 2 * pin_size * radius_at(world.cables()[index], attachment.node);
}

void add_triangles(const SimulatedNet& net, const DrawingFrame& frame, Marker& marker) {
  for (const std::array<int, 3>& corners : triangles_of(net.model)) {
    const auto at = [&](int corner) -> const Vector3& { return net.state.positions[corners[corner]]; };
    const Vector3 normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    for (int corner = 0; corner < 3; ++corner) marker.points.push_back(frame.point(at(corner)));
    marker.colors.insert(marker.colors.end(), 3, lit_from_both_sides(marker.color, normal));
  }
}

}  // namespace

MarkerPublisher::MarkerPublisher(ros::NodeHandle& private_node, const SceneDesc& scene, const DrawingFrame& frame)
    : publisher_(private_node.advertise<MarkerArray>("markers", publisher_queue_size)), frame_(frame) {
  show(scene, frame);
}

void MarkerPublisher::show(const SceneDesc& scene, const DrawingFrame& frame) {
  frame_ = frame;
  style_ = scene.marker_style;
  holders_.clear();
  const auto note = [this](const auto& held) {
    for (const auto& desc : held)
      for (const auto& attachment : desc.attachments) holders_[desc.name].push_back(attachment.frame);
  };
  note(scene.cables);
  note(scene.nets);
  note(scene.bodies);
  double longest = 0;
  for (const CableDesc& cable : scene.cables) longest = std::max(longest, cable.length);
  text_height_ = longest > 0 ? text_size * longest : 1;
}

void MarkerPublisher::publish(const World& world, const ColorScale& colors, const ros::Time& stamp) {
  if (publisher_.getNumSubscribers() == 0) return;
  const auto markers = boost::make_shared<MarkerArray>();
  add_cables(world, colors, *markers);
  for (const SimulatedNet& net : world.nets())
    if (is_finite(net)) add_net(net, *markers);
  for (const SimulatedParticle& particle : world.particles())
    if (is_finite(particle)) add_particle(particle, *markers);
  for (const Attachment& attachment : world.attachments())
    if (is_named(attachment)) add_pin(world, attachment, *markers);
  for (int guide = 0; guide < static_cast<int>(world.guides().size()); ++guide) add_guide(world, guide, *markers);
  for (const Obstacle& obstacle : world.obstacles()) add_obstacle(world, obstacle, *markers);
  for (const SimulatedBody& body : world.bodies())
    if (!body.is_junction && is_there(world, body)) add_body(body, *markers);
  add_loads(world, *markers);
  add_waiting(world, *markers);
  delete_what_is_gone(*markers);
  free_ids_of_what_is_gone();
  for (Marker& marker : markers->markers) marker.header.stamp = stamp;
  publisher_.publish(markers);
}

Marker MarkerPublisher::make_marker(const std::string& ns, int id, int type) const {
  Marker marker;
  marker.header.frame_id = frame_.name;
  marker.ns = ns;
  marker.id = id;
  marker.type = type;
  marker.pose.orientation.w = 1;
  return marker;
}

void MarkerPublisher::add_cables(const World& world, const ColorScale& colors, MarkerArray& markers) {
  const std::vector<std::vector<double>> contact_forces = colors.contact_forces(world);
  std::vector<const SimulatedCable*> cables;
  std::vector<CableLook> looks;
  for (std::size_t i = 0; i < world.cables().size(); ++i) {
    const SimulatedCable& cable = world.cables()[i];
    if (!is_finite(cable)) continue;
    cables.push_back(&cable);
    const CableMaterials materials(cable);
    looks.push_back({cable.state.positions, colors.node_colors(cable, contact_forces[i]), materials.largest_radius()});
    for (int segment = 0; materials.vary() && segment < cable.state.segments(); ++segment)
      looks.back().segment_radii.push_back(materials[segment].radius);
  }
  std::vector<Marker> shapes = cable_markers(looks, style_);
  for (std::size_t i = 0; i < cables.size(); ++i) {
    Marker marker = make_marker(cables[i]->model->name, cable_marker_id, shapes[i].type);
    marker.scale = shapes[i].scale;
    marker.color = shapes[i].color;
    marker.points.swap(shapes[i].points);
    for (geometry_msgs::Point& point : marker.points) frame_.enter(point);
    marker.colors.swap(shapes[i].colors);
    markers.markers.push_back(std::move(marker));
    add_payloads(*cables[i], markers);
  }
}

void MarkerPublisher::add_waiting(const World& world, MarkerArray& markers) const {
  std::string text;
  for (const std::string& name : world.findings().waiting) {
    NameList frames;
    const auto holders = holders_.find(name);
    for (const std::string& holder : holders == holders_.end() ? std::vector<std::string>{} : holders->second) {
      const std::vector<std::string>& names = world.frames();
      const auto frame = std::find(names.begin(), names.end(), holder);
      if (frame == names.end() || !world.frame_known(static_cast<int>(frame - names.begin()))) frames.add(holder);
    }
    text += (text.empty() ? "" : "\n") + name + " waits for tf: " + frames.text("its holder");
  }
  if (text.empty()) return;
  Marker marker = make_marker("waiting", 0, Marker::TEXT_VIEW_FACING);
  marker.pose.position = frame_.point(frame_.origin);
  marker.scale.z = text_height_;
  marker.color = to_color(text_color);
  marker.text = text;
  markers.markers.push_back(std::move(marker));
}

void MarkerPublisher::add_payloads(const SimulatedCable& cable, MarkerArray& markers) {
  int payloads = 0;
  for (int node = 0; node < cable.state.nodes(); ++node) {
    const double mass = payload(cable, node);
    if (mass <= 0) continue;
    // Counted, since a winch changes the numbers of the nodes.
    Marker marker = make_marker("payloads", id_of(cable.model->name + "/" + std::to_string(payloads++)), Marker::SPHERE);
    marker.pose.position = frame_.point(cable.state.positions[node]);
    const double ball = 2 * std::cbrt(3 * mass / (4 * M_PI * aluminium_density));
    const double diameter = std::max(ball, 2 * pin_size * radius_at(cable, node));
    set_scale(marker, diameter, diameter, diameter);
    marker.color = grey(0.55f);
    markers.markers.push_back(std::move(marker));
  }
}

void MarkerPublisher::add_net(const SimulatedNet& net, MarkerArray& markers) const {
  if (!net.model.links.empty()) {
    Marker lines = make_marker(net.model.name, net_lines_id, Marker::LINE_LIST);
    lines.scale.x = link_width(net.model);
    lines.color = to_color(net.model.color);
    for (const std::array<int, 2>& link : net.model.links)
      for (const int node : link) lines.points.push_back(frame_.point(net.state.positions[node]));
    markers.markers.push_back(std::move(lines));
  }
  if (!net.model.is_grid() || style_ == MarkerStyle::line) return;
  Marker triangles = make_marker(net.model.name, net_triangles_id, Marker::TRIANGLE_LIST);
  set_scale(triangles, 1, 1, 1);
  triangles.color = to_color(net.model.color);
  add_triangles(net, frame_, triangles);
  markers.markers.push_back(std::move(triangles));
}

void MarkerPublisher::add_particle(const SimulatedParticle& particle, MarkerArray& markers) const {
  Marker marker = make_marker(particle.desc.name, particle_marker_id, Marker::SPHERE);
  marker.pose.position = frame_.point(particle.position);
  const double diameter = 2 * particle.desc.radius;
  set_scale(marker, diameter, diameter, diameter);
  marker.color = to_color(particle.desc.color);
  markers.markers.push_back(std::move(marker));
}

void MarkerPublisher::add_pin(const World& world, const Attachment& attachment, MarkerArray& markers) {
  // What holds a body is there before the frame that it holds it to.
  if (!world.frame_known(attachment.frame)) return;
  const Pose pose = world.frame_pose(attachment.frame) * attachment.pose;
  if (!pose.position.allFinite() || !pose.orientation.coeffs().allFinite()) return;
  const double size = pin_width(world, attachment);
  const bool clamp = attachment.type == AttachmentType::clamp, axle = attachment.type == AttachmentType::axle;
  Marker marker = make_marker("pins", id_of(attachment.name), clamp ? Marker::CUBE : axle ? Marker::CYLINDER : Marker::SPHERE);
  marker.pose = frame_.pose(pose);
  marker.color = grey(0.8f);
  if (clamp) {
    set_scale(marker, 2 * size, size, 0.7 * size);  // three unequal edges show direction and roll
  } else if (axle) {
    set_scale(marker, 0.5 * size, 0.5 * size, 3 * size);
  } else {
    set_scale(marker, size, size, size);
  }
  markers.markers.push_back(std::move(marker));
}

void MarkerPublisher::add_guide(const World& world, int guide, MarkerArray& markers) {
  int part = 0;
  for (Marker& look : guide_markers(world, guide)) add_look("guides", world.guides()[guide].name, part, std::move(look), markers);
}

/// From where they act: along the force, and along the axis of the torque. The greatest ones have the longest arrows.
void MarkerPublisher::add_loads(const World& world, MarkerArray& markers) {
  double greatest_force = 0, greatest_torque = 0;
  for (const Load& load : world.loads()) {
    greatest_force = std::max(greatest_force, load.force.norm());
    greatest_torque = std::max(greatest_torque, load.torque.norm());
  }
  const double length = load_size * text_height_;
  for (const Load& load : world.loads()) {
    const bool on_cable = load.body.is_cable();
    const Pose pose = on_cable ? Pose{world.cables()[load.body.index].state.positions[load.node]}
                               : world.bodies()[load.body.index].pose * Pose{load.point};
    const Quaternion axes = load.is_local ? pose.orientation : Quaternion::Identity();
    const auto add = [&](const char* what, const Vector3& vector, double greatest, const std::array<double, 4>& color) {
      const Vector3 way = length / greatest * (axes * vector);
      if (!(greatest > 0) || !pose.position.allFinite() || !way.allFinite() || way.norm() < least_load * length) return;
      Marker arrow = make_marker("loads", id_of("load " + load.name + what), Marker::ARROW);
      arrow.points = {frame_.point(pose.position), frame_.point(pose.position + way)};
      set_scale(arrow, load_width * length, 2 * load_width * length, 0);
      arrow.color = to_color(color);
      markers.markers.push_back(std::move(arrow));
    };
    add(" force", load.force, greatest_force, force_color);
    add(" torque", load.torque, greatest_torque, torque_color);
  }
}

void MarkerPublisher::add_obstacle(const World& world, const Obstacle& obstacle, MarkerArray& markers) {
  if (!obstacle.present) return;
  int part = 0;
  add_shape("obstacles", obstacle.name, part, obstacle.shape, world.frame_pose(obstacle.frame) * obstacle.pose, markers);
}

void MarkerPublisher::add_body(const SimulatedBody& body, MarkerArray& markers) {
  const std::size_t first = markers.markers.size();
  int part = 0;
  for (const BodyShape& shape : body.shapes) add_shape("bodies", body.name, part, shape.shape, body.pose * shape.pose, markers);
  for (std::size_t i = first; i < markers.markers.size(); ++i)
    markers.markers[i].color = to_color(opaque(view::body_look().color));
}

/// `part`: how many markers of that name there are before.
void MarkerPublisher::add_shape(const std::string& ns, const std::string& name, int& part, const Shape& shape, const Pose& pose,
                                MarkerArray& markers) {
  for (Marker& look : shape_markers(shape, pose)) add_look(ns, name, part, std::move(look), markers);
}

void MarkerPublisher::add_look(const std::string& ns, const std::string& name, int& part, Marker look, MarkerArray& markers) {
  look.header.frame_id = frame_.name;
  frame_.enter(look.pose.position);
  look.ns = ns;
  // No other name has a colon and a number behind it.
  look.id = id_of(name + ":" + std::to_string(part++));
  markers.markers.push_back(std::move(look));
}

void MarkerPublisher::delete_what_is_gone(MarkerArray& markers) {
  std::set<Key> showing;
  for (const Marker& marker : markers.markers) showing.emplace(marker.ns, marker.id);
  for (const auto& [ns, id] : shown_) {
    if (showing.count({ns, id}) > 0) continue;
    Marker gone = make_marker(ns, id, Marker::SPHERE);
    gone.action = Marker::DELETE;
    markers.markers.push_back(std::move(gone));
  }
  shown_ = std::move(showing);
}

int MarkerPublisher::id_of(const std::string& name) {
  const auto known = ids_.find(name);
  if (known != ids_.end()) return known->second;
  if (auto earlier = earlier_ids_.extract(name)) return ids_.insert(std::move(earlier)).position->second;
  return ids_.emplace(name, free_id()).first->second;
}

int MarkerPublisher::free_id() {
  if (free_ids_.empty()) return static_cast<int>(ids_.size() + earlier_ids_.size()) + 1;
  return free_ids_.extract(free_ids_.begin()).value();
}

void MarkerPublisher::free_ids_of_what_is_gone() {
  for (const auto& gone : earlier_ids_) free_ids_.insert(gone.second);
  earlier_ids_ = std::exchange(ids_, {});
}

}  // namespace verlet_cable
