#include <algorithm>
#include <cmath>

#include "chain/direction.h"
#include "guide/guides.h"
#include "guide/side.h"
#include "rod/joint_views.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/world.h"
#include "world/energy.h"
#include "world/implementation.h"
#include "world/state_bytes.h"
#include "world/state_fields.h"

namespace verlet_cable {

namespace {

/// [m/s] What a winch slips by less is rounding.
constexpr double rounded_slip = 1e-9;

template <class T, class Is>
int index_of(const std::vector<T>& list, const Is& is) {
  const auto found = std::find_if(list.begin(), list.end(), is);
  return found == list.end() ? -1 : static_cast<int>(found - list.begin());
}

}  // namespace

double World::time() const {
  return implementation_->state.time();
}
std::int64_t World::steps() const {
  return implementation_->state.steps;
}
double World::time_step() const {
  return implementation_->state.scene->time_step;
}
const std::vector<std::string>& World::frames() const {
  return implementation_->state.frames.names;
}
const Pose& World::frame_pose(int frame) const {
  return implementation_->state.frames.poses[frame];
}
bool World::frame_known(int frame) const {
  return implementation_->state.frames.known[frame];
}
const std::vector<SimulatedCable>& World::cables() const {
  return implementation_->state.cables;
}
const std::vector<SimulatedNet>& World::nets() const {
  return implementation_->state.nets;
}

const std::vector<SimulatedParticle>& World::particles() const {
  return implementation_->state.particles;
}

const std::vector<Load>& World::loads() const {
  return implementation_->state.loads;
}

const std::vector<SimulatedBody>& World::bodies() const {
  return implementation_->state.bodies;
}

bool World::is_body_frame(int frame) const {
  return std::any_of(bodies().begin(), bodies().end(), [&](const SimulatedBody& body) { return body.frame == frame; });
}

const std::vector<Attachment>& World::attachments() const {
  return implementation_->state.attachments;
}
const std::vector<SimulatedGuide>& World::guides() const {
  return implementation_->state.guides;
}
GuideView World::view_guide(int guide) const {
  GuideView view;
  for (const Attachment& attachment : attachments()) {
    if (attachment.guide != guide) continue;
    view.cable = attachment.body.index;
    const CableState& cable = cables()[view.cable].state;
    const int first = attachment.node, last = last_node(attachment);
    view.arc_length = arc_length_at(attachment, cable);
    // Half a segment before and after it weighs, and is accelerated.
    const double density = CableMaterials(cables()[view.cable])[first].linear_density;
    const Vector3 gravity = implementation_->state.scene->gravity.at(cable.positions[first]);
    const auto half = [&](int i) {
      const Vector3 along = segment_direction(cable, i);
      return 0.5 * density * cable.rest_lengths[i] * (gravity.dot(along) - guides()[guide].flow_acceleration);
    };
    view.tension = {cable.tension[first - 1] - half(first - 1), cable.tension[last] + half(last)};
  }
  return view;
}
std::optional<WinchView> World::view_winch(int cable) const {
  const std::optional<LengthDrive>& drive = implementation_->state.cable_progress[cable].drive;
  if (!drive || !drive->is_winch()) return std::nullopt;
  const CableState& state = cables()[cable].state;
  WinchView view;
  view.at_end = drive->place == LengthDrive::Place::end;
  if (drive->keeps_tension) {
    view.kind = drive->tension > 0 ? WinchView::Kind::tension : WinchView::Kind::free_spool;
    view.goal = drive->tension;
  } else {
    view.goal = state.length() + drive->debt + drive->left;
    view.max_tension = drive->tension;
  }
  view.tension = state.tension[drive->segment];
  view.speed = drive->rate + drive->slip;
  view.slips = drive->slip > rounded_slip;
  return view;
}

const std::vector<Obstacle>& World::obstacles() const {
  return implementation_->state.obstacles;
}
const Findings& World::findings() const {
  return implementation_->findings;
}

int find(const std::vector<SimulatedCable>& cables, const std::string& name) {
  return index_of(cables, [&](const SimulatedCable& cable) { return cable.model->name == name; });
}

int find(const std::vector<SimulatedNet>& nets, const std::string& name) {
  return index_of(nets, [&](const SimulatedNet& net) { return net.model.name == name; });
}

int find(const std::vector<SimulatedBody>& bodies, const std::string& name) {
  return index_of(bodies, [&](const SimulatedBody& body) { return !body.is_junction && body.name == name; });
}

int find(const std::vector<Attachment>& attachments, const std::string& name) {
  // Guides have names of their own, which attachments may have, too.
  const auto find_among = [&](bool guides) {
    return index_of(attachments, [&](const Attachment& a) { return a.name == name && (a.guide >= 0) == guides; });
  };
  const int attachment = find_among(false);
  return attachment >= 0 ? attachment : find_among(true);
}

int find(const std::vector<SimulatedGuide>& guides, const std::string& name) {
  return index_of(guides, [&](const SimulatedGuide& guide) { return guide.name == name; });
}

Energy World::energy() const {
  return implementation_->energy();
}

Ledger World::ledger() const {
  Ledger ledger = implementation_->state.ledger;
  ledger.change = energy().total() - implementation_->state.initial_energy;
  return ledger;
}

void World::view_joints(int index, std::vector<JointView>& joints) const {
  joints.clear();
  visit_joints(cables()[index].state, implementation_->state.cable_progress[index].targets.directions, [&](const Joint& joint) {
    joints.push_back({joint.place, joint.curvature(), joint.twist});
  });
}

const SceneDesc& World::scene() const {
  return *implementation_->state.scene;
}

std::uint64_t World::hash() const {
  return verlet_cable::hash(implementation_->state);
}

std::string World::save() const {
  return bytes_of(implementation_->state, findings(), implementation_->told_unsettled);
}

void World::restore(const std::string& bytes) {
  auto next = std::make_unique<Implementation>(*implementation_);
  verlet_cable::restore(bytes, next->state, next->findings, next->told_unsettled);
  next->name_waiting();
  implementation_ = std::move(next);
}

}  // namespace verlet_cable
