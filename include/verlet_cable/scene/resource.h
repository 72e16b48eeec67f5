#pragma once

#include <optional>
#include <stdexcept>
#include <string>

namespace verlet_cable {

/// Why a file that something names cannot be used: what is wrong with it, without its name.
class ResourceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Which files may be read besides those of packages.
struct FileAccess {
  bool anywhere = true;   ///< any file; else only what is inside of `directory`, nothing if that is empty
  std::string directory;  ///< relative paths start here
};

/// The directory of a package, by its package.xml below ROS_PACKAGE_PATH or where distributions install packages; none if it is
/// not found. Asks no ROS master.
std::optional<std::string> find_package(const std::string& name);

/// The file that a URI means: `package://PACKAGE/PATH` inside of the package, `file:///PATH`, or a relative path without a scheme. It
/// is a regular file. Throws ResourceError.
std::string file_of(const std::string& uri, const FileAccess& access);

/// The content of a file, at most 64 MB. Throws ResourceError.
std::string read_file(const std::string& path);

/// What `file_of` takes, for messages.
constexpr const char* uri_words = "package://PACKAGE/PATH or file:///PATH";

}  // namespace verlet_cable
