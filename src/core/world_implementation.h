#pragma once

#include <atomic>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cable_stepper.h"
#include "contact_group.h"
#include "holders.h"
#include "link_stepper.h"
#include "particle_stepper.h"
#include "reel.h"
#include "spring_stepper.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// No substep is shorter [s]; a cable that needs one has lost its way.
constexpr double shortest_substep = 1e-6;

/// What a cable needs besides its model and state.
struct CableScratch {
  Holders holders;
  CableStepper stepper;
  Boundary boundary;
  std::vector<TwistSpan> spans;
  std::vector<Jump> jumps;   ///< that this step found to be over
  std::optional<Reel> reel;  ///< of a winch that runs, or of a joint that closes
};

/// What a net needs besides its model and state: springs or links, by its kind, and what they remember.
struct NetScratch {
  Holders holders;
  Boundary boundary;
  SpringStepper springs;
  PointState point_memory;
  LinkStepper links;
  LinkMemory link_memory;
  NetState before;  ///< the step
};

/// A cable on its way to equilibrium, alone.
struct Settling {
  Settling(int cable, bool may_touch) : touches(may_touch) { alone.cables.push_back(cable); }
  int cable() const { return alone.cables.front(); }

  bool touches;                                      ///< looks for what it touches
  bool let_go = false;                               ///< moves, instead of coming to rest
  int iterations = std::numeric_limits<int>::max();  ///< that are left
  ContactGroup alone;
};

struct World::Implementation {
  SceneDesc scene;
  std::vector<int> waiting_descs;  ///< indices into scene.cables
  std::vector<int> waiting_nets;   ///< indices into scene.nets
  std::vector<std::string> waiting;
  std::vector<std::string> unsettled;
  std::vector<std::string> misfits;
  std::vector<std::string> frames;
  std::vector<Pose> poses;           ///< of the frames, at the world's time
  std::vector<Pose> previous_poses;  ///< a step before; of a frame that is new to a step, its first
  std::vector<char> known;           ///< by frame id: whether it has been seen, or given a pose
  std::int64_t steps = 0;
  std::vector<SimulatedCable> cables;
  std::vector<CableScratch> scratch;  ///< one a cable
  std::vector<SimulatedNet> nets;
  std::vector<NetScratch> net_scratch;  ///< one a net
  std::vector<SimulatedParticle> particles;
  std::vector<PointState> particle_memory;  ///< one a particle
  ParticleStepper particle_stepper;
  std::vector<Attachment> attachments;
  std::vector<Obstacle> obstacles;
  std::vector<ContactGroup> groups;   ///< every cable is in one
  std::vector<Break> breaks;          ///< in the last step
  std::vector<Jump> jumps;            ///< likewise
  std::vector<Intrusion> intrusions;  ///< likewise
  // Scratch
  std::vector<StepResult> results;               ///< one a cable
  std::vector<MovingObstacle> moving_obstacles;  ///< of nets, particles and cables that settle
  bool one_by_one = false;                       ///< as World::step_one_by_one asks
  const std::atomic<bool>* cancelled = nullptr;  ///< during construction

  template <class Desc>
  bool frames_known(const Desc& desc, const BoundaryInputs& inputs) const;
  void start_cable(const CableDesc& desc, const BoundaryInputs& inputs);
  void start_net(const NetDesc& desc, const BoundaryInputs& inputs);
  void update_net(int net);
  void add_particle(const ParticleDesc& desc);
  void step_nets_and_particles(StepResult& result);
  void step_net(int net, StepResult& result);
  void aim_net(int net, StepResult& result);
  void step_particle(int particle, StepResult& result);
  void add_net_energy(Energy& energy) const;
  bool is_attachment(const std::string& name) const;
  Vector3 gravity_near(int cable) const;
  int follow_frames(const BoundaryInputs& inputs);
  void add_scene_obstacles();
  void find_obstacle_holders();
  void form_groups();
  void step_groups();
  void step_group(ContactGroup& group);
  void aim(int cable);
  bool advance(ContactGroup& group, double from, double to, bool tolerated);
  void move_obstacles(double from, double to, std::vector<MovingObstacle>& all) const;
  ContactRules contact_rules(bool still) const;
  void find_contacts(ContactGroup& group, double from, double to);
  void note_substep(int cable, const SubstepResult& substep, double part);
  void give_up(int cable);
  void hold_still(int cable);
  void settle_start(int cable);
  void turn_clamps(Settling& settling);
  bool find_equilibrium(Settling& settling);
  bool relax(double h, double longest, int steps, Settling& settling);
  bool leaves_equilibrium(Settling& settling, double& h);
  bool leaves_when_let_go(Settling& settling, double& h);
  SubstepResult settle_substep(Settling& settling, double h);
  bool may_touch() const;
  bool is_cancelled() const { return cancelled && *cancelled; }
  void note_settled(int cable, bool settled);
  int breaking_segment(int cable, const StepResult& result) const;
  void add_forces(int cable, double weight);
  void update_holders(int cable);
  void follow_material(int cable);
  void plan_reel_step(int cable);
  void wind_reel(int cable, double from, double to);
  void complete_reel_step(int cable);
  double available_length(int cable) const;
  double slack_at_winch(int cable) const;
  void remesh_winch(int cable);
  void add_winch_node(int cable);
  void take_in_winch_node(int cable);
  void close_joint(int cable);
  void reverse_cable(int cable);
  void renumber(int cable, int first_node, int shift);
  void follow_cut(int cable, int segment, int new_cable);
  void follow_join(int first, int second);
  void after_remeshing(int cable);
  double time() const { return static_cast<double>(steps) * scene.time_step; }
};

/// The index of a name, their number if it is not there.
int find_frame(const std::vector<std::string>& frames, const std::string& name);

/// What is wrong with a pose that is not sound, under the name of its field; empty if nothing is.
std::string pose_problem(const std::string& field, const Pose& pose);

/// Keeps the worst status, and of equals the first cable's.
void note_status(StepResult::Status status, int cable, int node, StepResult& result);

/// Keeps the deepest place of each cable in each obstacle that a substep of the group has found.
void note_intrusions(ContactGroup& group);

/// Takes a cable's motion away.
void bring_to_rest(CableState& state);

}  // namespace verlet_cable
