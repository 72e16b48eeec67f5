#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contact_cache.h"
#include "holders.h"
#include "integrator.h"
#include "link_stepper.h"
#include "reel.h"
#include "twist.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What decides a cable's future besides the state that it shows.
struct CableMemory {
  std::uint32_t id = 0;  ///< ascending, never used again
  Holders holders;
  std::vector<TwistSpan> spans;
  std::optional<Reel> reel;  ///< of a winch that runs, or of a joint that closes
  ContactCache contacts;
  int level = 0;  ///< a step is tried in 2^level substeps
};

/// Likewise of a net.
struct NetMemory {
  Holders holders;
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
  std::vector<char> known;           ///< whether it has been seen, or given a pose

  /// The index of a name, their number if it is not there.
  int find(const std::string& name) const;
  FrameIds ids() const;
};

/// All that decides the future, and only that: its copy is a snapshot, its visit the world's hash.
struct State {
  std::shared_ptr<const SceneDesc> scene;  ///< as it was tuned; shared by copies
  std::vector<int> waiting_cables;         ///< indices into scene->cables
  std::vector<int> waiting_nets;           ///< indices into scene->nets
  Frames frames;
  std::int64_t steps = 0;
  std::vector<SimulatedCable> cables;
  std::vector<CableMemory> cable_memory;  ///< one a cable
  std::uint32_t next_cable_id = 0;
  std::vector<SimulatedNet> nets;
  std::vector<NetMemory> net_memory;  ///< one a net
  std::vector<SimulatedParticle> particles;
  std::vector<PointState> particle_memory;  ///< one a particle
  std::vector<Attachment> attachments;
  std::vector<Obstacle> obstacles;
  std::uint32_t next_obstacle_id = 0;

  double time() const { return static_cast<double>(steps) * scene->time_step; }
};

}  // namespace verlet_cable
