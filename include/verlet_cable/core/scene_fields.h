#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// The range of a number in a scene: lowest <= number <= highest, or infinite if that has a meaning; never NaN. Bounds that the
/// words do not mention are far outside of what is physical; they keep sums and products finite.
struct Range {
  double lowest = 0;
  double highest = 0;
  const char* words = "";  ///< what is allowed, for messages
  bool infinite = false;   ///< +infinity is allowed too

  bool contains(double value) const { return (value >= lowest && value <= highest) || (infinite && value == infinity); }
  /// `any number above 0 [m] (from 1e-12 to 1e+12)`
  std::string text(const char* unit = "") const;
};

constexpr Range positive{1e-12, 1e12, "any number above 0"};
constexpr Range positive_or_infinite{1e-12, 1e12, "any number above 0, or .inf", true};
constexpr Range not_negative_or_infinite{0, 1e12, "0 or more, or .inf", true};
constexpr Range not_negative{0, 1e12, "0 or more"};
constexpr Range coordinate{-1e9, 1e9, "finite numbers"};
constexpr Range unit_interval{0, 1, "numbers"};
constexpr Range applied_load{-1e9, 1e9, "finite numbers"};
constexpr Range load_duration{0, 1e9, "0 or more"};
constexpr Range winch_tension{0, applied_load.highest, "0 or more"};
constexpr double largest_integer = std::numeric_limits<int>::max();

/// A number in a scene: its key, the member that stores it, its unit and range. One table for the reader, `validate` and the
/// documentation.
template <class Owner, class Number = double>
struct Field {
  const char* key;
  Number Owner::*member;
  const char* unit;
  Range range;
  bool required = false;
};

constexpr std::array<Field<SceneDesc>, 9> scene_fields{{
    {"time_step", &SceneDesc::time_step, "s", {1e-9, 0.1, "any number above 0, at most 0.1"}},
    {"tolerance", &SceneDesc::tolerance, "1/s", {1e-6, 1e-3, "any number from 1e-6 to 1e-3"}},
    {"publish_rate", &SceneDesc::publish_rate, "Hz", {1e-3, 1e4, "any number above 0"}},
    // tf is buffered for 60 s: latency and timeout together must stay inside.
    {"tf_latency", &SceneDesc::tf_latency, "s", {0, 30, "0 or more, at most 30"}},
    {"tf_timeout", &SceneDesc::tf_timeout, "s", {1e-3, 30, "any number above 0, at most 30"}},
    {"max_frame_speed", &SceneDesc::max_frame_speed, "m/s", positive_or_infinite},
    {"jump_speed", &SceneDesc::jump_speed, "m/s", positive_or_infinite},
    {"winch_acceleration", &SceneDesc::winch_acceleration, "m/s^2", positive},
    {"apply_timeout", &SceneDesc::apply_timeout, "s", {1e-3, 1e6, "any number above 0"}},
}};

constexpr std::array<Field<SceneDesc, int>, 1> scene_integer_fields{{
    {"seed", &SceneDesc::seed, "", {0, largest_integer, "an integer"}},
}};

constexpr std::array<Field<LimitsDesc, int>, 3> limits_fields{{
    {"segments", &LimitsDesc::segments, "", {1, 1e7, "an integer"}},
    {"snapshots", &LimitsDesc::snapshots, "", {0, 1e4, "an integer"}},
    {"rollouts", &LimitsDesc::rollouts, "", {0, 1e3, "an integer"}},
}};

constexpr std::array<Field<FluidDesc>, 5> fluid_fields{{
    {"density", &FluidDesc::density, "kg/m^3", not_negative},
    {"surface", &FluidDesc::surface, "m", {-1e9, 1e9, "any number, or .inf", true}},
    {"normal_drag", &FluidDesc::normal_drag, "", not_negative},
    {"tangential_drag", &FluidDesc::tangential_drag, "", not_negative},
    {"depth", &FluidDesc::depth, "m", {1e-3, 1e9, "any number above 0, or .inf", true}},
}};

