#include <cmath>

#include "hand.h"
#include "rope.h"
#include "scenes.h"

namespace verlet_cable::bench {

namespace {

constexpr double pi = 3.14159265358979323846;

class CableRope : public Rope {
 public:
  CableRope(const RopeTask& task, double time_step) : hand_(task.hand), inputs_(1) {
    SceneDesc scene = hand_ ? scenes::held_by_a_hand(task.segments) : scenes::released(task.segments, 0.5 * pi);
    scene.time_step = time_step;
    scene.numerical_damping = task.numerical_damping;
    if (hand_) inputs_ = scenes::hand_at(hand_(0));
    world_ = std::make_unique<World>(scene, inputs_);
  }
  void advance() override {
    if (hand_) inputs_[1].pose.position = hand_(time() + world_->time_step());
    world_->step(inputs_);
  }
  double time() const override { return world_->time(); }
  void observe(std::vector<Vector3>& positions, std::vector<Vector3>& velocities) const override {
    positions = world_->cables()[0].state.positions;
    velocities = world_->cables()[0].state.velocities;
  }

 private:
  std::function<Vector3(double)> hand_;
  BoundaryInputs inputs_;
  std::unique_ptr<World> world_;
};

/// The same place for every engine: where the package hangs or lays its cable.
void take_initial_positions(RopeTask& task) {
  std::vector<Vector3> velocities;
  CableRope(task, 1e-3).observe(task.positions, velocities);
}

}  // namespace

RopeTask released_from_horizontal(int segments) {
  RopeTask task;
  task.segments = segments;
  take_initial_positions(task);
  return task;
}

RopeTask driven(int segments) {
  RopeTask task;
  task.segments = segments;
  task.hand = driven_hand;
  take_initial_positions(task);
  return task;
}

std::vector<Candidate> cable_candidates(const RopeTask& task) {
  std::vector<Candidate> candidates;
  // Fractions of 20 ms, which divides 0.4 s and the interval at which runs are compared.
  for (const int parts : {1, 2, 4, 8, 10, 20, 40, 80}) {
    const double time_step = 0.02 / parts;
    candidates.push_back({std::to_string(20.0 / parts).substr(0, 5) + " ms",
                          [task, time_step] { return std::make_unique<CableRope>(task, time_step); }});
  }
  return candidates;
}

}  // namespace verlet_cable::bench
