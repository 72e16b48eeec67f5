#include "body_keys.h"

#include "shape_keys.h"

namespace verlet_cable {
namespace {

constexpr const char* inertia_words = "three numbers above 0 [kg m^2], about the center of mass along x, y and z";

void read_shape(const Value& value, ShapeDesc& shape) {
  const std::set<std::string> given = read_map(value, shape_keys(), shape);
  check_dimensions(value, given, shape.type);
}

const Keys<BodyAttachmentDesc>& body_attachment_keys() {
  static const Keys<BodyAttachmentDesc> keys{
      text_key("name", &BodyAttachmentDesc::name, name_words, true),
      text_key("frame", &BodyAttachmentDesc::frame, frame_words),
      text_key("body", &BodyAttachmentDesc::body, "the name of another body"),
      choice_key("type", &BodyAttachmentDesc::type,
                 {{"hinge", AttachmentType::hinge}, {"clamp", AttachmentType::clamp}, {"axle", AttachmentType::axle}}),
      pose_key("at", &BodyAttachmentDesc::at),
      vector_key("offset", &BodyAttachmentDesc::offset, "m"),
      vector_key("rotation", &BodyAttachmentDesc::rotation, "rad"),
      pose_key("initial_pose", &BodyAttachmentDesc::initial_pose),
  };
  return keys;
}

void read_fluid(const Value& value, BodyDesc& body) {
  static const Keys<BodyFluidDesc> keys = [] {
    Keys<BodyFluidDesc> fluid{vector_key("center", &BodyFluidDesc::center, "m")};
    append_fields(fluid, body_fluid_fields);
    append_fields(fluid, body_fluid_axis_fields);
    return fluid;
  }();
  read_map(value, keys, body.fluid);
}

const Keys<BodyDesc>& body_keys() {
  static const Keys<BodyDesc> keys = [] {
    Keys<BodyDesc> body{
        text_key("name", &BodyDesc::name, name_words, true),
        {"inertia", inertia_words, false,
         [](const Value& value, BodyDesc& body) {
           const auto moments = read_numbers<3>(value, inertia_words);
           body.inertia = Vector3(moments[0], moments[1], moments[2]);
         }},
        {"center_of_mass", "three numbers", false,
         [](const Value& value, BodyDesc& body) { body.center_of_mass = read_vector(value, "m"); }},
        pose_key("pose", &BodyDesc::pose),
        vector_key("velocity", &BodyDesc::velocity, "m/s"),
        vector_key("angular_velocity", &BodyDesc::angular_velocity, "rad/s"),
        {"fluid", "a map", false, read_fluid},
        {"shapes", "a list of shapes", false,
         [](const Value& value, BodyDesc& body) { body.shapes = read_list<ShapeDesc>(value, read_shape); }},
        {"attachments", "a list", false,
         [](const Value& value, BodyDesc& body) {
           body.attachments = read_list<BodyAttachmentDesc>(
               value, [](const Value& element, BodyAttachmentDesc& a) { read_map(element, body_attachment_keys(), a); });
         }},
    };
    append_fields(body, body_fields);
    return body;
  }();
  return keys;
}

void read_body(const Value& value, BodyDesc& body) {
  read_map(value, body_keys(), body);
  // Inertia may follow from the shapes: what could not be read says nothing about it.
  if (value.errors->is_unread(value.child("shapes", {}).key)) value.errors->mark(value.child("inertia", {}).key);
}

}  // namespace

void append_body_keys(Keys<SceneDesc>& keys) {
  keys.push_back({"bodies", "a list of bodies", false,
                  [](const Value& value, SceneDesc& scene) { scene.bodies = read_list<BodyDesc>(value, read_body); }});
  keys.push_back(switch_key("broadcast_tf", &SceneDesc::broadcast_tf));
}

}  // namespace verlet_cable