constexpr std::array<Field<WaveDesc>, 4> wave_fields{{
    {"amplitude", &WaveDesc::amplitude, "m", {0, 1e3, "0 or more"}, true},
    {"period", &WaveDesc::period, "s", {1e-3, 1e6, "any number above 0"}, true},
    {"direction", &WaveDesc::direction, "rad", {-1e9, 1e9, "any number"}},
    {"phase", &WaveDesc::phase, "rad", {-1e9, 1e9, "any number"}},
}};

constexpr std::array<Field<MaterialDesc>, 18> material_fields{{
    {"linear_density", &MaterialDesc::linear_density, "kg/m", positive, true},
    {"radius", &MaterialDesc::radius, "m", positive, true},
    {"axial_stiffness", &MaterialDesc::axial_stiffness, "N", positive_or_infinite},
    {"torsional_stiffness", &MaterialDesc::torsional_stiffness, "N m^2", not_negative},
    {"axial_damping", &MaterialDesc::axial_damping, "N s", not_negative},
    {"bending_damping", &MaterialDesc::bending_damping, "N m^2 s", not_negative},
    {"torsional_damping", &MaterialDesc::torsional_damping, "N m^2 s", not_negative},
    {"drag", &MaterialDesc::drag, "kg/(m s)", not_negative},
    {"friction", &MaterialDesc::friction, "", not_negative},
    {"rolling_friction", &MaterialDesc::rolling_friction, "", {0, 1, "any number from 0 to 1"}},
    {"breaking_tension", &MaterialDesc::breaking_tension, "N", positive_or_infinite},
    {"minimum_bend_radius", &MaterialDesc::minimum_bend_radius, "m", not_negative},
    {"maximum_tension", &MaterialDesc::maximum_tension, "N", positive_or_infinite},
    {"transverse_stiffness", &MaterialDesc::transverse_stiffness, "N/m^2", positive_or_infinite},
    {"maximum_squeeze", &MaterialDesc::maximum_squeeze, "N/m", positive_or_infinite},
    {"yield_curvature", &MaterialDesc::yield_curvature, "1/m", positive_or_infinite},
    {"hardening", &MaterialDesc::hardening, "", {0, 1, "any number from 0 to 1"}},
    {"bending_friction", &MaterialDesc::bending_friction, "N m", not_negative},
}};

constexpr Field<MaterialDesc, BendingStiffness> bending_stiffness_field{"bending_stiffness", &MaterialDesc::bending_stiffness,
                                                                        "N m^2", not_negative};

constexpr std::array<Field<CableDesc>, 2> cable_fields{{
    {"length", &CableDesc::length, "m", {1e-9, 1e9, "any number above 0"}, true},
    {"rest_twist", &CableDesc::rest_twist, "rad/m", {-1e9, 1e9, "any number"}},
}};

constexpr std::array<Field<CableDesc, int>, 1> cable_integer_fields{{
    {"segments", &CableDesc::segments, "", {1, 1e7, "an integer"}, true},
}};

constexpr std::array<Field<SectionDesc>, 2> section_fields{{
    {"from", &SectionDesc::from, "m", not_negative, true},
    {"to", &SectionDesc::to, "m", not_negative, true},
}};

constexpr std::array<Field<PointMassDesc>, 1> point_mass_fields{{
    {"mass", &PointMassDesc::mass, "kg", positive, true},
}};

constexpr std::array<Field<GravityDesc>, 1> gravity_fields{{
    {"mu", &GravityDesc::mu, "m^3/s^2", positive},
}};

constexpr std::array<Field<ParticleDesc>, 4> particle_fields{{
    {"mass", &ParticleDesc::mass, "kg", positive, true},
    {"restitution", &ParticleDesc::restitution, "", {0, 1, "any number from 0 to 1"}},
    {"friction", &ParticleDesc::friction, "", not_negative},
    {"radius", &ParticleDesc::radius, "m", positive},
}};

constexpr std::array<Field<GridDesc>, 1> grid_fields{{
    {"spacing", &GridDesc::spacing, "m", {1e-6, 1e6, "any number above 0"}, true},
}};

constexpr std::array<Field<GridDesc, int>, 2> grid_integer_fields{{
    {"rows", &GridDesc::rows, "", {1, 1e7, "an integer"}, true},
    {"columns", &GridDesc::columns, "", {1, 1e7, "an integer"}, true},
}};

