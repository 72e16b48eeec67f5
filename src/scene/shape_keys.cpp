#include "shape_keys.h"

#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/scene/resource.h"

namespace verlet_cable {
namespace {

/// One factor for all directions, or three.
void read_scale(const Value& value, ShapeDesc& shape) {
  const std::string allowed = scale_words;
  if (value.node.IsScalar()) {
    shape.scale.setConstant(read_number(value, allowed));
  } else {
    const auto factors = read_numbers<3>(value, allowed);
    shape.scale = {factors[0], factors[1], factors[2]};
  }
}

bool has_default(const std::string& key) {
  return key == "scale" || key == "sheet" || key == "thickness";
}

}  // namespace

const Keys<ShapeDesc>& shape_keys() {
  static const Keys<ShapeDesc> keys = [] {
    Keys<ShapeDesc> shape{
        choice_key("type", &ShapeDesc::type,
                   {{"plane", ShapeType::plane},
                    {"sphere", ShapeType::sphere},
                    {"capsule", ShapeType::capsule},
                    {"cylinder", ShapeType::cylinder},
                    {"box", ShapeType::box},
                    {"mesh", ShapeType::mesh}},
                   true),
        pose_key("pose", &ShapeDesc::pose),
        vector_key("size", &ShapeDesc::size, "m"),
        text_key("uri", &ShapeDesc::uri, uri_words),
        {"scale", scale_words, false, read_scale},
        choice_key("sheet", &ShapeDesc::sheet, {{"auto", Sheet::automatic}, {"true", Sheet::yes}, {"false", Sheet::no}}),
    };
    append_fields(shape, shape_fields);
    return shape;
  }();
  return keys;
}

void check_dimensions(const Value& value, const std::set<std::string>& given, ShapeType type) {
  if (!given.count("type") || value.errors->is_unread(value.child("type", {}).key)) {
    for (const char* key : {"radius", "length", "size", "uri"}) value.errors->mark(value.child(key, {}).key);
    return;
  }
  for (const char* key : {"radius", "length", "size", "uri", "scale", "sheet", "thickness"}) {
    const std::string full_key = value.child(key, {}).key;
    const bool has = has_dimension(type, key);
    if (given.count(key) && !has) value.errors->add(full_key, "given with another type", "only with a type that has this key");
    if (!given.count(key) && has && !has_default(key))
      value.errors->add_unread(full_key, "missing", "a value, as shapes of this type need it");
  }
}

}  // namespace verlet_cable
