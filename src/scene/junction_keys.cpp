#include "junction_keys.h"

#include "place_key.h"

namespace verlet_cable {
namespace {

constexpr const char* cable_words = "the name of a cable";

const Keys<BranchDesc>& branch_keys() {
  static const Keys<BranchDesc> keys{
      text_key("cable", &BranchDesc::cable, cable_words, true),
      choice_key("end", &BranchDesc::end, {{"start", BranchDesc::End::start}, {"end", BranchDesc::End::end}}),
      vector_key("rotation", &BranchDesc::rotation, "rad"),
  };
  return keys;
}

const Keys<JunctionDesc>& junction_keys() {
  static const Keys<JunctionDesc> keys{
      text_key("name", &JunctionDesc::name, name_words, true),
      text_key("cable", &JunctionDesc::cable, cable_words, true),
      place_key(&JunctionDesc::place, true),
      {"branches", "a list of at least one branch", true,
       [](const Value& value, JunctionDesc& junction) {
         junction.branches = read_list<BranchDesc>(
             value, [](const Value& element, BranchDesc& branch) { read_map(element, branch_keys(), branch); });
       }},
      choice_key("type", &JunctionDesc::type, {{"rigid", JunctionDesc::Type::rigid}, {"hinge", JunctionDesc::Type::hinge}}),
      field_key(junction_fields[0]),
  };
  return keys;
}

}  // namespace

void append_junction_keys(Keys<SceneDesc>& keys) {
  keys.push_back({"junctions", "a list of junctions", false, [](const Value& value, SceneDesc& scene) {
                    scene.junctions = read_list<JunctionDesc>(value, [](const Value& element, JunctionDesc& junction) {
                      read_map(element, junction_keys(), junction);
                    });
                  }});
}

}  // namespace verlet_cable
