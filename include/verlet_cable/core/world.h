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
#include "verlet_cable/core/net.h"
#include "verlet_cable/core/obstacle.h"
#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// Where the frames are at the end of a step, seen from the fixed frame; one entry a frame, by frame id. A pose that is not sound
/// (see `is_sound`) counts as none: the frame stays where it was.
struct FrameInput {
  Pose pose;
  bool known = true;  ///< false: never seen; cables that need it wait, obstacles in it are not there
  /// What cables and nets that start now begin to move with, at what holds them. Steps do not read it: they follow the poses.
  /// Without it a frame begins with its mean velocity over the first step.
  std::optional<FrameVelocity> velocity = std::nullopt;
};
using BoundaryInputs = std::vector<FrameInput>;

/// What holds a node of a cable or net, or a rigid body, to a frame. The frame may be that of a rigid body.
struct Attachment {
  std::string name;
  BodyId body;      ///< a cable, a net or a rigid body
  int node = 0;     ///< of a cable or net
  int frame = 0;    ///< index into World::frames()
  int holder = -1;  ///< index into World::bodies() if the frame is a body's
  AttachmentType type = AttachmentType::hinge;
  Pose pose;  ///< of the attachment, in the frame
  Pose at;    ///< of the attachment, in the frame of the rigid body that is held
  Vector3 force =
      Vector3::Zero();  ///< [N] what the cable or body exerts on its holder, fixed frame's axes, mean over the last step
  Vector3 torque = Vector3::Zero();  ///< [N m] likewise, about the attachment's point
  /// Index into World::guides() of the guide that it is: the cable slides through it; -1: it is none.
  int guide = -1;
  bool is_junction = false;  ///< the holder is what joins the cable to others where they branch
  int held_junction = -1;    ///< index into World::bodies() of the one at the node, which is held in its place; -1: there is none
  /// [m] of a sheave, in its axes: where the cable comes to the wheel (`node`) and leaves it (the node after that)
  std::array<Vector3, 2> tangent_points{Vector3::Zero(), Vector3::Zero()};
};

/// Whether a cable lies on it between two nodes, instead of going through it at one.
inline bool is_wheel(const Attachment& attachment) {
  return attachment.guide >= 0 && attachment.tangent_points[0] != attachment.tangent_points[1];
}

/// Index into World::bodies() of the body that it holds, -1: it holds a node.
inline int held_body(const Attachment& attachment) {
  return attachment.body.is_rigid_body() ? attachment.body.index : attachment.held_junction;
}

/// Whether it is one that the scene or a pin names as such: guides and what joins cables at junctions are not.
inline bool is_named(const Attachment& attachment) {
  return attachment.guide < 0 && !attachment.is_junction;
}

struct StepResult {
  enum class Status {
    ok,
    overstretched,  ///< held points are further apart than what is between them can be: it was lengthened
    jumped,         ///< a frame changed its velocity too much for a motion: what it holds was carried along with it
    /// A substep did not converge at the smallest size, a net is held where it cannot be, or the step took too much work: the
    /// motion of the cable or net, or of bodies and what hangs on them, was taken away, and it goes on from rest; or cables are
    /// in each other and have no room to get apart.
    degraded,
    fault,  ///< not even that: the cable stays as it was last, finite
  };
  Status status = Status::ok;
  BodyId body;             ///< the first one that is not ok
  int node = -1;           ///< its first node that is not ok
  int ignored_frame = -1;  ///< the first frame whose pose was not sound
  int substeps = 0;        ///< the most that any cable took
  int iterations = 0;      ///< of the solver, all cables and substeps
  bool exhausted = false;  ///< it took more work than a step may: what was left was done from rest
  double max_strain = 0;   ///< largest |l / l0 - 1| at the end of the step
};

/// [J]; gravity is zero at the fixed frame's origin, central gravity infinitely far away.
struct Energy {
  double kinetic = 0, gravity = 0, stretch = 0, bend = 0, twist = 0;
  double total() const { return kinetic + gravity + stretch + bend + twist; }
};

