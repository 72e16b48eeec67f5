#pragma once

#include <string>

namespace verlet_cable {

/// What a path leads to.
struct NamedFile {
  std::string path;     ///< links followed, also those to what is not there yet
  int descriptor = -1;  ///< of a stream that is open already (/dev/stdout, /dev/fd/N), else -1
  std::string problem;  ///< why it leads nowhere, empty if it does
};

NamedFile named_file(const std::string& path);

/// Why a file is not to be read, for what would hang: a named pipe. Empty for all others, also where there is nothing.
std::string why_not_readable(const std::string& path);

/// With its slash; "./" if none is named.
std::string directory_of(const std::string& path);

}  // namespace verlet_cable
