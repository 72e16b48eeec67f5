#include "cable_keys.h"

#include "place_key.h"

namespace verlet_cable {
namespace {

constexpr const char* stiff_ends_words = "[start, end], two numbers [m]";
constexpr const char* rest_curvature_words = "straight | initial | [ky, kz], two numbers [1/m] | a list of at least two [ky, kz]";

const Keys<AttachmentDesc>& attachment_keys() {
  static const Keys<AttachmentDesc> keys{
      text_key("name", &AttachmentDesc::name, name_words, true),
      place_key(&AttachmentDesc::place, true),
      text_key("frame", &AttachmentDesc::frame, frame_words),
      text_key("body", &AttachmentDesc::body, "the name of a body"),
      vector_key("offset", &AttachmentDesc::offset, "m"),
      vector_key("rotation", &AttachmentDesc::rotation, "rad"),
      choice_key("type", &AttachmentDesc::type, {{"hinge", AttachmentType::hinge}, {"clamp", AttachmentType::clamp}}),
      {"initial_pose", "six numbers", false,
       [](const Value& value, AttachmentDesc& attachment) {
         attachment.initial_pose = read_numbers<6>(value, "six numbers: x, y, z [m], roll, pitch, yaw [rad]");
       }},
  };
  return keys;
}

const Keys<PointMassDesc>& point_mass_keys() {
  static const Keys<PointMassDesc> keys{place_key(&PointMassDesc::place, true), field_key(point_mass_fields[0])};
  return keys;
}

const Keys<SectionDesc>& section_keys() {
  static const Keys<SectionDesc> keys{field_key(section_fields[0]), field_key(section_fields[1]),
                                      text_key("material", &SectionDesc::material, "the name of a material", true)};
  return keys;
}

Key<InitialShapeDesc> vectors_key(const std::string& name, std::vector<Vector3> InitialShapeDesc::*member, const char* unit) {
  return {name, "a list of points", false, [=](const Value& value, InitialShapeDesc& initial) {
            initial.*member =
                read_list<Vector3>(value, [=](const Value& element, Vector3& vector) { vector = read_vector(element, unit); });
          }};
}

const Keys<InitialShapeDesc>& initial_keys() {
  using Type = InitialShapeDesc::Type;
  static const Keys<InitialShapeDesc> keys{
      choice_key(
          "type", &InitialShapeDesc::type,
          Choices<Type>{
              {"straight", Type::straight}, {"catenary", Type::catenary}, {"points", Type::points}, {"settled", Type::settled}},
          true),
      vector_key("from", &InitialShapeDesc::from, "m"),
      vector_key("to", &InitialShapeDesc::to, "m"),
      vectors_key("points", &InitialShapeDesc::points, "m"),
      vectors_key("velocities", &InitialShapeDesc::velocities, "m/s"),
  };
  return keys;
}

void read_initial(const Value& value, InitialShapeDesc& initial) {
  const std::set<std::string> given = read_map(value, initial_keys(), initial);
  if (initial.type == InitialShapeDesc::Type::automatic) return;
  const auto only_with = [&](const char* name, InitialShapeDesc::Type type, const char* type_name) {
    if (given.count(name) && initial.type != type)
      value.errors->add(value.child(name, {}).key, "given with another type", std::string("only with type: ") + type_name);
  };
  only_with("from", InitialShapeDesc::Type::straight, "straight");
  only_with("to", InitialShapeDesc::Type::straight, "straight");
  only_with("points", InitialShapeDesc::Type::points, "points");
  only_with("velocities", InitialShapeDesc::Type::points, "points");
}

void read_rest_curvature(const Value& value, RestCurvatureDesc& rest_curvature) {
  using Type = RestCurvatureDesc::Type;
  const std::string text = value.node.IsScalar() ? value.node.Scalar() : "";
  if (text == "straight" || text == "initial") {
    rest_curvature.type = text == "straight" ? Type::straight : Type::initial;
  } else if (value.node.IsSequence() && value.node.size() > 0 && value.node[0].IsSequence()) {
    rest_curvature.type = Type::profile;
    rest_curvature.profile = read_list<std::array<double, 2>>(value, [](const Value& element, std::array<double, 2>& curvature) {
      curvature = read_numbers<2>(element, "[ky, kz], two numbers [1/m]");
    });
  } else {
    rest_curvature.type = Type::constant;
    rest_curvature.curvature = read_numbers<2>(value, rest_curvature_words);
  }
}

const Keys<CableDesc>& cable_keys() {
  static const Keys<CableDesc> keys{
      text_key("name", &CableDesc::name, name_words, true),
      field_key(cable_fields[0]),
      field_key(cable_fields[1]),
      field_key(cable_integer_fields[0]),
      text_key("material", &CableDesc::material, "the name of a material", true),
      {"sections", "a list", false,
       [](const Value& value, CableDesc& cable) {
         cable.sections = read_list<SectionDesc>(
             value, [](const Value& element, SectionDesc& section) { read_map(element, section_keys(), section); });
       }},
      {"color", "four numbers", false,
       [](const Value& value, CableDesc& cable) {
         cable.color = read_numbers<4>(value, "red, green, blue, alpha: four numbers from 0 to 1");
       }},
      {"initial", "a map", false, [](const Value& value, CableDesc& cable) { read_initial(value, cable.initial); }},
      {"rest_curvature", rest_curvature_words, false,
       [](const Value& value, CableDesc& cable) { read_rest_curvature(value, cable.rest_curvature); }},
      {"stiff_ends", stiff_ends_words, false,
       [](const Value& value, CableDesc& cable) { cable.stiff_ends = read_numbers<2>(value, stiff_ends_words); }},
      {"attachments", "a list", false,
       [](const Value& value, CableDesc& cable) {
         cable.attachments = read_list<AttachmentDesc>(
             value, [](const Value& element, AttachmentDesc& attachment) { read_map(element, attachment_keys(), attachment); });
       }},
      {"point_masses", "a list", false,
       [](const Value& value, CableDesc& cable) {
         cable.point_masses = read_list<PointMassDesc>(
             value, [](const Value& element, PointMassDesc& point_mass) { read_map(element, point_mass_keys(), point_mass); });
       }},
  };
  return keys;
}

}  // namespace

void read_cable(const Value& value, CableDesc& cable) {
  read_map(value, cable_keys(), cable);
}

}  // namespace verlet_cable