/// How a cable bends and twists at a node, or beside a clamp.
struct JointView {
  double arc_length = 0;  ///< [m] of the node from the start, at rest
  double curvature = 0;   ///< [1/m]
  double twist = 0;       ///< [rad/m]
};

/// A segment that went in a step because its tension exceeded the material's breaking tension.
struct Break {
  int cable = 0;      ///< index of the cable, now the first piece
  int segment = 0;    ///< that is gone
  int new_cable = 0;  ///< index of the second piece
  double limit = 0;   ///< [N] the segment's breaking tension
};

/// A cable has come to bend more tightly than its material's minimum_bend_radius, or to be pulled harder than its
/// maximum_tension. One while that lasts at neighbouring nodes, and a tenth of a second after. Edits and breaks keep its indices
/// valid.
struct Excursion {
  enum class Kind { bend, tension };
  int cable = 0;  ///< index into World::cables()
  int node = 0;   ///< the worst one; of tension that of the segment that starts there
  Kind kind = Kind::bend;
  double value = 0;    ///< the radius [m] or tension [N] there
  double allowed = 0;  ///< the material's
};

/// What an attachment holds was carried along with it instead of being struck: its velocity had changed by more than 5 m/s within
/// a step, and not for longer than 5 ms. It is known when that is over: a change that lasts is a motion, and is followed from
/// then on.
struct Jump {
  int attachment = 0;   ///< index into World::attachments()
  double distance = 0;  ///< [m] that the attachment was carried
  double time = 0;      ///< [s] the world's time when it began
  double duration = 0;  ///< [s] in whole steps
};

/// A cable that is inside an obstacle without having come through its surface: it started there, or the obstacle appeared there.
/// It is pushed out gently. Edits and breaks keep its indices valid.
struct Intrusion {
  int cable = 0;     ///< index into World::cables()
  int segment = 0;   ///< the deepest one
  int obstacle = 0;  ///< index into World::obstacles()
  double depth = 0;  ///< [m] of the cable's surface
};

/// What the last step, start or settling found.
struct Findings {
  std::vector<std::string> waiting;  ///< names of cables, nets and bodies that wait for a frame, or for what holds them
  /// Names of cables that found no equilibrium when they were to be settled, at their start or by `settle`.
  std::vector<std::string> unsettled;
  /// Names of cables whose given initial shape could not be brought to their lengths between their attachments: they hang
  /// instead.
  std::vector<std::string> misfits;
  // In the last step
  std::vector<Break> breaks;
  std::vector<Excursion> excursions;       ///< that have begun
  std::vector<int> caught, released;       ///< indices into World::guides() of those that took their cable, or let it go
  std::vector<Jump> jumps;                 ///< that were found to be over, one an attachment
  std::vector<Intrusion> intrusions;       ///< one a cable and obstacle
  std::vector<SimulatedContact> contacts;  ///< where cables touched something in the last substep
};

/// The simulation: cables and nets whose attachments follow frames, and particles, in the fixed frame. A value: a copy is a
/// snapshot, and continuing a copy gives the same bytes. Reads no clock, logs nothing, throws nothing in `step`.
class World {
 public:
  /// Cables whose frames are all known start at once, the others wait for `start_waiting`. `inputs` is indexed like
  /// `frame_names(scene)`. Throws SceneError with everything that `validate` finds. Soon after another thread has set `cancelled`
  /// it ends, and the world is good for nothing.
  World(const SceneDesc& scene, const BoundaryInputs& inputs, const std::atomic<bool>* cancelled = nullptr);
  /// None of the cables and nets has started yet. Throws SceneError likewise.
  explicit World(const SceneDesc& scene);
  ~World();
  World(const World&);
  World& operator=(const World&);
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Advances by the scene's time step. `inputs`: one entry a frame, see frames().
  StepResult step(const BoundaryInputs& inputs);
  /// Cables that cannot touch are stepped by all cores at once where they are many, with the same result; or not, for programs
  /// that run many worlds at once.
  void step_one_by_one(bool one_by_one);
  /// Cables that are alike and touch nothing are stepped several at once, in lanes of the numbers that the processor computes
  /// with together: two a cable, 2, 4 or 8, or as many of them as it has. The result is the same.
  void limit_lanes(int most);

