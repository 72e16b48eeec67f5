#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "verlet_cable/core/attachment_desc.h"
#include "verlet_cable/core/body_desc.h"
#include "verlet_cable/core/guide_desc.h"
#include "verlet_cable/core/junction_desc.h"
#include "verlet_cable/core/shape_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// EI [N m^2] about the material's y and z axes; one number means both.
struct BendingStiffness : std::array<double, 2> {
  BendingStiffness(double about_both = 0) : array{about_both, about_both} {}
  BendingStiffness(double about_y, double about_z) : array{about_y, about_z} {}

  bool is_isotropic() const { return front() == back(); }
  double smallest() const { return std::min(front(), back()); }
  double largest() const { return std::max(front(), back()); }
};

/// The material of a cable. Ranges: see `validate`.
struct MaterialDesc {
  double linear_density = 0;           ///< [kg/m] of rest length, > 0
  double radius = 0;                   ///< [m], > 0
  double axial_stiffness = infinity;   ///< EA [N], > 0; infinite: inextensible
  BendingStiffness bending_stiffness;  ///< EI [N m^2], >= 0
  double torsional_stiffness = 0;      ///< GJ [N m^2], >= 0
  double axial_damping = 0;            ///< [N s] force per strain rate, >= 0
  double bending_damping = 0;          ///< [N m^2 s] moment per curvature rate, >= 0
  double torsional_damping = 0;        ///< [N m^2 s] moment per twist rate, >= 0
  double drag = 0;                     ///< [kg/(m s)] linear drag per unit length, >= 0
  double friction = 0.5;               ///< Coulomb coefficient against obstacles, >= 0
  double rolling_friction = 1;         ///< without torsional stiffness: part of friction that resists rolling, 0 to 1
  double breaking_tension = infinity;  ///< [N], > 0
  double minimum_bend_radius = 0;      ///< [m], >= 0; a smaller radius is reported as an event; 0: never
  double maximum_tension = infinity;   ///< [N], > 0; a larger tension is reported as an event
  /// [N/m^2], > 0: force per length and compression of the section between what squeezes it; infinite: stiff
  double transverse_stiffness = infinity;
  double maximum_squeeze = infinity;  ///< [N/m], > 0; a larger force per length across the cable is reported as an event
  double yield_curvature = infinity;  ///< [1/m], > 0; bending beyond it stays; infinite: never
  double hardening = 0;               ///< bending stiffness beyond the yield curvature over that before, 0 to 1
  double bending_friction = 0;        ///< [N m] moment of dry friction between strands, >= 0

  /// Whether it matters how a cable was bent before.
  bool remembers_bending() const { return (yield_curvature < infinity && hardening < 1) || bending_friction > 0; }
};

struct PointMassDesc {
  PlaceDesc place;
  double mass = 0;  ///< [kg], > 0; added to the node's mass
};

struct InitialShapeDesc {
  enum class Type { automatic, straight, catenary, points, settled };
  Type type = Type::automatic;
  Vector3 from = Vector3::Zero();   ///< straight: the first node [m]
  Vector3 to = Vector3::UnitX();    ///< straight: gives the direction
  std::vector<Vector3> points;      ///< points: polyline [m]
  std::vector<Vector3> velocities;  ///< points: [m/s], none or one per point

  /// Whether the places of nodes are given, and not where the cable hangs.
  bool is_given() const;
};

/// The shape at which there is no bending moment.
struct RestCurvatureDesc {
  enum class Type { straight, initial, constant, profile };
  Type type = Type::straight;
  std::array<double, 2> curvature{0, 0};  ///< constant: about the material's y and z axes [1/m]
  /// profile: the same at points that are evenly spaced from start to end, at least two, linear in between [1/m]
  std::vector<std::array<double, 2>> profile;
  /// Zero curvatures count as curved, too: then cables that differ only in these numbers obey the same law, which a fit needs.
  bool zero_counts = false;

  /// Whether it is straight by these values alone; an `initial` shape may be straight as well.
  bool is_straight() const;
};

/// A part of a cable with another material. It consists of whole segments: those whose midpoint is in it.
struct SectionDesc {
  double from = 0, to = 0;  ///< [m] from the cable's start, at rest; 0 to its length
  std::string material;     ///< a key of SceneDesc::materials
};

