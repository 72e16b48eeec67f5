#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// The part of a cable that no step changes, but only edits.
struct CableModel {
  std::string name;
  MaterialDesc material;                         ///< outside of sections: see CableMaterials
  std::string material_name;                     ///< in the scene
  std::vector<NamedMaterial> section_materials;  ///< of its sections, each once
  std::array<double, 4> color{0.1, 0.1, 0.1, 1.0};
  bool turns_bodies = false;  ///< it exerts moments on clamps of bodies that move freely
  bool is_twisted = false;    ///< by clamps at two places
  double segment_length = 0;  ///< [m] in the scene: winches pay out and take in segments of this length
};

/// What bending has left behind in half a segment, about the material's y and z axes [rad]: a joint between two segments has that
/// of the halves beside it, one beside a clamp that of its half.
struct HalfBend {
  std::array<double, 2> yielded{0, 0};  ///< that part of its material that yields would have where it is unstrained
  std::array<double, 2> slipped{0, 0};  ///< where the friction between its strands has no moment
};

/// Indicators of motion that substeps do not resolve: it alternates from each substep to the next.
struct UnresolvedMotion {
  std::vector<Vector3> acceleration_changes;  ///< [m/s^2] a node, n + 1, from the substep before the last to the last
  std::vector<Vector3> turns;  ///< [m/s^2] a node, n + 1: half the difference of the last change and the one before
  double changed = 0;          ///< [N^2/kg] sum over nodes and recent substeps: mass times the square of the turn,
                               ///< or of the change, where what is found is to be damped
  double turned = 0;           ///< [N^2/kg] likewise, mass times the one times the one before
  int known = 0;               ///< substeps since the motion began anew, up to 2: then changes are known
  int damped = 0;              ///< substeps that are still to damp
};

/// The part of a cable that steps change. Written by World only. A cable of n segments has n + 1 nodes; segment i joins nodes i
/// and i + 1. Running winches change n, too.
struct CableState {
  std::vector<double> rest_lengths;  ///< [m] a segment, n
  /// a segment, n: 0 for CableModel::material, k for the k-th of its `section_materials`; empty if all segments have the former
  std::vector<int> section_material;
  std::vector<double> masses;  ///< [kg] a node, n + 1: half of each neighbouring segment, and payloads
  /// [1/m] a node, n + 1: curvature about the material's y and z axes at which there is no moment; empty if the unloaded cable is
  /// straight
  std::vector<std::array<double, 2>> rest_curvature;
  std::vector<double> rest_twist;  ///< [rad/m] a node, n + 1: twist at which there is no torque; empty if it is zero
  /// a node, n + 1: which part of the cable within half a segment of it bends, above 0 to 1; empty if all of it does
  std::vector<double> flexible_fraction;
  /// a node, n + 1: for how many more steps it counts as beyond the limits of its material, of bend radius, and of tension and
  /// squeeze (of the segment that starts there); empty if its materials have no limits
  std::vector<std::array<int, 3>> beyond_limits;
  std::vector<Vector3> positions;   ///< [m] a node, n + 1
  std::vector<Vector3> velocities;  ///< [m/s] a node, n + 1, at the time of the positions
  /// [m/s^2] a node, n + 1, mean over the last substep: the initial guess of the next one
  std::vector<Vector3> accelerations;
  UnresolvedMotion unresolved;
  /// [N] a segment, n, > 0 is tension; mean over the last two substeps, or over the last one without numerical damping
  std::vector<double> tension;
  std::vector<double> last_tension;  ///< [N] a segment, n; mean over the last substep
  /// [N] a segment, n: the tension without the contributions of bending and twist; the initial guess of the next substep
  std::vector<double> axial_multiplier;
  /// 0 to 1: how far what cannot stretch yields between holders that draw it straight; as long as it is strained
  double yielding = 0;
  /// [J] that tension has stored in what cannot stretch: in the compliance that makes it unique between two holders, and where
  /// that yields
  double taut_energy = 0;
  std::vector<double> twist;  ///< [rad/m] a segment, n; 0 for a whole rod
  // Of a whole rod, empty otherwise
  std::vector<Vector3> directors;  ///< a segment, n: the material's y axis, a unit vector normal to the segment
  std::vector<double> spin;        ///< [rad/s] a segment, n, about its direction
  /// [rad] a node, n + 1, any number of turns: from the segment before it to the one after; at a clamped end between clamp and
  /// segment; 0 at other ends, and at inner clamps, whose targets store it
  std::vector<double> joint_twist;
  /// a segment, n: of its halves at its start and at its end; empty where nothing yields or rubs as it is bent
  std::vector<std::array<HalfBend, 2>> bending_memory;
  int reference_node = 0;  ///< where the orientation of the material is defined: the node of the first clamp
  Quaternion reference_orientation = Quaternion::Identity();  ///< there: x along the cable, roll of the material

  int segments() const { return static_cast<int>(rest_lengths.size()); }
  int nodes() const { return static_cast<int>(masses.size()); }
  double length() const;                     ///< [m] at rest
  double length(int first, int last) const;  ///< [m] at rest, between two nodes
  std::vector<double> arc_length() const;    ///< [m] a node, n + 1, from the start, at rest
  /// [m] the part that bends, of the length `around` of cable at a node
  double bending_length(int node, double around) const {
    return flexible_fraction.empty() ? around : flexible_fraction[node] * around;
  }
};

struct SimulatedCable {
  std::shared_ptr<const CableModel> model;  ///< shared by copies; an edit replaces it
  CableState state;
};

/// Whether bending and twist depend on each other through the material's axes: such a cable has a material frame per segment, in
/// `directors`, `spin` and `joint_twist` of its state. Others, straight at rest and as stiff about y as about z, need none: what
/// was bent before must not matter either.
bool is_whole_rod(const CableModel& model, const CableState& state);

/// Shapes derived from positions, for display and messages. n segments.
std::vector<Quaternion> segment_orientations(const CableState& state);  ///< n: x along the segment, roll of the material
std::vector<double> node_curvature(const CableState& state);            ///< [1/m] n - 1, inner nodes
std::vector<double> node_twist(const CableState& state);                ///< [rad/m] n - 1, inner nodes
/// [1/m] n - 1, inner nodes: by which yielding has bent what carries no moment; empty where nothing can yield.
std::vector<double> plastic_curvature(const SimulatedCable& cable);
double strain(const CableState& state, int segment);  ///< l / l0 - 1

/// The point of a cable nearest to `point`.
struct NearestPoint {
  int segment = 0;
  double fraction = 0;  ///< along the segment, 0 to 1
  double distance = 0;  ///< [m]
};
NearestPoint nearest_point(const CableState& state, const Vector3& point);

}  // namespace verlet_cable
