#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "verlet_cable/core/body.h"
#include "verlet_cable/core/body_id.h"
#include "verlet_cable/core/cable.h"
#include "verlet_cable/core/contact.h"
#include "verlet_cable/core/edit.h"
#include "verlet_cable/core/guide.h"
#include "verlet_cable/core/ledger.h"
#include "verlet_cable/core/load.h"
#include "verlet_cable/core/net.h"
#include "verlet_cable/core/obstacle.h"
#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/types.h"
#include "verlet_cable/core/winch.h"

namespace verlet_cable {

/// The pose of a frame at the end of a step, in the fixed frame. A pose that is not sound (see `is_sound`) is ignored: the frame
/// stays where it was. BoundaryInputs has one entry per frame, indexed by frame id.
struct FrameInput {
  Pose pose;
  bool known = true;  ///< false: never seen; cables that need it wait, and obstacles in it do not exist yet
  /// The frame's velocity, with which cables and nets that start now begin to move where it holds them. Steps do not read it:
  /// they follow the poses. Without it, a frame starts with its mean velocity over the first step.
  std::optional<FrameVelocity> velocity = std::nullopt;
};
using BoundaryInputs = std::vector<FrameInput>;

/// Holds a node of a cable or net, or a rigid body, in a frame. The frame may be that of a rigid body.
struct Attachment {
  std::string name;
  BodyId body;      ///< what is held: a cable, a net or a rigid body
  int node = 0;     ///< of a cable or net
  int frame = 0;    ///< index into World::frames()
  int holder = -1;  ///< index into World::bodies() if the frame is a body's
  AttachmentType type = AttachmentType::hinge;
  Pose pose;  ///< of the attachment, in the frame
  Pose at;    ///< of the attachment, in the frame of the rigid body that is held
  Vector3 force =
      Vector3::Zero();  ///< [N] that the cable or body exerts on its holder, axes of the fixed frame, mean over the last step
  Vector3 torque = Vector3::Zero();  ///< [N m] likewise, about the attachment's point
  /// Index into World::guides() if it is a guide, through which the cable slides; -1: it is not.
  int guide = -1;
  bool is_junction = false;  ///< the holder is the junction that joins the cable to others
  int held_junction = -1;    ///< index into World::bodies() of the junction at the node, which is held instead; -1: there is none
  /// [m] of a sheave, in its axes: where the cable meets the wheel (`node`) and where it leaves it (the next node)
  std::array<Vector3, 2> tangent_points{Vector3::Zero(), Vector3::Zero()};
};

/// Whether it is a wheel on which the cable lies between two nodes, and not a guide through which it passes at one node.
inline bool is_wheel(const Attachment& attachment) {
  return attachment.guide >= 0 && attachment.tangent_points[0] != attachment.tangent_points[1];
}

/// The last node of a cable that an attachment holds: of a wheel the one at which the cable leaves it.
inline int last_node(const Attachment& attachment) {
  return is_wheel(attachment) ? attachment.node + 1 : attachment.node;
}

/// Index into World::bodies() of the body that an attachment holds; -1: it holds a node.
inline int held_body(const Attachment& attachment) {
  return attachment.body.is_rigid_body() ? attachment.body.index : attachment.held_junction;
}

/// Whether it is an attachment that the scene or a pin names; guides and the attachments of cables to junctions are not.
inline bool is_named(const Attachment& attachment) {
  return attachment.guide < 0 && !attachment.is_junction;
}

/// What became of a step that is degraded. Of several causes the first one that was found.
enum class DegradedCause {
  none,           ///< it is not degraded
  no_solution,    ///< a substep of the smallest size did not converge, or a net is held where it cannot be
  too_much_work,  ///< the step exceeded its budget of work, and was cut short
  unstable,       ///< numbers were no longer finite
  too_stiff,      ///< the springs of a net are too stiff for the time step, and were softened
  no_room,        ///< a cable is inside an obstacle or another cable, and does not get out
};

struct StepResult {
  /// What forces of the step are worth, from good to bad. Numbers are those of Cable.msg.
  enum class Status {
    ok,
    jumped,           ///< the velocity of a frame changed too much for a motion: what the frame holds was carried along
    overstretched,    ///< held points are further apart than the cable or net between them is long: it was lengthened
    inside_obstacle,  ///< a cable is inside an obstacle, see Intrusion, or a body, see BodyIntrusion
    not_settled,      ///< no equilibrium was found to start from, or to settle in; said until the first step after that is done
    /// A substep of the smallest size did not converge, a net is held where it cannot be, or the step took too much work: the
    /// cable or net, or the bodies and their cables, lost their velocity and continue from rest. Or a cable is inside an
    /// obstacle or another cable, and has no room to get out.
    degraded,
    fault,  ///< that failed, too: the cable stays in its last finite state
  };
  Status status = Status::ok;
  BodyId body;             ///< the first one that is not ok
  int node = -1;           ///< its first node that is not ok
  int ignored_frame = -1;  ///< the first frame whose pose was not sound
  int substeps = 0;        ///< the largest number for any cable
  int iterations = 0;      ///< of the solver, over all cables and substeps
  bool exhausted = false;  ///< the step exceeded its budget of work and was cut short: cables did the rest of it from rest
  double max_strain = 0;   ///< largest |l / l0 - 1| at the end of the step
  DegradedCause cause = DegradedCause::none;  ///< if the status is degraded
};

/// [J]; the potential of uniform gravity is zero at the fixed frame's origin, that of central gravity at infinity.
struct Energy {
  double kinetic = 0, gravity = 0, stretch = 0, bend = 0, twist = 0;
  double total() const { return kinetic + gravity + stretch + bend + twist; }
  double potential() const { return total() - kinetic; }
  Energy& operator+=(const Energy& other) {
    kinetic += other.kinetic;
    gravity += other.gravity;
    stretch += other.stretch;
    bend += other.bend;
    twist += other.twist;
    return *this;
  }
};

/// How a cable bends and twists at a node, or beside a clamp.
struct JointView {
  double arc_length = 0;  ///< [m] of the node from the start, at rest
  double curvature = 0;   ///< [1/m]
  double twist = 0;       ///< [rad/m]
};

/// A segment that was removed in a step because its tension exceeded the material's breaking tension.
struct Break {
  int cable = 0;      ///< index of the cable, now the first piece
  int segment = 0;    ///< that was removed
  int new_cable = 0;  ///< index of the second piece
  double limit = 0;   ///< [N] the segment's breaking tension
};

/// A cable has begun to bend more tightly than the minimum_bend_radius of its material, its tension to exceed
/// maximum_tension, or what it touches to squeeze it with more than maximum_squeeze.
/// There is one per excursion: as long as it lasts at neighbouring nodes, and for a tenth of a second after. Edits and breaks
/// keep its indices valid.
struct Excursion {
  enum class Kind { bend, tension, squeeze };
  int cable = 0;  ///< index into World::cables()
  int node = 0;   ///< the worst one; otherwise the first node of the worst segment
  Kind kind = Kind::bend;
  double value = 0;    ///< the radius [m], tension [N] or squeeze [N/m] there
  double allowed = 0;  ///< the limit of the material
  std::string other;   ///< what squeezes
};

/// A jump of an attachment: its velocity changed by more than the scene's jump_speed within a step, for no longer than 5 ms. What
/// it holds was carried along with it, so that it is not struck. A jump is reported when it is over; a change that lasts longer
/// is a motion, which is followed from then on.
struct Jump {
  int attachment = 0;   ///< index into World::attachments()
  double distance = 0;  ///< [m] that the attachment was carried
  double time = 0;      ///< [s] of the world, when it began
  double duration = 0;  ///< [s] a multiple of the time step
};

/// A cable that is inside an obstacle, deeper than half its radius: it started there, the obstacle appeared there, or it was
/// drawn there. It is pushed out slowly, and found in each step until it is out. Edits and breaks keep its indices valid.
struct Intrusion {
  int cable = 0;     ///< index into World::cables()
  int segment = 0;   ///< the deepest one
  int obstacle = 0;  ///< index into World::obstacles()
  double depth = 0;  ///< [m] of the cable's surface below that of the obstacle
};

/// Likewise a body that is deep inside an obstacle and is pushed out.
struct BodyIntrusion {
  int body = 0;      ///< index into World::bodies()
  int obstacle = 0;  ///< index into World::obstacles()
  double depth = 0;  ///< [m] of the deepest place where their surfaces were compared
};

/// A status of a cable, net, particle or body that is not ok. Edits and breaks keep its indices valid.
struct StatusFinding {
  BodyId body;
  StepResult::Status status = StepResult::Status::ok;
  int node = 0;                               ///< the first one; inside an obstacle, of the deepest segment
  double max_strain = 0;                      ///< largest |l / l0 - 1| of the body at the end of the step
  DegradedCause cause = DegradedCause::none;  ///< if the status is degraded
};

/// Energy that came from nowhere in a step, or went (negative); see Ledger.
struct UnaccountedEnergy {
  BodyId body;        ///< the first one of what was stepped together
  double energy = 0;  ///< [J]
};

/// Findings of the last step, start or settling.
struct Findings {
  std::vector<std::string> waiting;  ///< names of cables, nets and bodies that wait for a frame or for their holder
  /// Names of cables for which settling found no equilibrium, at their start or in `settle`.
  std::vector<std::string> unsettled;
  /// Names of cables whose initial shape could not be projected onto their lengths with the attachments held: they start hanging
  /// instead.
  std::vector<std::string> misfits;
  /// A line, as of `validate`, for each cable that has started without reaching a body or junction that has no pose: only where
  /// poses of frames were not known before, as `validate` and `validate_distances` refuse such starts.
  std::vector<std::string> unreached;
  /// Each status of each body once; what the last step, or the start or settling since then, was not ok for.
  std::vector<StatusFinding> statuses;
  // In the last step
  std::vector<Break> breaks;
  std::vector<Excursion> excursions;  ///< that have begun
  std::vector<int> caught, released;  ///< indices into World::guides() of clips that caught their cable, or let it go
  std::vector<EndedLoad> ended_loads;
  std::vector<Jump> jumps;                      ///< that have ended, at most one per attachment
  std::vector<Intrusion> intrusions;            ///< at most one per cable and obstacle
  std::vector<BodyIntrusion> body_intrusions;   ///< at most one per body and obstacle
  std::vector<UnaccountedEnergy> unaccounted;   ///< beyond what rounding and tolerances explain
  std::vector<SimulatedContact> contacts;       ///< where cables touched something
  std::vector<SimulatedContact> body_contacts;  ///< where bodies touched obstacles
};

/// The simulation: cables and nets whose attachments follow frames, bodies and particles. It is a value type: a copy is a
/// snapshot, and continuing from a copy gives the same bytes. It reads no clock and logs nothing; `step` does not throw.
class World {
 public:
  /// Cables whose frames are all known start at once; the others wait for `start_waiting`. `inputs` is indexed like
  /// `frame_names(scene)`. Throws SceneError with all errors that `validate` finds. If another thread sets `cancelled`,
  /// construction ends soon after, and the world must not be used.
  World(const SceneDesc& scene, const BoundaryInputs& inputs, const std::atomic<bool>* cancelled = nullptr);
  /// A world in which no cable or net has started yet. Throws SceneError likewise.
  explicit World(const SceneDesc& scene);
  ~World();
  World(const World&);
  World& operator=(const World&);
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Advances by the scene's time step. `inputs`: one entry per frame, see frames().
  StepResult step(const BoundaryInputs& inputs);
  /// Frames have gone further until the next step than it is long, because time was left out: they show no jump in it.
  void note_left_out_time();
  /// Many cables that cannot touch are stepped on all cores at once. With `one_by_one` they are not, for programs that run many
  /// worlds at once. The result is the same.
  void step_one_by_one(bool one_by_one);
  /// Cables that are alike and touch nothing are stepped together in the lanes of the processor's vector registers, two lanes per
  /// cable. This limits them to `most` lanes: 2, 4 or 8, or fewer if the processor has fewer. The result is the same.
  void limit_lanes(int most);

