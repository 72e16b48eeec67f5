#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "particle/particle_stepper.h"
#include "scene/harnesses.h"
#include "scene/start_places.h"
#include "verlet_cable/core/scene_fields.h"
#include "world/island_stepper.h"
#include "world/islands.h"
#include "world/junctions.h"
#include "world/limits.h"
#include "world/not_copied.h"
#include "world/state.h"
#include "world/workspace.h"

namespace verlet_cable {

class Problems;

struct World::Implementation {
  State state;
  Findings findings;
  bool one_by_one = false;                       ///< as World::step_one_by_one asks
  int most_lanes = widest_lanes();               ///< as World::limit_lanes asks
  std::size_t told_unsettled = 0;                ///< of findings.unsettled, those that a step has told
  const std::atomic<bool>* cancelled = nullptr;  ///< during construction
  // Scratch, and what follows from the state
  NotCopied<Workspaces> workspaces;
  NotCopied<Islands> islands;
  NotCopied<std::vector<CableOutcome>> cable_outcomes;    ///< one a cable
  NotCopied<std::vector<IslandOutcome>> island_outcomes;  ///< one an island
  NotCopied<std::vector<NetSolver>> net_solvers;          ///< one a net
  NotCopied<ParticleStepper> particle_stepper;
  NotCopied<std::vector<Squeeze>> squeezes;
  NotCopied<std::vector<MovingObstacle>> moving_obstacles;  ///< of nets, particles and cables that settle

  // Stages of a step
  void begin_step(const BoundaryInputs& inputs, StepResult& result);
  void end_step(StepResult& result);
  void count_step();
  void forget_last_step();
  int update_frames(const BoundaryInputs& inputs);
  void advance_winches();
  void advance_guides();
  void wind_drives();
  void build_islands();
  void advance_islands();
  void step_islands(std::size_t from, std::size_t to, IslandStepper& stepper);
  void resume_islands(bool one_by_one);
  void collect_outcomes(StepResult& result);
  void close_ledger();
  Energy energy() const;
  double follow_energies();
  double energy_of_nets_and_particles() const;
  void begin_account(double of_nets_before);
  void account_for_edit_since(double energy_before);
  void apply_breaks(StepResult& result);
  void end_loads();
  void end_loads_of(int cable, int node);
  void note(const StatusFinding& found, StepResult& result);
  void note_unsettled(std::size_t first);
  void step_nets_and_particles(StepResult& result);

  bool is_cancelled() const { return cancelled && *cancelled; }
  void name_waiting();
  void start_cable(const CableDesc& desc, const FrameIds& ids, const BoundaryInputs& inputs);
  void start_net(const NetDesc& desc, const FrameIds& ids, const BoundaryInputs& inputs);

  // Edits
  EditResult apply(const edit::Pin& pin);
  EditResult apply(const edit::Unpin& unpin);
  EditResult apply(const edit::MoveAttachment& move);
  EditResult apply(const edit::Cut& cut);
  EditResult apply(const edit::SetLength& change);
  EditResult apply(const edit::SetTension& change);
  std::string refused_winch(int cable, bool at_end) const;
  void end_loose_winch(int cable);
  double fastest_winch(int cable) const;
  double longest_cable(int cable) const;
  LengthDrive winch_at(int cable, bool at_end, double speed) const;
  EditResult apply(const edit::Join& join);
  EditResult apply(const edit::SetObstacle& set);
  EditResult apply(const edit::RemoveObstacle& remove);
  EditResult apply(const edit::ApplyLoad& request);
  EditResult apply(const edit::SetState& set);
  EditResult set_checked(const edit::SetState& set, std::vector<char> is_changed);
  void put_cable(const edit::SetState::OfCable& of, Problems& problems);
  EditResult cut_cable(int cable, int segment);
  EditResult cut_link(int net, int link);
  void update_net(int net);
  void add_particle(const ParticleDesc& desc);
  void add_bodies();
  void add_body(SimulatedBody body);
  void add_junctions();
  void place_bodies();
  void yield_to_shape(int cable);
  void settle_started_bodies(const std::vector<int>& descs);
  bool place_body(int index);
  Vector3 hanging_gravity(const SimulatedCable& cable, const std::vector<Attachment>& placing, const Vector3& place) const;
  void note_placed(int index);
  bool is_held_by_cable(int index) const;
  bool waits_for_cable(int index) const;
  bool has_bodies_of(const CableDesc& cable) const;
  void place_bodies_on(const std::vector<Attachment>& attachments);
  std::vector<int> with_trunks_first(const std::vector<int>& cables) const;
  std::vector<Attachment> junction_attachments(const CableDesc& desc, int cable) const;
  std::optional<JunctionPlace> place_on_trunk(const CableDesc& desc) const;
  std::optional<InitialShapeDesc> shape_from_trunk(const CableDesc& desc) const;
  StartPlaces start_places_of(const std::vector<int>& descs, bool junctions_only) const;
  void place_hanging_bodies(const std::vector<int>& descs);
  void note_unreached(const std::vector<std::string>& lines);
  void bring_to_junctions(const std::vector<int>& descs);
  bool is_loose(int cable) const;
  void weld_junctions(const std::vector<int>& descs);
  void weld(int attachment);
  Quaternion axes_on_trunk(const JunctionDesc& junction) const;
  void start_with_bodies(const CableState& cable, KinematicTargets& targets) const;
  NetSolver& solver_of(int net);
  void step_net(int net, StepResult& result);
  void aim_net(int net, StepResult& result);
  void step_particle(int particle, StepResult& result);
  void add_net_energy(Energy& energy) const;
  bool is_attachment(const std::string& name) const;
  void add_scene_obstacles();
  void find_obstacle_anchors();
  void find_targets_of(int cable);
  void fit_frames(int cable);
  void plan_drive_step(int cable);
  void plan_drive_of(int cable);
  double available_length(int cable) const;
  double slack_at_winch(int cable) const;
  void remesh_winch(int cable);
  void pass_nodes_of(int cable);
  bool lets_go(int attachment) const;
  void release_guide(int attachment);
  void release_wheels_on(int cable, int segment);
  void release_bare_guides();
  void capture_cable(int guide);
  void account_for_blow(int cable);
  void erase_attachment(int attachment);
  void add_winch_node(int cable);
  void take_in_winch_node(int cable);
  void close_joint(int cable);
  void reverse_cable(int cable);
  void renumber(int cable, int first_node, int shift);
  void follow_cut(int cable, int segment, int new_cable);
  void follow_join(int first, int second);
  void after_remeshing(int cable);
  void forget_contacts(int cable);
};

/// Of an edit that changes nothing; the message says why.
inline EditResult refused(const std::string& message) {
  return {false, message, {}};
}

/// Why a body has no such node to hold or to load; empty if it has.
std::string node_problem(const State& state, const BodyId& body, int node);

/// What is wrong with a vector that has a component outside of a range, under the name of its field; empty if nothing is.
std::string vector_problem(const std::string& field, const Vector3& vector, const Range& range, const char* unit);

/// What is wrong with a pose that is not sound, under the name of its field; empty if nothing is.
std::string pose_problem(const std::string& field, const Pose& pose);

}  // namespace verlet_cable
