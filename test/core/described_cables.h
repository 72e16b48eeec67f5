#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "verlet_cable/core/world.h"

/// One and the same cable, described in several ways: what it is made of, what holds it, and what is around it.
namespace verlet_cable::described {

constexpr double bend = 1.6;  ///< [1/m] about z, of cables that start bent

/// What is special about the cable, beside the plain one: 0.05 kg/m, EI 0.005 N m^2.
struct Feature {
  const char* name;
  std::function<void(MaterialDesc&)> change = [](MaterialDesc&) {};
  bool is_limp = false;        ///< the plain cable has no bending stiffness
  bool hinges = false;         ///< it has bending damping alone: junctions pass none of it on, as for all limp cables
  bool needs_torsion = false;  ///< the plain cable has torsional stiffness, too
  double payload = 0;          ///< [kg] at 0.15 m
  std::array<double, 2> stiff_ends{0, 0};
  std::array<double, 2> rest_curvature{0, 0};
  double rest_twist = 0;
  bool starts_bent = false;  ///< along an arc, whatever holds it; others do if they are held twice
  double fluid = 0;          ///< [kg/m^3]
};
const std::vector<Feature>& features();

/// The part that has the feature: the others are plain.
enum class Where { everywhere, start, inside, end, outside };
enum class Holder { hinge, clamp, hinges, clamps, body };  ///< one at the start, or two; or a body at the end as well
enum class Winch { none, out, in };                        ///< at the start
enum class Surroundings { nothing, likes, harness, floor };

/// The ways to describe it.
enum class Description {
  plain,
  reversed,      ///< numbered from its other end
  in_sections,   ///< as sections, of materials with other names
  at_junction,   ///< two cables at a rigid junction
  at_other_end,  ///< likewise, the second one numbered from its other end
  on_body,       ///< two cables, clamped to a body that is as light as a junction
};

struct Case {
  Feature feature;
  Where where = Where::everywhere;
  Holder holder = Holder::clamp;
  Winch winch = Winch::none;
  Surroundings surroundings = Surroundings::nothing;
  Description description = Description::reversed;
  int segments = 20;         ///< a multiple of 20
  double time_step = 0.001;  ///< [s]
};
std::string name_of(const Case& parameters);
/// Whether it is straight at the start, or an arc.
bool starts_bent(const Case& parameters);
/// Whether it is described as two cables.
bool is_split(Description description);
/// Whether the cable is stepped together with a body, at a junction or at its end.
bool is_in_island(const Case& parameters);

/// Whether it can stretch, somewhere.
bool is_elastic(const Case& parameters);

/// Those that can exist.
std::vector<Case> all_cases();

/// The same run, of the cable as `parameters` describe it.
class Run {
 public:
  Run(const Case& parameters, Description description);

  /// The hand that holds the start moves and turns; the winch runs.
  StepResult step();
  /// [m] of the nodes from the start of the cable on, one cable after the other where there are several alike
  std::vector<Vector3> positions() const;
  World& world() { return world_; }

 private:
  Case parameters_;
  Description description_;
  SceneDesc scene_;
  World world_;
};

}  // namespace verlet_cable::described