  /// Puts every held cable into static equilibrium with its holders where they are (Newton's method; time does not advance). Free
  /// cables and nets stay as they are. False if a cable does not reach equilibrium; that cable is then at rest near it.
  bool settle();

  const SceneDesc& scene() const;  ///< as it was tuned
  double time() const;             ///< [s] number of steps done times the time step
  std::int64_t steps() const;
  double time_step() const;  ///< [s]

  /// Names of the frames by id: 0 is the fixed frame; then come the frames of the scene in order of appearance, those of its
  /// bodies, and those that pins and obstacles added.
  const std::vector<std::string>& frames() const;
  const Pose& frame_pose(int frame) const;  ///< at the world's time
  bool frame_known(int frame) const;        ///< whether it has been seen, or given a pose
  bool is_body_frame(int frame) const;      ///< whether it belongs to a body: its pose is a result, and inputs for it are ignored
  /// Returns the id of a frame, and adds it if it is new. Without a (sound) pose, a new one is unknown until a step gives it.
  int add_frame(const std::string& name, const std::optional<Pose>& pose);

  const std::vector<SimulatedCable>& cables() const;  ///< those that have started, pieces of cuts included
  const std::vector<SimulatedNet>& nets() const;      ///< those that have started
  const std::vector<SimulatedParticle>& particles() const;
  const std::vector<SimulatedBody>& bodies() const;    ///< those of the scene, then those of its junctions
  const std::vector<Attachment>& attachments() const;  ///< of the started cables, nets and bodies; including guides
  const std::vector<SimulatedGuide>& guides() const;   ///< those of the started cables
  GuideView view_guide(int guide) const;
  /// Of a cable; none where no winch runs, or is to keep or heed a tension.
  std::optional<WinchView> view_winch(int cable) const;
  const std::vector<Load>& loads() const;          ///< from outside, that act in the next step
  const std::vector<Obstacle>& obstacles() const;  ///< those of the scene, of the links of its robot, then those that edits added
  const Findings& findings() const;
  /// On an obstacle, a link of a robot (with all that follows its frame), or a body, by name.
  ContactWrench contact_wrench(const std::string& name) const;
  /// Of the obstacle, body or cable that is touched.
  const std::string& touched_name(const SimulatedContact& contact) const;

