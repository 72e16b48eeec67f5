#include "world/step_contacts.h"

#include <algorithm>
#include <tuple>

#include "chain/point_motion.h"
#include "contact/cache.h"
#include "world/state.h"

namespace verlet_cable {

namespace {

/// As they are found: of cables with solids, of cables with cables, of bodies.
int kind_of(const SimulatedContact& contact) {
  return contact.cable < 0 ? 2 : contact.other_cable >= 0 ? 1 : 0;
}

template <class Contact>
auto order_of(const Contact& c) {
  return std::make_tuple(kind_of(c.mean), c.mean.cable, c.mean.cable < 0 ? c.mean.body : 0, c.key, c.other_key);
}

}  // namespace

const std::string& name_of_touched(const SimulatedContact& contact, const State& state) {
  if (contact.obstacle >= 0) return state.obstacles[contact.obstacle].name;
  if (contact.body >= 0) return state.bodies[contact.body].name;
  return state.cables[contact.other_cable].model->name;
}

void StepContacts::add(const std::vector<Touch>& touches, const std::vector<Touch>& on_obstacles,
                       const std::vector<SimulatedCable>& cables, double part) {
  if (contacts_.empty()) substeps_ = 0;
  for (const Touch& touch : touches) {
    if (touch.mode == Touch::Mode::open) continue;
    const std::vector<Vector3>& nodes = cables[touch.point.cable].state.positions;
    const Vector3 position = on_centre_line(touch.point, nodes), force = part * corrected_force(touch);
    Vector3 torque = Vector3::Zero();
    share_force(touch.point, force, [&](int i, const Vector3& share) { torque += (nodes[i] - position).cross(share); });
    contacts_.push_back(
        {touch.key,
         touch.other_key,
         substeps_,
         {touch.point.cable, touch.point.segment, position, touch.normal, force, touch.obstacle, touch.other.cable,
          touch.other.segment, touch.obstacle < 0 ? touch.body : -1, torque, touch.length, touch.other_length}});
  }
  for (const Touch& touch : on_obstacles) {
    if (touch.mode == Touch::Mode::open) continue;
    SimulatedContact contact;
    contact.position = touch.position + touch.displacement;
    contact.normal = touch.normal;
    contact.force = part * corrected_force(touch);
    contact.obstacle = touch.obstacle;
    contact.body = touch.body;
    contacts_.push_back({touch.key, touch.other_key, substeps_, contact});
  }
  ++substeps_;
}

void StepContacts::collect(std::vector<SimulatedContact>& of_cables, std::vector<SimulatedContact>& of_bodies) {
  if (substeps_ > 1) merge();
  for (const Contact& contact : contacts_) (contact.mean.cable < 0 ? of_bodies : of_cables).push_back(contact.mean);
}

/// Each is where it was in the last of its substeps.
void StepContacts::merge() {
  std::sort(contacts_.begin(), contacts_.end(), [](const Contact& a, const Contact& b) {
    const auto of_a = order_of(a), of_b = order_of(b);
    return of_a != of_b ? of_a < of_b : a.substep < b.substep;
  });
  auto last = contacts_.begin();
  for (auto next = contacts_.begin(); next != contacts_.end(); ++next) {
    if (next == last) continue;
    if (order_of(*next) != order_of(*last)) {
      *++last = *next;
      continue;
    }
    next->mean.force += last->mean.force;
    next->mean.torque += last->mean.torque;
    *last = *next;
  }
  if (!contacts_.empty()) contacts_.erase(last + 1, contacts_.end());
}

}  // namespace verlet_cable
