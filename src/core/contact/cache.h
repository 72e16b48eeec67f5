#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "contact/law.h"

namespace verlet_cable {

/// What a contact takes from one substep to the next.
struct CachedContact {
  std::uint64_t key = 0, other_key = 0;  ///< of the touch
  Vector3 force = Vector3::Zero();       ///< [N] friction of what sticks
  double normal_force = 0;               ///< [N]
  Touch::Mode mode = Touch::Mode::open;
  bool inside = false;
  double inside_for = 0;  ///< [s]
};

/// What of a touch stays when the substep is done.
inline CachedContact kept(const Touch& touch) {
  return {touch.key, touch.other_key, remaining_friction(touch), touch.normal_force, touch.mode, touch.inside, touch.inside_for};
}
/// Goes on with what stayed of it.
inline void go_on_from(const CachedContact& last, Touch& touch) {
  touch.stuck_force = half_turned(touch, last.force);
  touch.mode = last.mode;
  touch.last_force = last.normal_force;
  touch.inside = last.inside;
  touch.inside_for = last.inside_for;
}
/// Of a touch or a contact, to compare them by.
template <class Contact>
auto keys(const Contact& of) {
  return std::tie(of.key, of.other_key);
}

/// Of the touches whose point is on one cable: ascending by keys.
using ContactCache = std::vector<CachedContact>;

/// The one of a touch with these keys, or null.
inline const CachedContact* find_cached(const ContactCache& cache, std::uint64_t key, std::uint64_t other_key) {
  const auto sought = std::tie(key, other_key);
  const auto found =
      std::lower_bound(cache.begin(), cache.end(), sought, [](const CachedContact& c, const auto& of) { return keys(c) < of; });
  return found != cache.end() && keys(*found) == sought ? &*found : nullptr;
}

/// Whether what touches bore a force in the substep before. Without that it goes where the cable's own forces take it, which its
/// velocity does not tell.
inline bool bore(const ContactCache& cache, std::uint64_t key, std::uint64_t other_key) {
  const CachedContact* const last = find_cached(cache, key, other_key);
  return last != nullptr && last->mode != Touch::Mode::open;
}

/// Keys of touches: cables and obstacles by their ids, which no edit changes.
constexpr std::uint64_t body_key = std::uint64_t{1} << 62;  // bodies come after obstacles,
constexpr std::uint64_t pair_key = std::uint64_t{1} << 63;  // pairs after those
inline std::uint64_t key_of(std::uint32_t high, std::uint32_t low) {
  return static_cast<std::uint64_t>(high) << 32 | low;
}
/// Forgets contacts with a cable whose segments count anew, or that is gone.
inline void forget_cable(std::uint32_t id, ContactCache& cache) {
  const auto names_it = [&](const CachedContact& c) { return (c.key & pair_key) != 0 && c.other_key >> 32 == id; };
  cache.erase(std::remove_if(cache.begin(), cache.end(), names_it), cache.end());
}
/// Forgets contacts with an obstacle that is gone.
inline void forget_obstacle(std::uint32_t id, ContactCache& cache) {
  cache.erase(std::remove_if(cache.begin(), cache.end(), [&](const CachedContact& c) { return c.key == id; }), cache.end());
}

}  // namespace verlet_cable
