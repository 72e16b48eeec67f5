#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "world/islands.h"
#include "world/state.h"
#include "world/step_contacts.h"
#include "world/step_progress.h"
#include "world/workspace.h"

namespace verlet_cable {

/// What a step does to a cable, for who reads the world.
struct CableOutcome {
  StepResult result;
  std::vector<Jump> jumps;    ///< that the step found to be over
  int breaking_segment = -1;  ///< -1: none
  bool gave_way = false;      ///< straight columns of it were bent, as something that touches or holds it presses them together
  EnergyBalance balance;      ///< of the step
  double change = 0;          ///< [J] of its energy
};

/// What a step of an island finds.
struct IslandOutcome {
  StepResult bodies;                           ///< status and first body that is not ok
  std::vector<Jump> jumps;                     ///< of what holds bodies, that the step found to be over
  std::vector<Intrusion> intrusions;           ///< the deepest of each cable and obstacle
  std::vector<BodyIntrusion> body_intrusions;  ///< of each body and obstacle
  StepContacts contacts;
  std::optional<StepProgress> unfinished;  ///< what is left waits for `resume`
  bool exhausted = false;                  ///< the step took more work than it may
  EnergyBalance balance;                   ///< besides those of its cables
  double change = 0;                       ///< [J] of its bodies' energy
};

/// Where a cable hangs to: gravity at its first node.
Vector3 gravity_near(const State& state, int cable);

/// The obstacles that are there, as they move over a part of the step, 0 to 1.
void move_obstacles(const State& state, double from, double to, std::vector<MovingObstacle>& moving);

/// How contacts of a world are found: `still`, where nothing moves but towards equilibrium.
ContactRules contact_rules(const SceneDesc& scene, bool still);

/// What may touch in the next h [s], of an island whose cables are the members of the workspace.
void find_contacts_of(Island& island, const State& state, const ContactRules& rules, double h, Workspace& workspace);

bool finite(const std::vector<Vector3>& vectors);

/// Work of an iteration, at most, see `budget`.
double size_of(const Island& island, const State& state);

/// Keeps the worst status, and of equals the first body's.
void note_status(StepResult::Status status, const BodyId& body, int node, StepResult& result,
                 DegradedCause cause = DegradedCause::none);

/// Adds what a cable exerted on its holders, weighted, to its attachments.
void add_forces(const Boundary& boundary, const KinematicTargets& targets, const std::vector<Pose>& frames, double weight,
                std::vector<Attachment>& attachments);

/// Before a step's forces are added.
void forget_forces(const KinematicTargets& targets, std::vector<Attachment>& attachments);

/// What holds the bodies of an island up to a part of a step, 0 to 1, for the members of the workspace. Multipliers begin with
/// what they were in the substep before.
void find_body_joints(const Island& island, const State& state, double to, Workspace& workspace);
/// The next substep will know what they have done.
void keep_body_joints(const Island& island, const std::vector<BodyJoint>& joints, State& state);

/// Twist and roll of the material: from the clamps where there are any, else the first segment's is carried along in time.
void follow_material(const CableModel& model, const std::vector<HeldDirection>& directions, const std::vector<TwistSpan>& spans,
                     CableState& state);

/// Whether a body holds any of a cable.
bool follows_bodies(const KinematicTargets& targets, const std::vector<Attachment>& attachments);

/// Aims a cable's holders at where they will be at the end of the step. Where they jump, the cable is carried along with them
/// before it is stepped, and keeps its velocities. `directions`: scratch.
void update_targets(int cable, State& state, CableOutcome& outcome, std::vector<HeldDirection>& directions);

/// Steps the cables of an island, whose holders aim at the end of the step, in as many substeps as they need: halved where the
/// solver does not converge, doubled where it does easily. Changes nothing but these cables and the forces on their attachments.
class IslandStepper {
 public:
  /// `lanes`: 2, 4 or 8, no more than the processor has.
  IslandStepper(State& state, Workspace& workspace, std::vector<CableOutcome>& outcomes, int lanes);
  /// A cable that is alone and whole steps do for waits for others like it, with which it is stepped at once, or for `finish`.
  void step(Island& island, IslandOutcome& found);
  /// Steps those that wait, of this world and of others that are stepped in the same workspace.
  void finish();
  /// Ends the step of an island that is unfinished, with no more than about this much more work, see `budget`: what is left then
  /// is done from rest.
  void resume(Island& island, double allowance, IslandOutcome& found);

