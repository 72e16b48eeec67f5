#include "world/balance.h"

namespace verlet_cable {

double work_of(const Vector3& force, const Vector3& way, const Vector3& torque, const Quaternion& from, const Quaternion& to) {
  const Quaternion turn = to * from.conjugate();
  return force.dot(way) + 2 / turn.w() * torque.dot(turn.vec());
}

double work_of_holders(const Boundary& boundary) {
  double work = 0;
  for (const HeldNode& held : boundary.nodes)
    if (held.body < 0) work -= held.force.dot(held.displacement);
  for (const HeldDirection& held : boundary.directions)
    if (held.body < 0) work -= work_of(Vector3::Zero(), Vector3::Zero(), held.torque, held.start, held.end);
  return work;
}

double unresolved_work_of_holders(const Boundary& boundary) {
  double work = 0;
  for (const HeldNode& held : boundary.nodes)
    if (held.body < 0) work -= held.mending_force.dot(held.displacement) + held.unresolved;
  return work;
}

void balance_contacts(const std::vector<Touch>& touches, EnergyBalance& balance) {
  for (const Touch& touch : touches) {
    if (touch.mode == Touch::Mode::open) continue;
    const Vector3& moved = touch.other_motion.displacement;
    const Vector3 force = corrected_force(touch);
    balance.work.obstacles += force.dot(moved);
    balance.dissipated.contact -= force.dot(touch.displacement - moved);
  }
}

}  // namespace verlet_cable
