#include <cstring>

#include "verlet_cable/core/world.h"
#include "world_implementation.h"

namespace verlet_cable {

namespace {

/// FNV-1a over the bytes of numbers: the same state, the same hash, whatever the padding.
class Hash {
 public:
  void add(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    add_bits(bits);
  }
  void add_bits(std::uint64_t bits) {
    for (int i = 0; i < 8; ++i) {
      value_ ^= (bits >> (8 * i)) & 0xff;
      value_ *= 1099511628211ull;
    }
  }
  void add(const Vector3& v) {
    for (int i = 0; i < 3; ++i) add(v[i]);
  }
  void add(const Quaternion& q) {
    for (int i = 0; i < 4; ++i) add(q.coeffs()[i]);
  }
  void add(const Pose& pose) {
    add(pose.position);
    add(pose.orientation);
  }
  void add(const std::string& text) {
    add_bits(text.size());
    for (const char c : text) add_bits(static_cast<unsigned char>(c));
  }
  void add(const Obstacle& obstacle) {
    add(obstacle.name);
    add_bits(static_cast<std::uint64_t>(obstacle.frame) << 1 | static_cast<std::uint64_t>(obstacle.present));
    add(obstacle.pose);
    add_bits(obstacle.shape.index());
    const Aabb box = bounds(obstacle.shape, Pose{});
    add(Vector3(box.min()));
    add(Vector3(box.max()));
    if (const CapsuleShape* capsule = std::get_if<CapsuleShape>(&obstacle.shape)) add(capsule->radius);
    add(obstacle.friction.value_or(-1));
    add(obstacle.padding);
  }
  void add(const std::vector<Vector3>& vectors) {
    for (const Vector3& v : vectors) add(v);
  }
  void add(const Holder& h) {
    add_bits(static_cast<std::uint64_t>(h.node));
    for (const Vector3* v : {&h.position, &h.velocity, &h.mean_velocity, &h.gap, &h.frame_velocity, &h.average_velocity,
                             &h.change, &h.jumped_from, &h.carried})
      add(*v);
    add(h.caught);
    for (const double v : {h.liveliness, h.first_excess, h.last_excess, h.least_excess, h.greatest_excess}) add(v);
    add_bits(static_cast<std::uint64_t>(h.jumping_steps));
    add_bits(h.starts);
  }
  void add(const PointState& points) {
    add_bits(static_cast<std::uint64_t>(points.known) << 2 | static_cast<std::uint64_t>(points.started) << 1 |
             static_cast<std::uint64_t>(points.is_first));
    if (points.started) add(points.accelerations);
    for (int i = 0; i < points.known; ++i) {
      add(points.history[i].velocities);
      add(points.history[i].accelerations);
    }
  }
  void add(const SimulatedNet& net, const NetScratch& s) {
    add(net.model.name);
    for (const double m : net.model.masses) add(m);
    for (const std::array<int, 2>& link : net.model.links)
      add_bits(static_cast<std::uint64_t>(link[0]) << 32 | static_cast<std::uint64_t>(link[1]));
    for (const double l : net.model.rest_lengths) add(l);
    add(net.state.positions);
    add(net.state.velocities);
    for (const double t : net.state.tension) add(t);
    add(s.point_memory);
    add_bits(s.link_memory.started);
    add(s.link_memory.midstep_velocities);
    for (const double impulse : s.link_memory.impulses) add(impulse);
    for (const Holder& h : s.holders.nodes) add(h);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037ull;
};

}  // namespace

double World::time() const {
  return implementation_->time();
}
std::int64_t World::steps() const {
  return implementation_->steps;
}
double World::time_step() const {
  return implementation_->scene.time_step;
}
const std::vector<std::string>& World::frames() const {
  return implementation_->frames;
}
const Pose& World::frame_pose(int frame) const {
  return implementation_->poses[frame];
}
bool World::frame_known(int frame) const {
  return implementation_->known[frame];
}
const std::vector<SimulatedCable>& World::cables() const {
  return implementation_->cables;
}
const std::vector<std::string>& World::waiting() const {
  return implementation_->waiting;
}
const std::vector<Attachment>& World::attachments() const {
  return implementation_->attachments;
}

const std::vector<std::string>& World::unsettled() const {
  return implementation_->unsettled;
}

const std::vector<std::string>& World::misfits() const {
  return implementation_->misfits;
}

const std::vector<Break>& World::breaks() const {
  return implementation_->breaks;
}

const std::vector<Jump>& World::jumps() const {
  return implementation_->jumps;
}

const std::vector<Intrusion>& World::intrusions() const {
  return implementation_->intrusions;
}

int World::find_cable(const std::string& name) const {
  for (std::size_t i = 0; i < cables().size(); ++i)
    if (cables()[i].model.name == name) return static_cast<int>(i);
  return -1;
}

int World::find_attachment(const std::string& name) const {
  for (std::size_t i = 0; i < attachments().size(); ++i)
    if (attachments()[i].name == name) return static_cast<int>(i);
  return -1;
}

Energy World::energy() const {
  Energy energy;
  const GravityDesc& gravity = implementation_->scene.gravity;
  for (std::size_t k = 0; k < cables().size(); ++k) {
    const SimulatedCable& cable = cables()[k];
    energy.bend += bending_energy(cable.model, cable.state, implementation_->scratch[k].boundary.directions);
    for (int i = 0; i < cable.model.nodes(); ++i) {
      energy.kinetic += 0.5 * cable.model.masses[i] * cable.state.velocities[i].squaredNorm();
      energy.gravity += cable.model.masses[i] * gravity.potential_at(cable.state.positions[i]);
    }
    for (int i = 0; i < cable.model.segments(); ++i)
      energy.twist += 0.5 * cable.model.material.torsional_stiffness * cable.model.rest_lengths[i] * cable.state.twist[i] *
                      cable.state.twist[i];
    if (cable.model.material.axial_stiffness == infinity) continue;
    for (int i = 0; i < cable.model.segments(); ++i) {
      const double e = strain(cable, i);
      energy.stretch += 0.5 * cable.model.material.axial_stiffness * cable.model.rest_lengths[i] * e * e;
    }
  }
  implementation_->add_net_energy(energy);
  return energy;
}

std::uint64_t World::hash() const {
  const Implementation& w = *implementation_;
  Hash hash;
  hash.add_bits(static_cast<std::uint64_t>(w.steps));
  for (std::size_t i = 0; i < w.frames.size(); ++i) {
    hash.add(w.frames[i]);
    hash.add(w.poses[i]);
  }
  for (std::size_t i = 0; i < w.cables.size(); ++i) {
    const SimulatedCable& cable = w.cables[i];
    hash.add(cable.model.name);
    for (const double l : cable.model.rest_lengths) hash.add(l);
    for (const double m : cable.model.masses) hash.add(m);
    for (const auto* vectors : {&cable.state.positions, &cable.state.velocities, &cable.state.accelerations})
      for (const Vector3& v : *vectors) hash.add(v);
    for (const double t : cable.state.tension) hash.add(t);
    for (const double t : cable.state.axial_multiplier) hash.add(t);
    for (const double t : cable.state.twist) hash.add(t);
    hash.add(cable.state.reference_orientation);
    for (const TwistSpan& span : w.scratch[i].spans) {
      hash.add(span.angle);
      hash.add(span.origin);
      hash.add_bits(static_cast<std::uint64_t>(span.age));
    }
    if (const std::optional<Reel>& reel = w.scratch[i].reel)
      for (const double value : {reel->left, reel->speed, reel->rate, reel->debt, reel->debt_rate}) hash.add(value);
    for (const DirectionHolder& h : w.scratch[i].holders.directions) {
      hash.add(h.orientation);
      hash.add(h.gap);
      hash.add(h.caught);
    }
    for (const Holder& h : w.scratch[i].holders.nodes) hash.add(h);
  }
  for (std::size_t i = 0; i < w.nets.size(); ++i) hash.add(w.nets[i], w.net_scratch[i]);
  for (std::size_t i = 0; i < w.particles.size(); ++i) {
    hash.add(w.particles[i].desc.name);
    hash.add(w.particles[i].position);
    hash.add(w.particles[i].velocity);
    hash.add(w.particle_memory[i]);
  }
  for (const Obstacle& obstacle : w.obstacles) hash.add(obstacle);
  for (const ContactGroup& group : w.groups) {
    hash.add_bits(static_cast<std::uint64_t>(group.level));
    for (const Sticking& sticking : group.contacts.sticking()) {
      hash.add_bits(sticking.key);
      hash.add_bits(sticking.other_key);
      hash.add(sticking.force);
    }
  }
  for (const Attachment& a : w.attachments) {
    hash.add(a.name);
    hash.add_bits(static_cast<std::uint64_t>(a.net < 0 ? a.cable : ~a.net) << 32 | static_cast<std::uint64_t>(a.node));
    hash.add_bits(static_cast<std::uint64_t>(a.frame));
    hash.add(a.pose);
  }
  return hash.value();
}

}  // namespace verlet_cable