  /// Starts the waiting cables and nets whose frames are known now, in their default or given shapes. Returns how many.
  int start_waiting(const BoundaryInputs& inputs);
  EditResult apply(const Edit& edit);
  /// Takes over gravity, fluid, the friction between cables and the values of the materials that the world has (by name) from a
  /// valid scene. Throws SceneError, and changes nothing, if a cable that was joined with another would lack torsional stiffness
  /// for its rest shape.
  void tune(const SceneDesc& scene);

  Energy energy() const;
  /// Where energy has come from and gone since the start; see Ledger. Nets and particles are not followed law by law: what they
  /// gain counts as work of what holds them, what they lose as unresolved.
  Ledger ledger() const;
  /// All joints of a cable from start to end: those of inner nodes, and those between clamps and the segments next to them.
  void view_joints(int cable, std::vector<JointView>& joints) const;
  std::uint64_t hash() const;  ///< of everything that the future depends on
  /// Everything that the future depends on, and those findings that are no events (contacts, what is inside obstacles, statuses,
  /// and what the start could not do), as bytes: for this version of the package on this kind of machine.
  std::string save() const;
  /// Goes on from what `save` gave of a world whose scene differs from this one's in numbers only, as a copy of that world would,
  /// with the findings that are saved and no others. Throws std::invalid_argument with what is wrong with the bytes; the world is
  /// then as before.
  void restore(const std::string& bytes);