struct CableDesc {
  std::string name;
  double length = 0;                                ///< [m] rest length, > 0
  int segments = 0;                                 ///< >= 1; all equally long
  std::string material;                             ///< a key of SceneDesc::materials
  std::vector<SectionDesc> sections;                ///< of other materials; they do not overlap
  std::array<double, 4> color{0.1, 0.1, 0.1, 1.0};  ///< red, green, blue, alpha; 0 to 1
  InitialShapeDesc initial;
  RestCurvatureDesc rest_curvature;
  double rest_twist = 0;                   ///< [rad/m] twist at which there is no torque
  std::array<double, 2> stiff_ends{0, 0};  ///< [m] at start and end that do not bend, in plugs, sleeves or grips; >= 0
  std::vector<AttachmentDesc> attachments;
  std::vector<PointMassDesc> point_masses;
};

/// A solid that cables cannot enter. Its pose is in its frame.
struct ObstacleDesc : ShapeDesc {
  std::string name;
  std::string frame;                        ///< empty: the fixed frame
  std::optional<double> friction;           ///< Coulomb coefficient, >= 0; none: that of the cable's material
  std::optional<InitialPose> initial_pose;  ///< of the frame, until another pose is known
  double padding = 0;                       ///< [m] added all around, >= 0
};

/// A link of a robot, as in its URDF.
struct LinkDesc {
  std::string name;                     ///< also of its frame
  int parent = -1;                      ///< index of a link before this one; -1: the root
  bool fixed = false;                   ///< to its parent
  InitialPose origin{};                 ///< in its parent, with the joint at zero
  std::vector<ObstacleDesc> obstacles;  ///< its geometry, in its own frame; none if it is not an obstacle
};

/// A robot whose links are obstacles.
struct RobotDesc {
  /// What becomes of geometry without size or triangles, and of meshes that cannot be read.
  enum class OnBadMesh { warn, error };
  enum class Geometry { collision, visual, collision_or_visual };
  std::string description = "robot_description";  ///< the parameter that holds the URDF
  std::string file;                               ///< URDF file, instead of the parameter
  std::vector<std::string> links;                 ///< those that are obstacles; empty: all
  double padding = 0;                             ///< [m] added all around, >= 0
  OnBadMesh on_bad_mesh = OnBadMesh::warn;
  Geometry geometry = Geometry::collision;
  std::vector<LinkDesc> tree;         ///< all links, parents first; filled in when the URDF is read
  std::vector<std::string> left_out;  ///< a line for each geometry that is not there: key, file and reason; likewise
};

/// Contact of cables with themselves and each other.
struct ContactDesc {
  bool self = true;
  bool between_cables = true;
  double friction = 0.3;  ///< Coulomb coefficient of cable against cable, >= 0
};

/// Uniform gravity, or that of a point mass: mu / r^2 towards a center. It acts on cables, bodies, nets and particles.
struct GravityDesc {
  enum class Type { uniform, central };
  Type type = Type::uniform;
  Vector3 acceleration{0, 0, -9.81};  ///< [m/s^2] uniform
  double mu = 1;                      ///< [m^3/s^2] central, > 0: the gravitational constant times the mass in the center
  Vector3 center = Vector3::Zero();   ///< [m] central

  Vector3 at(const Vector3& position) const;           ///< [m/s^2] zero in the center
  double potential_at(const Vector3& position) const;  ///< [J/kg] zero at the origin (uniform) or at infinity (central)
};

/// A free material point.
struct ParticleDesc {
  std::string name;
  double mass = 0;                     ///< [kg], > 0
  Vector3 position = Vector3::Zero();  ///< [m]
  Vector3 velocity = Vector3::Zero();  ///< [m/s]
  double restitution = 1;              ///< of its bounces off obstacles, 0 to 1 (elastic)
  double friction = 0;                 ///< Coulomb coefficient against obstacles that have none, >= 0
  double radius = 0.02;                ///< [m] of the sphere that displays it, > 0; for contact it is a point
  std::array<double, 4> color{0.1, 0.3, 0.8, 1.0};
};

