#pragma once

#include <cstdint>

namespace verlet_cable {

/// Of publishers [messages]: what was held up by a late frame is caught up, and published, at once: up to a second of ticks.
constexpr std::uint32_t publisher_queue_size = 100;

}  // namespace verlet_cable
