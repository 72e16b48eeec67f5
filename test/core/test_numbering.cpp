#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "../support/scenes.h"
#include "verlet_cable/core/rotation.h"

// A cable does the same from whichever end it is numbered: no law may take one joint's or one section's word for all.

namespace verlet_cable {
namespace {

struct Feature {
  const char* name;
  std::function<void(MaterialDesc&)> change;
  bool needs_torsion = false;
};

const Feature features[] = {
    {"Same", [](MaterialDesc&) {}},
    {"Stiff", [](MaterialDesc& m) { m.bending_stiffness = 0.02; }},
    {"BendingDamping", [](MaterialDesc& m) { m.bending_damping = 1e-3; }},
    {"StiffAndDamped",
     [](MaterialDesc& m) {
       m.bending_stiffness = 0.02;
       m.bending_damping = 1e-3;
     }},
    {"Ribbon",
     [](MaterialDesc& m) {
       m.bending_stiffness = {0.004, 0.01};
     },
     true},
    {"Torsion",
     [](MaterialDesc& m) {
       m.torsional_stiffness = 0.004;
       m.torsional_damping = 1e-4;
     }},
    {"Elastic",
     [](MaterialDesc& m) {
       m.axial_stiffness = 500;
       m.axial_damping = 1;
     }},
    {"Drag", [](MaterialDesc& m) { m.drag = 0.5; }},
    {"Thick", [](MaterialDesc& m) { m.radius = 0.02; }},
    {"Heavy", [](MaterialDesc& m) { m.linear_density = 0.15; }},
};

enum class Where { start, middle, end, outside };
enum class Holder { hinge, clamp, both_ends };

using Case = std::tuple<Feature, Where, Holder, bool>;

/// 0.5 m that begin straight along x. `reversed`: numbered from the other end. All that is at 0 m otherwise is at 0.5 m then.
SceneDesc scene_of(const Case& parameters, bool reversed) {
  const auto& [feature, where, holder, in_fluid] = parameters;
  constexpr double length = 0.5;
  const auto place = [&](double s) { return reversed ? length - s : s; };
  SceneDesc scene = scenes::one_cable(25, length);
  MaterialDesc& base = scene.materials[0].material;
  base.linear_density = 0.05;
  base.radius = 0.004;
  base.bending_stiffness = 0.005;
  // A ribbon needs some all along.
  if (feature.needs_torsion) base.torsional_stiffness = 0.004;
  scene.materials.push_back({"other", base});
  // Outside: the section is plain, the rest of the cable is not.
  feature.change(scene.materials[where == Where::outside ? 0 : 1].material);
  const auto section = [&](double from, double to) {
    return SectionDesc{std::min(place(from), place(to)), std::max(place(from), place(to)), "other"};
  };
  CableDesc& cable = scene.cables[0];
  cable.sections = {where == Where::start    ? section(0, 0.1)
                    : where == Where::middle ? section(0.2, 0.3)
                    : where == Where::end    ? section(0.4, 0.5)
                                             : section(0, 0.14)};
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = {{place(0), 0, 1}, {place(length), 0, 1}};
  const auto hold = [&](const std::string& name, double s, AttachmentType type) {
    AttachmentDesc& held =
        cable.attachments.emplace_back(scenes::attachment(name, PlaceDesc::At::arc_length, {s, 0, 1}, "", type));
    held.place.arc_length = place(s);
    if (reversed && type == AttachmentType::clamp) held.rotation = {0, 0, M_PI};
  };
  hold("a", 0, holder == Holder::hinge ? AttachmentType::hinge : AttachmentType::clamp);
  if (holder == Holder::both_ends) hold("b", length, AttachmentType::clamp);
  if (in_fluid) scene.fluid.density = 100;
  return scene;
}

class Numbering : public testing::TestWithParam<Case> {};

TEST_P(Numbering, FromTheOtherEndIsTheSame) {
  const SceneDesc forward = scene_of(GetParam(), false), backward = scene_of(GetParam(), true);
  World a(forward, initial_frames(forward)), b(backward, initial_frames(backward));
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(a.step(initial_frames(forward)).status, StepResult::Status::ok);
    ASSERT_EQ(b.step(initial_frames(backward)).status, StepResult::Status::ok);
  }
  double largest = 0;
  const std::vector<Vector3>&x = a.cables()[0].state.positions, &y = b.cables()[0].state.positions;
  ASSERT_EQ(x.size(), y.size());
  for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, (x[i] - y[x.size() - 1 - i]).norm());
  RecordProperty("largest_difference_fm", static_cast<int>(std::min(1e15 * largest, 1e9)));
  // A substep ends within 1e-5 segment lengths per second, 2e-7 m/s, of its solution: over the 0.2 s 4e-8 m, which a falling
  // cable may amplify some times.
  EXPECT_LT(largest, 4e-7);
}

std::string name_of(const testing::TestParamInfo<Case>& info) {
  const auto& [feature, where, holder, in_fluid] = info.param;
  const char* const places[] = {"AtStart", "Inside", "AtEnd", "Outside"};
  const char* const holders[] = {"Hinge", "Clamp", "BothEnds"};
  return feature.name + std::string(places[static_cast<int>(where)]) + holders[static_cast<int>(holder)] +
         (in_fluid ? "Fluid" : "");
}

INSTANTIATE_TEST_SUITE_P(Sections, Numbering,
                         testing::Combine(testing::ValuesIn(features),
                                          testing::Values(Where::start, Where::middle, Where::end, Where::outside),
                                          testing::Values(Holder::hinge, Holder::clamp, Holder::both_ends), testing::Bool()),
                         name_of);

}  // namespace
}  // namespace verlet_cable
