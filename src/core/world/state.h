#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "body/body_progress.h"
#include "contact/cache.h"
#include "fluid/waves.h"
#include "net/constraint_solver.h"
#include "particle/integrator.h"
#include "rod/twist.h"
#include "target/kinematic_targets.h"
#include "target/length_drive.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What decides a cable's future besides the state that it shows.
struct CableProgress {
  std::uint32_t id = 0;  ///< ascending: contacts name cables by it
  KinematicTargets targets;
  std::vector<TwistSpan> spans;
  std::optional<LengthDrive> drive;  ///< of a winch that runs, or of a joint that closes
  ContactCache contacts;
  int level = 0;      ///< a step is tried in 2^level substeps
  double energy = 0;  ///< [J] as the ledger has it
};

/// Likewise of a net.
struct NetProgress {
  KinematicTargets targets;
  PointState points;  ///< of springs
  LinkMemory links;   ///< of limited and rigid links
};

/// Of frames, by their names; no name is the fixed frame's.
using FrameIds = std::map<std::string, int>;

/// Where frames are; one entry a frame, by frame id.
struct Frames {
  std::vector<std::string> names;
  std::vector<Pose> poses;           ///< at the world's time
  std::vector<Pose> previous_poses;  ///< a step before; of a frame that is new to a step, its first
  std::vector<Pose> earlier_poses;   ///< two steps before, likewise
  std::vector<char> known;           ///< whether it has been seen, or given a pose
  int steps_unjudged = 0;            ///< from the next one on, in which no frame shows a jump: time was left out

  /// The index of a name, their number if it is not there.
  int find(const std::string& name) const;
  FrameIds ids() const;
};

struct State;
/// The step that is being done, as it is for frames.
FrameStep step_of_frames(const State& state);

/// All that decides the future, and only that: its copy is a snapshot, its visit the world's hash.
struct State {
  std::shared_ptr<const SceneDesc> scene;  ///< as it was tuned; shared by copies
  std::vector<Wave> waves;                 ///< of the scene's fluid; follow from the scene
  std::vector<int> waiting_cables;         ///< indices into scene->cables
  std::vector<int> waiting_nets;           ///< indices into scene->nets
  Frames frames;
  std::int64_t steps = 0;
  std::vector<SimulatedCable> cables;
  std::vector<CableProgress> cable_progress;  ///< one a cable
  std::vector<SimulatedNet> nets;
  std::vector<NetProgress> net_progress;  ///< one a net
  std::vector<SimulatedParticle> particles;
  std::vector<PointState> particle_integrators;  ///< one a particle
  std::vector<SimulatedBody> bodies;
  std::vector<BodyProgress> body_progress;  ///< one a body
  std::vector<Attachment> attachments;
  std::vector<SimulatedGuide> guides;
  std::vector<Obstacle> obstacles;
  std::vector<Load> loads;
  Ledger ledger;              ///< but for `change`
  double initial_energy = 0;  ///< [J] of World::energy(), where the ledger begins

  std::uint32_t new_cable_id() const { return cable_progress.empty() ? 0 : cable_progress.back().id + 1; }
  std::uint32_t new_obstacle_id() const { return obstacles.empty() ? 0 : obstacles.back().id + 1; }
  /// The index of the body whose frame it is, -1 if it is none's.
  int body_of_frame(int frame) const {
    const int body = bodies.empty() ? -1 : frame - bodies.front().frame;
    return body >= 0 && body < static_cast<int>(bodies.size()) ? body : -1;
  }
  double time() const { return static_cast<double>(steps) * scene->time_step; }
};

}  // namespace verlet_cable
