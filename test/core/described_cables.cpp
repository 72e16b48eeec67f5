#include "described_cables.h"

#include <algorithm>
#include <cmath>

#include "../support/scenes.h"
#include "verlet_cable/core/rotation.h"

namespace verlet_cable::described {
namespace {

constexpr double length = 0.5, split_at = 0.25, height = 1, between_likes = 1, fork_at = 0.35;
constexpr int likes = 2;

/// A part of the cable that is described as a cable.
struct Piece {
  double from = 0, to = length;  ///< [m] along the cable
  bool is_reversed = false;
  const char* name = "cable";

  bool has(double s) const { return from <= s && s <= to; }
  /// [m] along the piece
  double place(double s) const { return is_reversed ? to - s : s - from; }
  /// Where the start of the cable is at the end of the piece.
  int index(bool at_end) const { return at_end != is_reversed ? 1 : 0; }
};

std::vector<Piece> pieces_of(Description description) {
  switch (description) {
    case Description::reversed:
      return {{0, length, true}};
    case Description::on_body:
    case Description::at_junction:
      return {{0, split_at, false}, {split_at, length, false, "rest"}};
    case Description::at_other_end:
      return {{0, split_at, false}, {split_at, length, true, "rest"}};
    default:
      return {{}};
  }
}

struct Section {
  double from, to;
};

Section section_of(Where where) {
  switch (where) {
    case Where::start:
      return {0, 0.1};
    case Where::inside:
      return {0.2, 0.3};
    case Where::end:
      return {0.4, length};
    case Where::outside:
      return {0, 0.15};
    case Where::everywhere:
      break;
  }
  return {0, 0};
}

class Builder {
 public:
  Builder(const Case& parameters, Description description) : case_(parameters), description_(description) {}

  SceneDesc build() {
    add_materials();
    const int count = case_.surroundings == Surroundings::likes ? likes : 1;
    for (int i = 0; i < count; ++i) add_cable(i);
    scene_.fluid.density = case_.feature.fluid;
    scene_.time_step = case_.time_step;
    if (case_.surroundings == Surroundings::floor) {
      ObstacleDesc& floor = scene_.obstacles.emplace_back();
      floor.name = "floor";
      floor.type = ShapeType::plane;
      floor.pose = {0, 0, height - 0.01, 0, 0, 0};
    }
    return scene_;
  }

 private:
  void add_materials() {
    const Feature& feature = case_.feature;
    MaterialDesc plain;
    plain.linear_density = 0.05;
    plain.radius = 0.004;
    plain.bending_stiffness = feature.is_limp ? 0 : 0.005;
    if (feature.needs_torsion) plain.torsional_stiffness = 0.004;
    MaterialDesc special = plain;
    feature.change(special);
    scene_.materials = {{"plain", plain}, {"special", special}, {"alike", special}};
  }

  bool is_bent() const { return starts_bent(case_); }

  /// [rad] From the y axis: straight ones go along it, others are an arc from 0.4 to -0.4 rad.
  double yaw_at(double s) const { return is_bent() ? bend * (s - 0.5 * length) : 0; }

  /// [m] Relative to the straight one's start, in the plane in which axes of the material are the same from either end. The
  /// middle goes along y.
  Vector3 start_at(double s) const {
    if (!is_bent()) return {0, s, 0};
    const double yaw = yaw_at(s);
    const double segment = length / case_.segments, radius = 0.5 * segment / std::sin(0.5 * bend * segment);
    return {radius * (std::cos(yaw) - 1), radius * std::sin(yaw) + 0.5 * length, 0};
  }

  AttachmentDesc attachment(const Piece& piece, const std::string& name, double s, AttachmentType type) const {
    AttachmentDesc desc = scenes::attachment(name, PlaceDesc::At::arc_length, Vector3::Zero(), "", type);
    desc.place.arc_length = piece.place(s);
    if (type == AttachmentType::clamp) desc.rotation = {0, 0, yaw_at(s) + (piece.is_reversed ? -M_PI / 2 : M_PI / 2)};
    return desc;
  }

