#pragma once

#include <vector>

#include "net/link_rows.h"
#include "target/boundary.h"
#include "verlet_cable/core/net.h"

namespace verlet_cable {

/// Where a net is held, no node can be further away than the links between are long at most. That follows from the links' own
/// bounds, but takes a sweep for each link on the way to be felt; asked for at once, the load of a large net does not stretch it
/// at first (Kim, Chentanez and Müller-Fischer, Long Range Attachments: A Method to Simulate Inextensible Clothing, 2012).
class LongRangeAttachments {
 public:
  /// `stretch`: largest length of a link over its rest length.
  void resize(const NetModel& model, const std::vector<HeldNode>& held, double stretch);
  /// Takes away the velocities with which nodes would end a step of h [s] further away than they can be.
  void pull(const std::vector<HeldNode>& held, double h, LinkArrays& arrays);
  /// [N s] that the last `pull` exerted on a held node, by its index.
  const Vector3& impulse(std::size_t held) const { return impulses_[held]; }
  /// A held node that is further from another than `stretch` times the links between are long, -1: none.
  int overstretched_node(const std::vector<HeldNode>& held, double stretch) const;
  int most_links() const { return most_links_; }  ///< from a node to the nearest held one

 private:
  struct Way {
    double length = 0;  ///< [m]
    int held = 0;       ///< index of the held node where it begins
  };
  struct Tether {
    int node = 0, held = 0;  ///< the second an index of the held nodes
    double length = 0;       ///< [m]
  };
  void find_spans(const std::vector<std::vector<Way>>& ways);

  /// The links between two held nodes, along the shortest way that is known.
  struct Span {
    int first = 0, second = 0;  ///< indices of the held nodes
    double length = 0;          ///< [m]
  };
  std::vector<Tether> long_range_attachments_;  ///< ascending nodes
  std::vector<Span> spans_;
  std::vector<Vector3> impulses_;
  int most_links_ = 0;
};

}  // namespace verlet_cable
