#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace verlet_cable::tools {

// Its objects keep the order of their keys from version 3.9 on. Ubuntu 20.04 has 3.7, which sorts them.
#if NLOHMANN_JSON_VERSION_MAJOR > 3 || NLOHMANN_JSON_VERSION_MINOR >= 9
using Json = nlohmann::ordered_json;
#else
using Json = nlohmann::json;
#endif

/// A file's text, indented. Numbers that JSON does not have are null; bytes that are no UTF-8 are replaced.
inline std::string file_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace verlet_cable::tools