constexpr std::array<Field<NetDesc>, 5> net_fields{{
    {"stiffness", &NetDesc::stiffness, "N/m", not_negative},
    {"damping", &NetDesc::damping, "N s/m", not_negative},
    {"tolerance", &NetDesc::tolerance, "", {1e-6, 0.9, "any number above 0, at most 0.9"}},
    {"restitution", &NetDesc::restitution, "", {0, 1, "any number from 0 to 1"}},
    {"friction", &NetDesc::friction, "", not_negative},
}};

constexpr std::array<Field<ShapeDesc>, 3> shape_fields{{
    {"radius", &ShapeDesc::radius, "m", positive},
    {"length", &ShapeDesc::length, "m", positive},
    {"thickness", &ShapeDesc::thickness, "m", not_negative},
}};

constexpr std::array<Field<BodyDesc>, 4> body_fields{{
    {"mass", &BodyDesc::mass, "kg", positive, true},
    {"friction", &BodyDesc::friction, "", not_negative},
    {"linear_damping", &BodyDesc::linear_damping, "N s/m", not_negative},
    {"angular_damping", &BodyDesc::angular_damping, "N m s", not_negative},
}};

constexpr std::array<Field<BodyFluidDesc>, 1> body_fluid_fields{{
    {"volume", &BodyFluidDesc::volume, "m^3", not_negative},
}};

constexpr std::array<Field<BodyFluidDesc, Vector3>, 3> body_fluid_axis_fields{{
    {"drag_area", &BodyFluidDesc::drag_area, "m^2", {0, 1e12, "three numbers, 0 or more"}},
    {"angular_drag", &BodyFluidDesc::angular_drag, "N m s^2", {0, 1e12, "three numbers, 0 or more"}},
    {"added_mass", &BodyFluidDesc::added_mass, "kg", {0, 1e12, "three numbers, 0 or more"}},
}};

constexpr std::array<Field<JunctionDesc>, 1> junction_fields{{
    {"mass", &JunctionDesc::mass, "kg", not_negative},
}};

constexpr std::array<Field<GuideDesc>, 3> sheave_fields{{
    {"radius", &GuideDesc::radius, "m", positive},
    {"inertia", &GuideDesc::inertia, "kg m^2", not_negative},
    {"bearing_friction", &GuideDesc::bearing_friction, "N m", not_negative},
}};

constexpr std::array<Field<GuideDesc>, 2> clip_fields{{
    {"retention", &GuideDesc::retention, "N", positive_or_infinite},
    {"capture", &GuideDesc::capture, "m", not_negative},
}};

/// [kg m^2] Of a body about an axis: from a milligram of some micrometres in size to a ship.
constexpr Range moment_of_inertia{1e-24, 1e24, "any number above 0"};

constexpr std::array<Field<RobotDesc>, 1> robot_fields{{
    {"padding", &RobotDesc::padding, "m", not_negative},
}};

constexpr std::array<Field<ContactDesc>, 1> contact_fields{{
    {"friction", &ContactDesc::friction, "", not_negative},
}};

/// Length limit of every name, also of frames and of obstacles of the topic, as each contact and each marker has a copy.
constexpr std::size_t most_name_characters = 1000;
/// Whether a scene may use `name` for a material, cable, attachment or obstacle: letters, digits and _, a letter first.
bool is_name(const std::string& name);
/// Whether `name` can be a tf frame: not empty, no leading /, no blanks or control characters.
bool is_frame_name(const std::string& name);

/// Whether shapes of a type have a key; all of these keys are required except `scale`.
bool has_dimension(ShapeType type, const std::string& key);

/// The names of materials, for messages: the first 20 of them.
std::string material_names(const std::vector<NamedMaterial>& materials);

/// What is allowed, for messages.
constexpr const char* scale_words = "one or three numbers other than 0; those below 0 mirror";
constexpr const char* name_words = "at most 1000 letters, digits and _, a letter first";
constexpr const char* frame_words = "a frame name without leading / and without blanks, at most 1000 characters";

}  // namespace verlet_cable
