#pragma once

#include "contact/point_contact.h"
#include "net/link_rows.h"
#include "net/long_range_attachments.h"
#include "net/step.h"
#include "net/wind.h"
#include "target/boundary.h"

namespace verlet_cable {

/// What a net of limited or rigid links takes from one step to the next, besides its state.
struct LinkMemory {
  std::vector<Vector3> midstep_velocities;  ///< [m/s] a node, half a step before: (r(n) - r(n-1)) / h
  std::vector<double> impulses;             ///< [N s] a link, then a minimum distance: where the next step's solution starts
  bool started = false;                     ///< the first is set
};

/// Advances a net of limited or rigid links by Verlet's recursion r(n+1) = 2 r(n) - r(n-1) + h^2 f/m, the links' forces and
/// bounds by impulses at its end (Provot, Deformation Constraints in a Mass-Spring Model to Describe Rigid Cloth Behavior, 1995).
/// They begin as in the step before, so that what hangs still is solved already; a few sweeps follow it where it moves, tethers
/// bound the whole, and what is then still outside its bounds is corrected alone, with its neighbours, until nothing is.
class NetConstraintSolver {
 public:
  /// Sets what no step changes: after pins and cuts, too.
  void resize(const NetModel& model, const std::vector<HeldNode>& held, double h);
  /// [visits] (rod/work_budget.h) that the next step may take, and that the last one took.
  void allow_work(double most) { most_work_ = most; }
  double work() const { return work_; }
  /// In parts where links turn too far within the step: impulses along their directions at its start keep no energy there.
  NetStepResult advance(const NetStep& step, NetState& state, LinkMemory& memory);

 private:
  struct Row {
    LinkRun run;
    LinkLaw law;
    double shortest = 0, longest = 0;  ///< [m] what must be kept
    bool is_link = true;               ///< not a minimum distance
  };
  /// What corrections of a link need to know of it.
  struct Bounds {
    std::array<int, 2> nodes;
    double shortest = 0, longest = 0;              ///< [m] as of its row
    double aimed_shortest = 0, aimed_longest = 0;  ///< [m] where it is brought to
  };

  void add_rows(const NetModel& model, double h);
  void connect(std::size_t nodes);
  double work_of_parts(const NetModel& model, int parts) const;
  NetStepResult advance_in_parts(int parts, const NetStep& step, NetState& state, LinkMemory& memory);
  void advance_part(const NetStep& step, NetState& state, LinkMemory& memory, NetStepResult& result);
  void judge(const NetStep& step, NetStepResult& result) const;
  int overstretched_node(const NetStep& step) const;
  int unsolved_node() const;
  void load(const NetStep& step, const NetState& state, LinkMemory& memory);
  void begin(const NetStep& step, const NetState& state, LinkMemory& memory);
  void apply_loads(const NetStep& step);
  void find_contacts(const NetStep& step);
  void start();
  void sweep(const NetModel& model, bool forwards);
  void press_contacts();
  bool measure(NetStepResult& result);
  void keep_bounds(NetStepResult& result);
  void list_outside(const Row& row);
  double correct_once(bool along_end);
  void list_neighbours(int node);
  void react(const NetStep& step, const LinkMemory& memory) const;
  void store(const NetStep& step, NetState& state, LinkMemory& memory) const;

  int parts_ = 1, part_ = 0;  ///< of the step, and which of them it is
  double h_ = 0;              ///< [s] of a part
  bool turned_ = false;       ///< links turn too far within the part
  double work_ = 0;           ///< [visits] that the step has taken so far
  double most_work_ = 0;      ///< [visits] that it may take
  bool exhausted_ = false;    ///< corrections ended because of that
  NetState state_before_;
  LinkMemory memory_before_;
  /// What an attempt in fewer parts came to.
  struct Outcome {
    NetState state;
    LinkMemory memory;
    NetStepResult result;
    std::vector<HeldNode> held;
  };
  Outcome coarser_;
  Boundary boundary_;  ///< at the end of a part
  std::vector<Row> rows_;
  std::vector<std::array<int, 2>> nodes_;  ///< of a link or minimum distance
  std::vector<int> row_of_;                ///< of a link or minimum distance, -1 between held nodes
  std::vector<Bounds> bounds_;             ///< of a link or minimum distance, if it has a row
  std::vector<int> first_at_, links_at_;   ///< the links at a node: links_at_[first_at_[node]] to [first_at_[node + 1]]
  LinkArrays arrays_;
  NetWind wind_;
  LongRangeAttachments long_range_attachments_;
  double kept_part_ = 1;  ///< of the impulses of the step before
  std::vector<NodeContact> contacts_;
  std::vector<int> held_links_;              ///< both of whose nodes are held
  std::vector<int> held_at_;                 ///< by node: index of what holds it, -1: none
  std::vector<Vector3> bound_impulses_;      ///< [N s] of links' bounds on what is held, besides the links' own impulses
  std::vector<int> outside_, next_outside_;  ///< links to look at
  std::vector<char> listed_;                 ///< by link; those between held nodes are never to be listed
  std::vector<LooseNode> loose_nodes_;
};

}  // namespace verlet_cable
