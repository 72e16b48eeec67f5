#include "contact/following_friction.h"

#include <algorithm>
#include <cmath>

#include "chain/point_motion.h"

namespace verlet_cable {

namespace {

/// Friction has followed the normal forces when displacements at the contacts change by less than this, relatively, or by this
/// part of what is tolerated.
constexpr double followed = 0.1;
constexpr double followed_part = 0.2;
constexpr int maximum_followings = 20;

}  // namespace

void FollowingFriction::solve(std::vector<Touch>& touches, const std::vector<int>& index, double tolerated,
                              std::vector<Participant>& participants) {
  slips_.clear();
  cables_.resize(std::max(cables_.size(), participants.size()));
  for (std::size_t k = 0; k < participants.size(); ++k) cables_[k].slips = false;
  for (Touch& touch : touches) {
    if (touch.mode == Touch::Mode::open || !(touch.friction > 0)) continue;
    Slip slip;
    slip.touch = &touch;
    slip.participant = index[touch.point.cable];
    slip.normal = touch.normal;
    slip.friction = following_friction(touch);
    if (slip.friction.isZero(0)) continue;
    slip.normal_force = touch.normal_force;
    slip.stiffness = touch.rate * touch.normal_stiffness;
    slips_.push_back(slip);
    cables_[slip.participant].slips = true;
  }
  if (slips_.empty()) return;
  for (std::size_t k = 0; k < participants.size(); ++k)
    if (cables_[k].slips) cables_[k].kept_load = participants[k].stepper->system().load;
  double last = follow(tolerated, participants);
  bool follows = true;
  for (int i = 0; i < maximum_followings && follows && last > 0; ++i) {
    solve_again(participants);
    const double way = follow(tolerated, participants);
    if (!(way > 0)) break;
    follows = way < last;
    last = way;
  }
  for (std::size_t k = 0; k < participants.size(); ++k)
    if (cables_[k].slips) std::swap(participants[k].stepper->system().load, cables_[k].kept_load);
  if (follows) return;
  // Where it gets away from them, without.
  solve_again(participants);
  for (const Slip& slip : slips_) slip.touch->followed.setZero();
}

/// Adds to the loads what friction changes with the normal forces in the present solution. How far that has come since the last
/// time [m], 0 if no distance.
double FollowingFriction::follow(double tolerated, std::vector<Participant>& participants) {
  double way = 0, largest = 0;
  for (Slip& slip : slips_) {
    CableStepper& stepper = *participants[slip.participant].stepper;
    const Vector3 displacement = at_point(slip.touch->point, stepper.correction());
    way = std::max(way, (displacement - slip.displacement).squaredNorm());
    largest = std::max(largest, displacement.squaredNorm());
    slip.displacement = displacement;
    const double change = std::max(-slip.stiffness * slip.normal.dot(displacement), -slip.normal_force);
    add_force(slip.touch->point, (change - slip.change) * slip.friction, stepper.system().load);
    slip.change = change;
  }
  way = std::sqrt(way);
  return way > std::max(followed * std::sqrt(largest), followed_part * tolerated) ? way : 0;
}

void FollowingFriction::solve_again(std::vector<Participant>& participants) {
  for (std::size_t k = 0; k < participants.size(); ++k)
    if (cables_[k].slips) participants[k].stepper->solve_linear();
  for (const Slip& slip : slips_) slip.touch->followed = slip.change * slip.friction;
}

}  // namespace verlet_cable
