#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <algorithm>
#include <cstdio>

#include "bullet_world.h"
#include "rope.h"

namespace verlet_cable::bench {

namespace {

/// What a step costs besides its iterations, in iterations: only orders the search.
constexpr double overhead_iterations = 8;

btVector3 vector(const Vector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// A soft-body rope of stiffest links, without damping or collisions, its links in the order from the start.
class BulletRope : public Rope {
 public:
  BulletRope(const RopeTask& task, double time_step, int iterations) : hand_(task.hand), time_step_(time_step) {
    const int n = task.segments;
    rope_ = btSoftBodyHelpers::CreateRope(bullet_.world.getWorldInfo(), vector(task.positions[0]), vector(task.positions[n]),
                                          n - 1, hand_ ? 1 + 2 : 1);
    for (int i = 0; i <= n; ++i) {
      btSoftBody::Node& node = rope_->m_nodes[i];
      node.m_x = node.m_q = vector(task.positions[i]);
      if (i > 0 && !(hand_ && i == n)) rope_->setMass(i, task.node_mass(i));
    }
    // The rest lengths were those of a straight rope between the ends.
    for (int i = 0; i < rope_->m_links.size(); ++i) rope_->m_links[i].m_rl = task.length / n;
    bullet_.add(*rope_, iterations);
  }
  ~BulletRope() override {
    bullet_.world.removeSoftBody(rope_);
    delete rope_;
  }
  BulletRope(const BulletRope&) = delete;
  BulletRope& operator=(const BulletRope&) = delete;

  void advance() override {
    ++steps_;
    if (hand_) {
      btSoftBody::Node& node = rope_->m_nodes[rope_->m_nodes.size() - 1];
      const btVector3 target = vector(hand_(time()));
      // Nodes without inverse mass move by their velocity.
      node.m_v = (target - node.m_x) / time_step_;
    }
    bullet_.world.stepSimulation(time_step_, 0);
  }
  double time() const override { return static_cast<double>(steps_) * time_step_; }
  void observe(std::vector<Vector3>& positions, std::vector<Vector3>& velocities) const override {
    const int nodes = rope_->m_nodes.size();
    positions.resize(nodes);
    velocities.resize(nodes);
    for (int i = 0; i < nodes; ++i) {
      const btSoftBody::Node& node = rope_->m_nodes[i];
      positions[i] = {node.m_x.x(), node.m_x.y(), node.m_x.z()};
      velocities[i] = {node.m_v.x(), node.m_v.y(), node.m_v.z()};
    }
  }

 private:
  std::function<Vector3(double)> hand_;
  double time_step_;
  long steps_ = 0;
  BulletWorld bullet_;
  btSoftBody* rope_;
};

}  // namespace

std::vector<Candidate> bullet_candidates(const RopeTask& task) {
  struct Setting {
    double time_step;
    int iterations;
    double cost() const { return (iterations + overhead_iterations) / time_step; }
  };
  std::vector<Setting> settings;
  for (const double milliseconds : {10.0, 5.0, 2.0, 1.0, 0.5, 0.25, 0.1, 0.05, 0.025, 0.01})
    for (const int iterations : {1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100, 150, 200, 300, 500, 700, 1000, 2000})
      settings.push_back({1e-3 * milliseconds, iterations});
  std::stable_sort(settings.begin(), settings.end(), [](const Setting& a, const Setting& b) { return a.cost() < b.cost(); });
  std::vector<Candidate> candidates;
  for (const Setting& s : settings) {
    char name[64];
    std::snprintf(name, sizeof name, "%g ms, %d it.", 1e3 * s.time_step, s.iterations);
    candidates.push_back({name, [task, s] { return std::make_unique<BulletRope>(task, s.time_step, s.iterations); }});
  }
  return candidates;
}

}  // namespace verlet_cable::bench