/// Nodes in rows and columns: node = row * columns + column; row 0 starts at the origin, columns along x_axis, rows along y_axis.
/// Links: horizontal, vertical, both diagonals.
struct GridDesc {
  int rows = 0;                        ///< >= 1
  int columns = 0;                     ///< >= 1
  double spacing = 0;                  ///< [m] > 0
  Vector3 origin = Vector3::Zero();    ///< [m]
  Vector3 x_axis = Vector3::UnitX();   ///< a direction
  Vector3 y_axis = -Vector3::UnitZ();  ///< a direction that is not parallel to x_axis
};

enum class LinkType { spring, limited, rigid };

/// A hinge that holds a node of a net.
struct NetAttachmentDesc {
  std::string name;
  int node = 0;
  std::string frame;                 ///< empty: the fixed frame
  Vector3 offset = Vector3::Zero();  ///< [m] in the frame
  std::optional<InitialPose> initial_pose;
};

/// The smallest distance that two nodes may have.
struct MinimumDistanceDesc {
  std::array<int, 2> nodes{0, 0};
  double distance = 0;  ///< [m] > 0
};

/// Particles joined by links: either a grid, or nodes and links.
struct NetDesc {
  std::string name;
  std::optional<GridDesc> grid;
  std::vector<Vector3> nodes;             ///< [m] without a grid; at rest
  std::vector<std::array<int, 2>> links;  ///< without a grid: pairs of nodes
  double mass = 0;                        ///< [kg] of the whole net, > 0, shared evenly; or
  std::vector<double> masses;             ///< [kg] a node, > 0
  LinkType link_type = LinkType::spring;
  double stiffness = 500;                              ///< [N/m] >= 0; spring and limited
  double damping = 0.5;                                ///< [N s/m] >= 0; spring and limited
  double tolerance = 0.1;                              ///< limited: largest |l / l0 - 1|
  std::vector<MinimumDistanceDesc> minimum_distances;  ///< limited and rigid
  Vector3 velocity = Vector3::Zero();                  ///< [m/s] of all nodes at the start
  double restitution = 0;                              ///< of bounces off obstacles, 0 to 1
  double friction = 0.5;                               ///< Coulomb coefficient against obstacles that have none, >= 0
  std::array<double, 4> color{0.7, 0.2, 0.1, 1.0};
  std::vector<NetAttachmentDesc> attachments;

  std::size_t node_count() const;
  std::size_t link_count() const;
};

/// How particles and nets of springs are integrated over time.
struct IntegratorDesc {
  enum class Type { verlet, euler, rk4, pc5 };
  /// In Verlet's method: r(1) = r(0) + h v(0) + 1/2 h^2 f(0)/m, or the lecture's r(1) = r(0) + h v(0) + h^2 f(0)/m.
  enum class FirstStep { taylor, lecture };
  Type type = Type::verlet;
  FirstStep first_step = FirstStep::taylor;
};

/// A linear wave on the fluid's surface: at the point x and the time t it is amplitude cos(k . x - 2 pi t / period + phase) high.
struct WaveDesc {
  double amplitude = 0;  ///< [m], >= 0
  double period = 0;     ///< [s], > 0
  double direction = 0;  ///< [rad] in which it runs, from x towards y
  double phase = 0;      ///< [rad]
};

/// The fluid around the cables. Its drag is quadratic, with the diameter as reference width, and adds to the linear drag.
struct FluidDesc {
  double density = 0;                  ///< [kg/m^3], >= 0
  Vector3 velocity = Vector3::Zero();  ///< [m/s]; applies to the linear drag, too, for any density
  double surface = infinity;           ///< [m] z below which there is fluid
  double normal_drag = 1.2;            ///< coefficient normal to the cable, >= 0
  double tangential_drag = 0.01;       ///< coefficient along the cable, >= 0
  double depth = infinity;             ///< [m] of the water below `surface`, for waves, > 0
  std::vector<WaveDesc> waves;         ///< on `surface`
};

enum class LostFramePolicy { hold, release, pause };
enum class TimeJumpPolicy { reset, keep };
enum class MarkerStyle { tube, line };
enum class ColorBy { cable, tension, strain, contact, bend };

