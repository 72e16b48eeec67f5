#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "arbitrary.h"
#include "require.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::fuzz {

/// A world to which the input does what it likes, in any order. After each call its numbers are finite, refused edits have
/// changed nothing, no mass has come or gone but by winches, and copies have gone on with the same bytes; else the process ends.
class WorldMachine {
 public:
  /// `world`: of that scene, as it started with its initial frames.
  WorldMachine(const SceneDesc& scene, const World& world, Arbitrary& input);

  /// Does one thing.
  void act();
  /// Whether it has worked so much that more of it would take too long.
  bool is_tired() const { return effort_ > most_effort; }

 private:
  static constexpr int most_effort = 600;

  // What is done.
  void move_frame();
  void disturb_frame();
  void step_some();
  void start_waiting();
  void settle();
  void copy();
  void reset();
  void save_or_restore();
  void pin();
  void unpin();
  void move_attachment();
  void cut();
  void set_length();
  void set_tension();
  void join();
  void cut_and_join();
  void set_obstacle();
  void remove_obstacle();
  void tune();
  void apply_load();
  void set_state();

  void step();
  void apply(const Edit& edit);
  /// Does to the world, and to its copy, what `call` does, with the same result.
  template <class Call>
  auto on_both(const Call& call);
  /// [kg] that winches can have changed the cables' masses by in a step.
  double most_wound() const;

  // Of what there is, by the input.
  BodyId any_body();
  int any_cable();
  int any_frame();
  int any_node(const BodyId& body);
  Vector3 place_of(const BodyId& body, int node) const;
  std::vector<Vector3> any_vectors(const std::vector<Vector3>& near, double most_away);
  edit::SetState::OfCable any_cable_state();
  edit::SetState::OfBody any_body_state();
  std::vector<std::string> attachment_names() const;

  Arbitrary& input_;
  SceneDesc scene_;
  BoundaryInputs frames_;
  Vector3 velocity_ = Vector3::Zero();  ///< [m/s] of the frame that moves
  std::size_t moving_frame_ = 0;
  double winch_speed_ = 0;  ///< [m/s] the most that a winch was given
  int effort_ = 0;          ///< substeps, and iterations in them
  World world_;
  std::optional<World> copy_;  ///< that is to go on like the world, with other lanes
  World saved_;
  BoundaryInputs saved_frames_;
};

template <class Call>
auto WorldMachine::on_both(const Call& call) {
  const auto and_compare = [&] {
    if (!copy_) return;
    call(*copy_);
    require(copy_->hash() == world_.hash(), "a copy goes on with the same bytes");
  };
  if constexpr (std::is_void_v<decltype(call(world_))>) {
    call(world_);
    and_compare();
  } else {
    const auto result = call(world_);
    and_compare();
    return result;
  }
}

}  // namespace verlet_cable::fuzz
