#include "scene/validate_bodies.h"

#include <algorithm>

#include "body/mass_properties.h"
#include "scene/validate_obstacles.h"

namespace verlet_cable {
namespace {

/// Whether the orientation, or a part of it, is held.
bool holds_axes(AttachmentType type) {
  return type != AttachmentType::hinge;
}

const char* name_of(AttachmentType type) {
  return type == AttachmentType::clamp ? "clamp" : type == AttachmentType::axle ? "axle" : "hinge";
}

/// A clamp leaves nothing for another attachment to hold, and an axle only what a hinge on its axis can hold, too.
void check_types(const std::string& prefix, const BodyDesc& body, Errors& errors) {
  const std::vector<BodyAttachmentDesc>& attachments = body.attachments;
  const auto holds_all = [](const BodyAttachmentDesc& a) { return a.type == AttachmentType::clamp; };
  auto first = std::find_if(attachments.begin(), attachments.end(), holds_all);
  const bool has_clamp = first != attachments.end();
  if (!has_clamp) {
    first = std::find_if(attachments.begin(), attachments.end(), [](const BodyAttachmentDesc& a) { return holds_axes(a.type); });
  }
  for (auto other = attachments.begin(); other != attachments.end(); ++other) {
    if (other == first || (!has_clamp && !holds_axes(other->type))) continue;
    errors.add(indexed(prefix + "attachments", other - attachments.begin()) + ".type", name_of(other->type),
               has_clamp ? "nothing besides " + in_quotes(first->name) + ", a clamp, which holds the whole body"
                         : "a hinge on the axis of " + in_quotes(first->name) + ", an axle");
  }
}

void check_attachments(const std::string& prefix, std::size_t index, const BodyDesc& body, const SceneNames& scene_names,
                       UniqueNames& attachments, Errors& errors) {
  for (std::size_t i = 0; i < body.attachments.size(); ++i) {
    const BodyAttachmentDesc& attachment = body.attachments[i];
    const std::string key = indexed(prefix + "attachments", i);
    attachments.check(key + ".name", attachment.name, errors);
    check_holder(key, scene_names, attachment, errors);
    check_numbers(key + ".at", attachment.at, coordinate, "m, rad", errors);
    const auto holder = scene_names.bodies.find(attachment.body);
    if (!attachment.body.empty() && holder != scene_names.bodies.end() && holder->second == index)
      errors.add(key + ".body", in_quotes(attachment.body), "another body, or a frame");
  }
  check_types(prefix, body, errors);
}

void check_shapes(const std::string& prefix, const BodyDesc& body, Errors& errors) {
  for (std::size_t i = 0; i < body.shapes.size(); ++i) {
    const std::string shape = indexed(prefix + "shapes", i) + ".";
    if (body.shapes[i].type == ShapeType::plane) errors.add(shape + "type", "plane", "sphere | capsule | cylinder | box | mesh");
    check_numbers(shape + "pose", body.shapes[i].pose, coordinate, "m, rad", errors);
    check_shape(shape, body.shapes[i], errors);
  }
}

constexpr const char* inertia_words =
    "three numbers above 0 [kg m^2] about the center of mass, none larger than the other two together";

/// `shapes_sound`: whether something follows from the shapes.
void check_inertia(const std::string& prefix, const BodyDesc& body, bool shapes_sound, Errors& errors) {
  if (body.inertia) {
    const Vector3& moments = *body.inertia;
    if (!moment_of_inertia.contains(moments.minCoeff()) || !moment_of_inertia.contains(moments.maxCoeff()) ||
        !is_inertia(moments))
      errors.add(prefix + "inertia", list_text(moments), inertia_words);
    return;
  }
  if (!shapes_sound || !positive.contains(body.mass)) return;
  const auto derived = mass_properties(body);
  if (!derived)
    return errors.add(prefix + "inertia", "missing",
                      std::string(inertia_words) + ", or shapes that it follows from: no open meshes");
  const Vector3 moments = derived->inertia.diagonal();
  if (!moment_of_inertia.contains(moments.minCoeff()) || !moment_of_inertia.contains(moments.maxCoeff()))
    errors.add(prefix + "shapes", "an inertia of " + list_text(moments) + " kg m^2", moment_of_inertia.text("kg m^2"));
}

/// The body that holds this one by a clamp or axle, from which its pose follows; none: the number of bodies.
std::size_t holder_of_pose(const SceneDesc& scene, const SceneNames& scene_names, std::size_t body) {
  const BodyDesc& desc = scene.bodies[body];
  const auto holds = [](const BodyAttachmentDesc& a) { return holds_axes(a.type); };
  const auto attachment = std::find_if(desc.attachments.begin(), desc.attachments.end(), holds);
  if (desc.pose || attachment == desc.attachments.end()) return scene.bodies.size();
  const auto holder = scene_names.bodies.find(attachment->body);
  // One that holds itself is an error of its own.
  return holder == scene_names.bodies.end() || holder->second == body ? scene.bodies.size() : holder->second;
}

/// Bodies that hold each other in a ring, none of which has a pose: one error a ring.
void check_pose_rings(const SceneDesc& scene, const SceneNames& scene_names, Errors& errors) {
  const std::size_t bodies = scene.bodies.size();
  std::vector<std::size_t> reached_from(bodies, bodies);
  for (std::size_t start = 0; start < bodies; ++start) {
    std::size_t body = start;
    for (; body < bodies && reached_from[body] == bodies; body = holder_of_pose(scene, scene_names, body))
      reached_from[body] = start;
    if (body < bodies && reached_from[body] == start)
      errors.add(indexed("bodies", body) + ".pose", "missing, and the body is held by a body that it holds",
                 "a pose for at least one of the bodies that hold each other");
  }
}

void check_fluid(const std::string& prefix, const BodyFluidDesc& fluid, Errors& errors) {
  check_fields(prefix, body_fluid_fields, fluid, errors);
  check_vector(prefix + "center", fluid.center, "m", errors);
  for (const auto& field : body_fluid_axis_fields) {
    const Vector3& v = fluid.*field.member;
    check_numbers(prefix + field.key, std::array<double, 3>{v.x(), v.y(), v.z()}, field.range, field.unit, errors);
  }
}

void check_body(const std::string& prefix, const BodyDesc& body, Errors& errors) {
  check_fields(prefix, body_fields, body, errors);
  const std::size_t found = errors.size();
  check_shapes(prefix, body, errors);
  check_inertia(prefix, body, errors.size() == found, errors);
  check_fluid(prefix + "fluid.", body.fluid, errors);
  if (body.center_of_mass) check_vector(prefix + "center_of_mass", *body.center_of_mass, "m", errors);
  if (body.pose) check_numbers(prefix + "pose", *body.pose, coordinate, "m, rad", errors);
  check_vector(prefix + "velocity", body.velocity, "m/s", errors);
  check_vector(prefix + "angular_velocity", body.angular_velocity, "rad/s", errors);
}

}  // namespace

void check_bodies(const SceneDesc& scene, const SceneNames& scene_names, UniqueNames& names, UniqueNames& attachments,
                  Errors& errors) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const std::string prefix = indexed("bodies", i) + ".";
    names.check(prefix + "name", scene.bodies[i].name, errors);
    check_body(prefix, scene.bodies[i], errors);
    check_attachments(prefix, i, scene.bodies[i], scene_names, attachments, errors);
  }
  check_pose_rings(scene, scene_names, errors);
  if (!scene.bodies.empty() && scene.integrator.type != IntegratorDesc::Type::verlet)
    errors.add("integrator", "not verlet, with bodies", "verlet; the others are for particles and nets of springs");
}

void check_broadcast(const SceneDesc& scene, const SceneNames& scene_names, Errors& errors) {
  if (!scene.broadcast_tf) return;
  const auto check = [&](const std::string& key, const std::string& frame) {
    if (!frame.empty() && scene_names.bodies.count(frame))
      errors.add(key, in_quotes(frame), "a frame that is not named like a body, or broadcast_tf: false; `body` names bodies");
  };
  check("frame_id", scene.frame_id);
  visit_frame_users(scene, [&](const std::string& key, const auto& user) { check(key + ".frame", user.frame); });
  if (!scene.robot) return;
  for (const LinkDesc& link : scene.robot->tree) check("robot." + escaped(link.name), link.name);
}

}  // namespace verlet_cable
