#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vector_array.h"

namespace verlet_cable {

/// Links that are alike: link `first + k * stride` joins the nodes `first_node + k * stride` and `second_node + k * stride`. No
/// node is in two of them, so that they may be treated in any order, or at once.
struct LinkRun {
  int first = 0, first_node = 0, second_node = 0;
  int stride = 1;
  int count = 0;
};

/// The law of a link over a step of h: the impulse P on its nodes, pushing them apart, is that of a spring and damper where the
/// link will be at the end of the step (backward Euler), or whatever else is needed to keep its length l' between two bounds:
///   P = -h (stiffness (l' - l0) + damping (l' - l) / h)   or   l' = shortest   or   l' = longest
struct LinkLaw {
  double rest_length = 0;            ///< [m] l0
  double shortest = 0, longest = 0;  ///< [m]
  double stiffness = 0;              ///< [N/m]
  double damping = 0;                ///< [N s/m]
};

/// The nodes and links that the rows work on. Directions are those at the start of the step, so that impulses keep angular
/// momentum, too (as in SHAKE: Ryckaert, Ciccotti and Berendsen 1977).
struct LinkArrays {
  VectorArray position;                ///< nodes: at the start of the step [m]
  VectorArray velocity;                ///< nodes: over the step [m/s]
  std::vector<double> inverse_mass;    ///< nodes: [1/kg], 0 where held
  std::vector<double> impulse;         ///< links: P [N s]
  std::vector<double> inverse_length;  ///< links: 1 / l at the start of the step [1/m]
};

/// Sets the inverse lengths, and applies the impulses that the links have from the step before.
void start_links(const LinkRun& run, LinkArrays& arrays);
/// One sweep: each link's law is fulfilled in turn, with what its nodes do at present (projected Gauss-Seidel).
void sweep_links(const LinkRun& run, const LinkLaw& law, double h, LinkArrays& arrays);

/// Squares of the lengths at the end of the step, relative to the rest length.
struct SquareRange {
  double least = 0, largest = 0;
  bool turned = false;  ///< a link's direction changes by more than 30 degrees within the step
};
SquareRange measure_links(const LinkRun& run, double rest_length, double h, const LinkArrays& arrays);

/// A node as corrections of single links work on it: those come in no order, so that all of a node is in one line of the cache.
struct alignas(64) LooseNode {
  Vector3 position;         ///< at the start of the step [m]
  Vector3 velocity;         ///< over the step [m/s]
  double inverse_mass = 0;  ///< [1/kg], 0 where held
};
inline LooseNode loose_node(int node, const LinkArrays& arrays) {
  return {get(arrays.position, node), get(arrays.velocity, node), arrays.inverse_mass[node]};
}

/// [m] From a node to another at the end of the step.
inline Vector3 end_way(const LooseNode& i, const LooseNode& j, double h) {
  return j.position - i.position + h * (j.velocity - i.velocity);
}

/// Brings one link to `length` [m]: the part of `sweep_links` that is left when nothing but bounds counts. `end`: its way at the
/// end of the step, `before` its length. By an impulse along its direction at the start of the step, or by one along that at the
/// end, which finds a way where the former cannot (a net in a plane cannot be kept in shape along its links when it leaves the
/// plane), but is no part of the link's impulse: then what the second node was given [N s] is returned, else nothing.
Vector3 set_length(double length, const Vector3& end, double before, double inverse_length, bool along_end, double h,
                   LooseNode& i, LooseNode& j, double& impulse);

}  // namespace verlet_cable