 private:
  friend struct WorldInspector;  // tests
  friend class Sensitivity;
  friend class WorldStepper;
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Index of the cable, net, body, attachment or guide with a name; -1 if there is none.
int find(const std::vector<SimulatedCable>& cables, const std::string& name);
int find(const std::vector<SimulatedNet>& nets, const std::string& name);
int find(const std::vector<SimulatedBody>& bodies, const std::string& name);
int find(const std::vector<Attachment>& attachments, const std::string& name);
int find(const std::vector<SimulatedGuide>& guides, const std::string& name);

/// Whether a pose can be used: coordinates within 1e9 m, and a quaternion whose norm is from 0.5 to 2; the quaternion is then
/// normalized.
bool is_sound(const Pose& pose);
/// Names of the frames in a scene, by id: the fixed frame first, then in order of appearance, each once.
std::vector<std::string> frame_names(const SceneDesc& scene);
/// Names of the frames whose poses are results; their ids follow those: of the scene's bodies, then of its junctions.
std::vector<std::string> computed_frame_names(const SceneDesc& scene);
/// Initial poses of the scene's frames, by id; `known` is false if the scene gives no pose.
BoundaryInputs initial_frames(const SceneDesc& scene);
/// Errors, one line each as of `validate`, with the frames at `frames` (by id; unknown ones are left out): inextensible cables
/// that are shorter than the distance between two neighbouring attachments; if there are none, cables that do not reach a body or
/// junction without a pose, wherever that hangs. `validate` does this for the initial poses.
std::vector<std::string> validate_distances(const SceneDesc& scene, const BoundaryInputs& frames);

}  // namespace verlet_cable