  void add_sections(const Piece& piece, CableDesc& cable) const {
    const auto add = [&](double from, double to, const char* material) {
      from = std::max(from, piece.from);
      to = std::min(to, piece.to);
      if (to - from < 1e-9) return;
      const double a = piece.place(from), b = piece.place(to);
      cable.sections.push_back({std::min(a, b), std::max(a, b), material});
    };
    const Section section = section_of(case_.where);
    cable.material = case_.where == Where::everywhere || case_.where == Where::outside ? "special" : "plain";
    if (case_.where != Where::everywhere) add(section.from, section.to, case_.where == Where::outside ? "plain" : "special");
    if (description_ == Description::in_sections) {
      add(0.05, 0.15, "alike");
      add(0.3, 0.4, "alike");
    }
  }

  void add_cable(int number) {
    const std::string suffix = std::to_string(number);
    const Vector3 origin(0, between_likes * number, height);
    const Feature& feature = case_.feature;
    for (const Piece& piece : pieces_of(description_)) {
      CableDesc& cable = scene_.cables.emplace_back();
      cable.name = piece.name + suffix;
      cable.length = piece.to - piece.from;
      cable.segments = static_cast<int>(std::lround(case_.segments * cable.length / length));
      add_sections(piece, cable);
      cable.initial.type = InitialShapeDesc::Type::points;
      for (int i = 0; i <= cable.segments; ++i)
        cable.initial.points.push_back(origin + start_at(piece.from + cable.length * i / cable.segments));
      if (piece.is_reversed) std::reverse(cable.initial.points.begin(), cable.initial.points.end());
      cable.rest_twist = feature.rest_twist;
      if (feature.rest_curvature != std::array<double, 2>{0, 0}) {
        cable.rest_curvature.type = RestCurvatureDesc::Type::constant;
        // About axes of which x and y turn around.
        cable.rest_curvature.curvature = feature.rest_curvature;
        if (piece.is_reversed) cable.rest_curvature.curvature[1] *= -1;
      }
      if (piece.from == 0) cable.stiff_ends[piece.index(false)] = feature.stiff_ends[0];
      if (piece.to == length) cable.stiff_ends[piece.index(true)] = feature.stiff_ends[1];
      if (feature.payload > 0 && piece.has(0.15)) {
        PointMassDesc& payload = cable.point_masses.emplace_back(scenes::payload(feature.payload));
        payload.place.at = PlaceDesc::At::arc_length;
        payload.place.arc_length = piece.place(0.15);
      }
      hold(piece, number, origin, cable);
    }
    if (case_.surroundings == Surroundings::harness) add_twig(suffix, origin);
    if (description_ == Description::on_body) add_light_body(suffix, origin);
    if (description_ == Description::at_junction || description_ == Description::at_other_end) {
      JunctionDesc& junction = scene_.junctions.emplace_back();
      junction.name = "joint" + suffix;
      junction.cable = "cable" + suffix;
      junction.place.at = PlaceDesc::At::end;
      const bool is_reversed = description_ == Description::at_other_end;
      junction.branches.push_back(
          {"rest" + suffix, is_reversed ? BranchDesc::End::end : BranchDesc::End::start, Vector3::Zero()});
    }
  }

  void hold(const Piece& piece, int number, const Vector3& origin, CableDesc& cable) {
    const std::string suffix = std::to_string(number);
    const bool is_hinge = case_.holder == Holder::hinge || case_.holder == Holder::hinges;
    const AttachmentType type = is_hinge ? AttachmentType::hinge : AttachmentType::clamp;
    if (piece.from == 0) {
      AttachmentDesc& held = cable.attachments.emplace_back(attachment(piece, "start" + suffix, 0, type));
      held.frame = "hand";
      held.offset = Vector3(0, between_likes * number, 0) + start_at(0);
      held.initial_pose = InitialPose{0, 0, height, 0, 0, 0};
    }
    if (piece.to < length || case_.holder == Holder::hinge || case_.holder == Holder::clamp) return;
    AttachmentDesc& held = cable.attachments.emplace_back(attachment(piece, "end" + suffix, length, type));
    if (case_.holder == Holder::body) {
      BodyDesc& body = scene_.bodies.emplace_back();
      held.body = body.name = "load" + suffix;
      body.mass = 0.02;
      body.inertia = 1e-6 * Vector3(1, 2, 2);
      const Vector3 at = origin + start_at(length);
      body.pose = InitialPose{at.x(), at.y(), at.z(), 0, 0, 0};
    } else {
      held.offset = origin + start_at(length);
    }
  }

