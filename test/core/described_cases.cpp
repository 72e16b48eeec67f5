#include "described_cables.h"

namespace verlet_cable::described {
namespace {

bool is_held_twice(const Case& c) {
  return c.holder == Holder::hinges || c.holder == Holder::clamps;
}

}  // namespace

bool starts_bent(const Case& c) {
  return c.feature.starts_bent || is_held_twice(c);
}

const std::vector<Feature>& features() {
  static const std::vector<Feature> all = [] {
    std::vector<Feature> list;
    const auto add = [&](
                         const char* name, const std::function<void(MaterialDesc&)>& change = [](MaterialDesc&) {}) -> Feature& {
      list.push_back({name, change});
      return list.back();
    };
    add("Same");
    add("Limp").is_limp = true;
    add("Stiff", [](MaterialDesc& m) { m.bending_stiffness = 0.02; });
    add("BendingDamping", [](MaterialDesc& m) { m.bending_damping = 1e-3; });
    add("StiffAndDamped", [](MaterialDesc& m) {
      m.bending_stiffness = 0.02;
      m.bending_damping = 1e-3;
    });
    Feature& damped = add("DampedAlone", [](MaterialDesc& m) { m.bending_damping = 1e-3; });
    damped.is_limp = damped.hinges = true;
    add("Ribbon", [](MaterialDesc& m) { m.bending_stiffness = {0.004, 0.01}; }).needs_torsion = true;
    add("Torsion", [](MaterialDesc& m) {
      m.torsional_stiffness = 0.004;
      m.torsional_damping = 1e-4;
    });
    add("TorsionalDamping", [](MaterialDesc& m) { m.torsional_damping = 1e-4; }).needs_torsion = true;
    add("Elastic", [](MaterialDesc& m) {
      m.axial_stiffness = 500;
      m.axial_damping = 1;
    });
    add("LimpElastic", [](MaterialDesc& m) {
      m.axial_stiffness = 500;
      m.axial_damping = 1;
    }).is_limp = true;
    add("Drag", [](MaterialDesc& m) { m.drag = 0.5; });
    add("Fluid").fluid = 100;
    Feature& fluid = add("ThickInFluid", [](MaterialDesc& m) { m.radius = 0.02; });
    fluid.fluid = 100;
    add("Thick", [](MaterialDesc& m) { m.radius = 0.02; });
    add("Heavy", [](MaterialDesc& m) { m.linear_density = 0.15; });
    add("Payload").payload = 0.02;
    add("StiffEnds").stiff_ends = {0.06, 0.03};
    Feature& curved = add("Curved");
    curved.needs_torsion = true;
    curved.rest_curvature = {1, 2};
    Feature& twisted = add("Twisted");
    twisted.needs_torsion = true;
    twisted.rest_twist = 3;
    Feature& whole = add("WholeRod", [](MaterialDesc& m) {
      m.bending_stiffness = {0.004, 0.01};
      m.bending_damping = 1e-4;
      m.torsional_damping = 1e-4;
      m.axial_stiffness = 500;
    });
    whole.needs_torsion = true;
    whole.rest_curvature = {0, bend};
    whole.starts_bent = true;
    whole.payload = 0.01;
    Feature& coiled = add("Coiled");
    coiled.needs_torsion = true;
    coiled.rest_curvature = {0, bend};
    coiled.starts_bent = true;
    return list;
  }();
  return all;
}

std::string name_of(const Case& c) {
  const char* const descriptions[] = {"Plain", "Reversed", "InSections", "AtJunction", "AtOtherEnd", "OnBody"};
  const char* const places[] = {"", "AtStart", "Inside", "AtEnd", "Outside"};
  const char* const holders[] = {"Hinge", "Clamp", "Hinges", "Clamps", "Body"};
  const char* const winches[] = {"", "PaidOut", "TakenIn"};
  const char* const surroundings[] = {"", "Likes", "Harness", "Floor"};
  return descriptions[static_cast<int>(c.description)] + std::string("_") + c.feature.name + places[static_cast<int>(c.where)] +
         "_" + holders[static_cast<int>(c.holder)] + winches[static_cast<int>(c.winch)] +
         surroundings[static_cast<int>(c.surroundings)];
}

bool is_in_island(const Case& c) {
  return c.holder == Holder::body || c.surroundings == Surroundings::harness;
}

bool is_elastic(const Case& c) {
  MaterialDesc material;
  c.feature.change(material);
  return material.axial_stiffness < infinity;
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const Description description : {Description::reversed, Description::in_sections, Description::at_junction,
                                        Description::at_other_end, Description::on_body})
    for (const Feature& feature : features())
      for (const Where where : {Where::everywhere, Where::start, Where::inside, Where::end, Where::outside})
        for (const Holder holder : {Holder::hinge, Holder::clamp, Holder::hinges, Holder::clamps, Holder::body})
          for (const Winch winch : {Winch::none, Winch::out, Winch::in})
            for (const Surroundings surroundings :
                 {Surroundings::nothing, Surroundings::likes, Surroundings::harness, Surroundings::floor}) {
              const Case c{feature, where, holder, winch, surroundings, description};
              // Where there is a feature matters for the law alone, whatever winds and surrounds the cable.
              if (where != Where::everywhere && (winch != Winch::none || surroundings != Surroundings::nothing)) continue;
              if (description == Description::in_sections && where != Where::everywhere) continue;
              // What a junction does, they do as well.
              const bool is_as_at_junction = description == Description::at_other_end || description == Description::on_body;
              if (is_as_at_junction && (where != Where::everywhere || winch != Winch::none)) continue;
              const bool is_plain = surroundings == Surroundings::nothing || surroundings == Surroundings::harness;
              if (description == Description::on_body && !is_plain) continue;
              // Between two holders there is no room to take any in.
              if (winch == Winch::in && is_held_twice(c)) continue;
              // Ends are welded at the angle between them as it is at the start, not as it is without load: cables that start
              // bent are a whole only if they are bent so at rest.
              const std::array<double, 2> start{0, starts_bent(c) ? bend : 0};
              if (is_split(description) && (feature.rest_curvature != start || feature.hinges)) continue;
              cases.push_back(c);
            }
  return cases;
}

}  // namespace verlet_cable::described