  /// Puts every cable that is held into static equilibrium, its holders where they are (Newton's method, no waiting); free cables
  /// and nets stay as they are. False if one of them found none; it is then at rest near it.
  bool settle();

  double time() const;  ///< [s] steps done times the time step
  std::int64_t steps() const;
  double time_step() const;  ///< [s]

  /// Frames by id: 0 is the fixed frame, then those of the scene in order of appearance, then those of its bodies, then those
  /// that pins and obstacles added.
  const std::vector<std::string>& frames() const;
  const Pose& frame_pose(int frame) const;  ///< at the world's time
  bool frame_known(int frame) const;        ///< whether it has been seen, or given a pose
  bool is_body_frame(int frame) const;      ///< whether it is a body's: its pose is a result, inputs for it are not looked at
  /// Id of the new or the existing frame. Without a (sound) pose, a new one is unknown until a step knows it.
  int add_frame(const std::string& name, const std::optional<Pose>& pose);

  const std::vector<SimulatedCable>& cables() const;  ///< those that have started, pieces of cuts included
  const std::vector<SimulatedNet>& nets() const;      ///< those that have started
  const std::vector<SimulatedParticle>& particles() const;
  const std::vector<SimulatedBody>& bodies() const;    ///< those of the scene, then those that join cables at its junctions
  const std::vector<Attachment>& attachments() const;  ///< of the started cables, nets and bodies; guides are among them
  const std::vector<SimulatedGuide>& guides() const;   ///< those of the started cables
  GuideView view_guide(int guide) const;
  const std::vector<Obstacle>& obstacles() const;  ///< those of the scene, of its robot's links, then those that were set
  const Findings& findings() const;

  /// Starts the waiting cables and nets whose frames are known now, at their default or given shapes. How many.
  int start_waiting(const BoundaryInputs& inputs);
  EditResult apply(const Edit& edit);
  /// Takes over gravity, fluid, materials (those it has, by name) and the friction between cables from a sound scene. Throws
  /// SceneError, and changes nothing, where a cable that was joined with another would lack torsional stiffness for its rest
  /// shape.
  void tune(const SceneDesc& scene);

  Energy energy() const;
  /// All joints of a cable from start to end: of inner nodes, and those of clamps with the segments beside them.
  void view_joints(int cable, std::vector<JointView>& joints) const;
  std::uint64_t hash() const;  ///< of all that the future depends on

 private:
  friend struct WorldInspector;  // tests
  friend class WorldStepper;
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Index of the cable, net, body, attachment or guide of a name, -1 if there is none.
int find(const std::vector<SimulatedCable>& cables, const std::string& name);
int find(const std::vector<SimulatedNet>& nets, const std::string& name);
int find(const std::vector<SimulatedBody>& bodies, const std::string& name);
int find(const std::vector<Attachment>& attachments, const std::string& name);
int find(const std::vector<SimulatedGuide>& guides, const std::string& name);

/// Whether a pose can be worked with: coordinates within 1e9 m, and an orientation whose length is from 0.5 to 2, which is
/// brought to 1.
bool is_sound(const Pose& pose);
/// Frames that a scene names, by id: the fixed frame first, then in order of appearance, each once.
std::vector<std::string> frame_names(const SceneDesc& scene);
/// Frames whose poses are results, which follow those: of the scene's bodies, then of its junctions.
std::vector<std::string> computed_frame_names(const SceneDesc& scene);
/// Initial poses of the scene's frames, by id; `known` is false where the scene gives none.
BoundaryInputs initial_frames(const SceneDesc& scene);
/// Inextensible cables that are shorter than the distance of two neighbouring attachments with the frames at `frames` (by id;
/// unknown ones are left out): one line each, like `validate`, which does this at the initial poses.
std::vector<std::string> validate_distances(const SceneDesc& scene, const BoundaryInputs& frames);

}  // namespace verlet_cable
