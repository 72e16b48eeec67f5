#pragma once

#include <yaml-cpp/exceptions.h>

#include <string>

namespace verlet_cable {

/// What a text that is not YAML most likely lacks, with its line, as yaml-cpp only says where it could not go on: a tab, a space
/// after a colon, a bracket that is not closed, ...; empty where there is no saying.
std::string yaml_hint(const std::string& text, const YAML::Exception& error);

}  // namespace verlet_cable
