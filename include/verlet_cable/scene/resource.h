#pragma once

#include <optional>
#include <stdexcept>
#include <string>

namespace verlet_cable {

/// Why a file cannot be used. The message does not contain its name.
class ResourceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Which files may be read, in addition to those of packages.
struct FileAccess {
  bool anywhere = true;   ///< any file; else only files inside `directory`, or none if that is empty
  std::string directory;  ///< to which relative paths refer
};

/// The directory of a package, found by its package.xml below ROS_PACKAGE_PATH or where distributions install packages; none if
/// it is not found. Does not need a ROS master.
std::optional<std::string> find_package(const std::string& name);

/// The path of the file that a URI names: `package://PACKAGE/PATH` inside the package, `file:///PATH`, or a relative path without
/// a scheme. Throws ResourceError, also if it is not a regular file.
std::string file_of(const std::string& uri, const FileAccess& access);

/// The content of a file, at most 64 MB. Throws ResourceError.
std::string read_file(const std::string& path);

/// What `file_of` accepts, for messages.
constexpr const char* uri_words = "package://PACKAGE/PATH or file:///PATH";

}  // namespace verlet_cable