  /// To the side, at a junction.
  void add_twig(const std::string& suffix, const Vector3& origin) {
    for (const Piece& piece : pieces_of(description_)) {
      if (!piece.has(fork_at)) continue;
      JunctionDesc& junction = scene_.junctions.emplace_back();
      junction.name = "fork" + suffix;
      junction.cable = piece.name + suffix;
      junction.place.at = PlaceDesc::At::arc_length;
      junction.place.arc_length = piece.place(fork_at);
      junction.branches.push_back({"twig" + suffix, BranchDesc::End::start, Vector3::Zero()});
    }
    CableDesc& twig = scene_.cables.emplace_back();
    twig.name = "twig" + suffix;
    twig.length = 0.1;
    twig.segments = 4;
    twig.material = "plain";
    twig.initial.type = InitialShapeDesc::Type::points;
    twig.initial.points = {origin + start_at(fork_at), origin + start_at(fork_at) + Vector3(twig.length, 0, 0)};
  }

  void add_light_body(const std::string& suffix, const Vector3& origin) {
    BodyDesc& body = scene_.bodies.emplace_back();
    body.name = "joint" + suffix;
    body.mass = 1e-7;
    body.inertia = 5e-8 * Vector3::Ones();
    const Vector3 at = origin + start_at(split_at);
    body.pose = InitialPose{at.x(), at.y(), at.z(), 0, 0, 0};
    for (const Piece& piece : pieces_of(description_)) {
      CableDesc& cable = *std::find_if(scene_.cables.begin(), scene_.cables.end(),
                                       [&](const CableDesc& c) { return c.name == piece.name + suffix; });
      AttachmentDesc& held =
          cable.attachments.emplace_back(attachment(piece, "of_" + cable.name, split_at, AttachmentType::clamp));
      held.body = body.name;
    }
  }

  const Case& case_;
  Description description_;
  SceneDesc scene_;
};

Pose hand_at_time(double t) {
  const double way = 1 - std::cos(20 * t);
  Pose pose;
  pose.position = {0, 0.02 * way, height + 0.01 * way};
  // About the line along which cables that are alike lie one after the other.
  pose.orientation = Eigen::AngleAxisd(0.2 * way, Vector3::UnitY());
  return pose;
}

}  // namespace

bool is_split(Description description) {
  return pieces_of(description).size() > 1;
}

Run::Run(const Case& parameters, Description description)
    : parameters_(parameters),
      description_(description),
      scene_(Builder(parameters, description).build()),
      world_(scene_, initial_frames(scene_)) {
  if (parameters.winch == Winch::none) return;
  for (int i = 0; i < static_cast<int>(world_.cables().size()); ++i) {
    if (world_.cables()[i].model->name.rfind("cable", 0) != 0) continue;
    edit::SetLength change;
    change.cable = i;
    change.at_end = pieces_of(description)[0].is_reversed;
    change.length = world_.cables()[i].state.length() + (parameters.winch == Winch::out ? 0.1 : -0.1);
    change.speed = 0.5;
    const EditResult result = world_.apply(change);
    if (!result.ok) throw std::runtime_error(result.message);
  }
}

StepResult Run::step() {
  BoundaryInputs inputs = initial_frames(scene_);
  inputs[1].pose = hand_at_time(world_.time() + world_.time_step());
  return world_.step(inputs);
}

std::vector<Vector3> Run::positions() const {
  std::vector<Vector3> all;
  const int count = parameters_.surroundings == Surroundings::likes ? likes : 1;
  for (int i = 0; i < count; ++i) {
    for (const Piece& piece : pieces_of(description_)) {
      std::vector<Vector3> nodes = world_.cables()[find(world_.cables(), piece.name + std::to_string(i))].state.positions;
      if (piece.is_reversed) std::reverse(nodes.begin(), nodes.end());
      if (piece.from > 0) all.pop_back();
      all.insert(all.end(), nodes.begin(), nodes.end());
    }
  }
  return all;
}

}  // namespace verlet_cable::described
