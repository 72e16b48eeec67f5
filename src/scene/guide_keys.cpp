#include "guide_keys.h"

#include "place_key.h"
#include "shape_keys.h"

namespace verlet_cable {
namespace {

using Type = GuideDesc::Type;

const Keys<GuideDesc>& guide_keys() {
  static const Keys<GuideDesc> keys = [] {
    Keys<GuideDesc> guide{
        text_key("name", &GuideDesc::name, name_words, true),
        text_key("cable", &GuideDesc::cable, "the name of a cable", true),
        place_key(&GuideDesc::place, false),
        text_key("frame", &GuideDesc::frame, frame_words),
        text_key("body", &GuideDesc::body, "the name of a body"),
        vector_key("offset", &GuideDesc::offset, "m"),
        vector_key("rotation", &GuideDesc::rotation, "rad"),
        choice_key("type", &GuideDesc::type, {{"eyelet", Type::eyelet}, {"sheave", Type::sheave}, {"clip", Type::clip}}),
        {"friction", not_negative_or_infinite.text(), false,
         [](const Value& value, GuideDesc& guide) { guide.friction = read_number(value, not_negative_or_infinite.text()); }},
        pose_key("initial_pose", &GuideDesc::initial_pose),
    };
    append_fields(guide, sheave_fields);
    append_fields(guide, clip_fields);
    return guide;
  }();
  return keys;
}

template <class Fields>
void check_type(const Value& value, const std::set<std::string>& given, const Fields& fields, bool is_type, const char* type) {
  for (const auto& field : fields) {
    if (given.count(field.key) && !is_type)
      value.errors->add(value.child(field.key, {}).key, "given with another type", std::string("only with type: ") + type);
  }
}

void read_guide(const Value& value, GuideDesc& guide) {
  const std::set<std::string> given = read_map(value, guide_keys(), guide);
  const auto key = [&](const char* name) { return value.child(name, {}).key; };
  if (value.errors->is_unread(key("type"))) return value.errors->mark(key("at"));
  check_type(value, given, sheave_fields, guide.type == Type::sheave, "sheave");
  check_type(value, given, clip_fields, guide.type == Type::clip, "clip");
  if (guide.type == Type::sheave && !given.count("radius"))
    value.errors->add_unread(key("radius"), "missing", sheave_fields[0].range.text(sheave_fields[0].unit));
}

}  // namespace

void append_guide_keys(Keys<SceneDesc>& keys) {
  keys.push_back({"guides", "a list of guides", false,
                  [](const Value& value, SceneDesc& scene) { scene.guides = read_list<GuideDesc>(value, read_guide); }});
}

}  // namespace verlet_cable
