#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <string>
#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable::fuzz {

/// A world to which the input does what it likes, in any order. After each call its numbers are finite, refused edits have changed
/// nothing, no mass has come or gone but by winches, and copies go on with the same bytes; else the process ends.
class WorldMachine {
 public:
  WorldMachine(const SceneDesc& scene, FuzzedDataProvider& input);

  /// Does one thing.
  void act();

 private:
  void move_frames();
  void step(int steps);
  void step_copy_alike();
  void apply(const Edit& edit);
  void pin();
  void set_obstacle();
  void tune();
  void put_back();

  BodyId any_body();
  int any_node(const BodyId& body);
  std::string any_name(const std::vector<std::string>& names);
  std::vector<std::string> attachment_names() const;
  std::vector<std::string> obstacle_names() const;
  double any_number();
  double any_coordinate();
  Vector3 any_vector();
  Pose any_pose();

  FuzzedDataProvider& input_;
  SceneDesc scene_;
  BoundaryInputs frames_;
  World world_;
  World saved_;
  BoundaryInputs saved_frames_;
};

}  // namespace verlet_cable::fuzz