 private:
  bool wait_for_others(Island& island, IslandOutcome& found, bool& contacts_known);
  Substep whole_step(int cable, Boundary& boundary);
  WaitingCables& waiting_of(const LaneLaw& law);
  void step_together(WaitingCables& waiting);
  void complete_whole_step(const Island& island, Boundary& boundary, const SubstepResult& result);
  void step_alone(Island& island, IslandOutcome& found, bool contacts_known);
  void begin(const Island& island);
  bool advance(Island& island, double from, double to, bool tolerated);
  void begin_bodies(const Island& island, double from, double to, Scheme scheme);
  bool advance_bodies(double from, bool tolerated);
  bool advance_straight_bodies(const Island& island, double from, double to, Scheme scheme, bool tolerated);
  void finish_bodies(const Island& island, double from, double to);
  void stop_bodies(const Island& island);
  void update_body_targets(const Island& island, IslandOutcome& found);
  void aim_body(int body, std::vector<int>::const_iterator first, std::vector<int>::const_iterator last, IslandOutcome& found);
  void carry_by_cables(const Island& island);
  void carry_cables(const Island& island);
  void follow_body_holder(BodyJoint& joint, double to);
  void find_contacts(Island& island, double from, double to);
  double middle_of(double from, double to) const;
  bool touches() const;
  bool columns_give_way(double part);
  Scheme scheme_of(int cable) const;
  Scheme find_touching_scheme(const Island& island, double h);
  /// Returns the part of the step that it has wound.
  double wind_drive(int cable, Scheme scheme, double from, double to, Boundary& boundary);
  void slip_at_winch(int cable, double wound, double from, double to, const Boundary& boundary);
  bool is_kept(const Island& island, std::size_t k) const;
  bool is_finite(const Island& island);
  void take_back(const Island& island);
  bool advance_within(double most_work, Island& island, StepProgress& progress, IslandOutcome& found, bool contacts_known);
  void end_from_rest(Island& island, StepProgress& progress, IslandOutcome& found);
  bool advance_part(Island& island, const PartOfStep& part, bool tolerated, bool contacts_known, StepProgress& progress,
                    IslandOutcome& found);
  double work_of_attempt(const Island& island) const;
  // The ledger
  bool damps(const Island& island) const;
  static double unresolved_of(const Boundary& boundary, const SubstepResult& substep);
  double energy_at(const Island& island, double part);
  double energy_at(int cable, double part);
  double accounted(const Island& island, const IslandOutcome& found) const;
  void balance_bodies(double from, double to);
  Pose body_holder_at(const BodyJoint& joint, double part) const;
  void stop(const Island& island, DegradedCause cause, IslandOutcome& found);
  void give_up(const Island& island, IslandOutcome& found);
  bool give_up(int cable, bool touches, Boundary& boundary);
  void hang_on_bodies_anew(const Island& island);
  void take_bodies_along(int cable, std::vector<char>& placed);
  bool was_easy() const;
  void note_substep(int cable, const Boundary& boundary, const SubstepResult& result, double part);
  void note_intrusions(std::vector<Intrusion>& noted) const;
  void complete(const Island& island, const StepProgress& progress, IslandOutcome& found);
  void complete_cable(int cable, const Boundary& boundary, int substeps);
  void close_clamps(int cable);

  State& state_;
  Workspace& workspace_;
  std::vector<CableOutcome>& outcomes_;
  Environment environment_;
  bool projects_bodies_ = false;         ///< velocities of bodies and what they hold, at the end of the substep
  double joined_mass_ = 0;               ///< [kg] of the island, where there are bodies
  double most_contact_work_ = infinity;  ///< of the next attempt, see `budget`
  double contact_work_ = 0;              ///< that the last one took
  bool bends_columns_ = false;           ///< the last attempt has bent columns, and is to be made again
  EnergyBalance substep_;                ///< of contacts and bodies in the last one
  int lanes_;                            ///< two a cable that is stepped together with others
};

/// The step of a winch or joint is done.
void complete_drive_step(int cable, State& state);
/// What flows through guides beside a cable's drive, see `keep_flow`.
void keep_flow_at_drive(int cable, double part, State& state);

}  // namespace verlet_cable
