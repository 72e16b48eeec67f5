#pragma once

#include <optional>
#include <string>
#include <vector>

#include "edit_requests/location.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Errors as one line of text.
std::string join(const std::vector<std::string>& errors);

/// The answer to a request that has errors.
EditResult refused(const std::vector<std::string>& errors);

/// "(0, 0.5, 1)"
std::string point_text(const Vector3& v);

/// What waits for its frames cannot be named yet. `kind`: in the plural.
std::string waits_for_frames(const std::string& field, const std::string& name, const RequestWords& words,
                             const std::string& kind);

/// The same of a cable; nothing if it does not wait.
std::optional<std::string> why_cable_waits(const World& world, const std::string& field, const std::string& cable,
                                           const RequestWords& words);

/// Why there is no such cable; nothing if there is.
std::optional<std::string> why_no_cable(const World& world, const std::string& field, const std::string& cable,
                                        const RequestWords& words);

}  // namespace verlet_cable