struct LimitsDesc {
  int segments = 100000;
  int snapshots = 32;
  int rollouts = 16;
};

struct NamedMaterial {
  std::string name;
  MaterialDesc material;
};

/// A whole scene: plain values with defaults. Names, units and ranges are those of the scene's keys.
struct SceneDesc {
  std::string frame_id = "world";
  double time_step = 0.001;  ///< [s], > 0
  /// If true, motion that a step cannot resolve dies out within some steps; else energy is conserved and such motion persists.
  bool numerical_damping = true;
  double tolerance = 1e-5;  ///< [1/s] velocity error, in segment lengths, at which the iteration of a cable ends; 1e-6 to 1e-3
  GravityDesc gravity;
  FluidDesc fluid;
  double publish_rate = 50;  ///< [Hz], > 0
  double tf_latency = 0.05;  ///< [s], >= 0
  double tf_timeout = 0.5;   ///< [s], > 0
  LostFramePolicy on_lost_frame = LostFramePolicy::hold;
  double max_frame_speed = infinity;  ///< [m/s], > 0
  double apply_timeout = 0.1;         ///< [s], > 0: for so long what a message applies to a body lasts at most
  double jump_speed = 5;              ///< [m/s], > 0: a frame that is faster between two samples, and not for longer, has jumped
  double winch_acceleration = 1;      ///< [m/s^2], > 0: with which winches speed up
  TimeJumpPolicy on_time_jump = TimeJumpPolicy::reset;
  MarkerStyle marker_style = MarkerStyle::tube;
  ColorBy color_by = ColorBy::tension;
  bool broadcast_tf = true;  ///< poses of the bodies as tf frames with the names of the bodies
  /// [m] in the fixed frame: what is drawn is given relative to this point, as viewers and clouds have single precision
  Vector3 origin = Vector3::Zero();
  std::string scene_directory;
  LimitsDesc limits;
  int seed = 0;
  std::vector<NamedMaterial> materials;  ///< that the cables name
  std::vector<CableDesc> cables;
  std::vector<ParticleDesc> particles;
  std::vector<NetDesc> nets;
  std::vector<BodyDesc> bodies;
  std::vector<JunctionDesc> junctions;
  std::vector<GuideDesc> guides;  ///< those of one cable in the order of their arc lengths
  IntegratorDesc integrator;
  std::vector<ObstacleDesc> obstacles;
  std::optional<RobotDesc> robot;
  std::optional<ContactDesc> contact;  ///< none: no contact between cables or of a cable with itself

  const MaterialDesc* find_material(const std::string& name) const;
};

/// All errors of a scene: one line per error, each with the full key, the value and what is allowed.
class SceneError : public std::runtime_error {
 public:
  explicit SceneError(std::vector<std::string> errors);
  const std::vector<std::string>& errors() const { return errors_; }

 private:
  std::vector<std::string> errors_;
};

/// All errors of a scene, empty if there are none: values out of range, names used twice, unknown materials, attachments at one
/// node, missing meshes of obstacles, conflicting `initial_pose` of a frame, cables shorter than the distance between their
/// attachments at the initial poses. Keys are written as in YAML: `cables[0].attachments[1].frame`.
std::vector<std::string> validate(const SceneDesc& scene);

/// What is allowed in a scene without errors, and probably not meant: one line each, with the full key, the value and what was
/// made of it. Now: sizes, densities and time steps that are mostly in the wrong unit, sections whose ends are off the ends of
/// segments by more than 5 % of the section's length, and what a robot does without.
std::vector<std::string> warnings_of(const SceneDesc& scene);

/// The obstacles of the scene, then those of the links of its robot.
std::vector<ObstacleDesc> all_obstacles(const SceneDesc& scene);

/// The pose that the six numbers of a scene describe.
Pose pose_of(const InitialPose& pose);

/// Index of the section of a cable to which a segment belongs; -1 if it belongs to none.
int section_at(const CableDesc& cable, int segment);

/// The node at a place on a cable; for an arc length, the nearest node.
int node_at(const CableDesc& cable, const PlaceDesc& place);

}  // namespace verlet_cable
