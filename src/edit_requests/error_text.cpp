#include "edit_requests/error_text.h"

#include <algorithm>

namespace verlet_cable {

std::string join(const std::vector<std::string>& errors) {
  constexpr std::size_t most = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(errors.size(), most); ++i) text += (i == 0 ? "" : "; ") + errors[i];
  return errors.size() <= most ? text : text + "; and " + std::to_string(errors.size() - most) + " more";
}

EditResult refused(const std::vector<std::string>& errors) {
  return {false, join(errors), {}};
}

}  // namespace verlet_cable
