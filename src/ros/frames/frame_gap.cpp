#include "frames/frame_gap.h"

namespace verlet_cable {

FrameGap FrameGap::between(const Pose& frame, const Pose& followed) {
  FrameGap gap;
  gap.way = followed.position - frame.position;
  gap.turn = (followed.orientation * frame.orientation.conjugate()).normalized();
  return gap;
}

void FrameGap::move(const Pose& from, const Pose& to, double time) {
  const bool is_fast = (to.position - from.position).norm() > fastest_motion * time;
  const FrameGap left = between(to, followed(from));
  const bool goes_back = is_fast && (recoils || left.distance() < distance());
  if (goes_back) *this = left;
  recoils = goes_back;
}

void FrameGap::close_by(double by_distance, double by_angle) {
  const double whole_way = distance(), whole_turn = angle();
  way = whole_way > by_distance ? Vector3((1 - by_distance / whole_way) * way) : Vector3(Vector3::Zero());
  turn = whole_turn > by_angle ? turn.slerp(by_angle / whole_turn, Quaternion::Identity()).normalized() : Quaternion::Identity();
}

Pose FrameGap::followed(const Pose& frame) const {
  if (is_closed()) return frame;
  return {frame.position + way, (turn * frame.orientation).normalized()};
}

Pose FrameGap::frame(const Pose& followed) const {
  if (is_closed()) return followed;
  return {followed.position - way, (turn.conjugate() * followed.orientation).normalized()};
}

}  // namespace verlet_cable
