#include "named_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <system_error>

namespace verlet_cable {
namespace {

namespace fs = std::filesystem;

constexpr int most_links = 40;

int descriptor_of(const fs::path& directory, const std::string& name) {
  if (directory != "/proc/" + std::to_string(getpid()) + "/fd") return -1;
  int descriptor = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), descriptor);
  return error == std::errc() && end == name.data() + name.size() ? descriptor : -1;
}

}  // namespace

NamedFile named_file(const std::string& path) {
  fs::path next = path;
  for (int links = 0; links < most_links; ++links) {
    const std::string name = next.filename().string();
    if (name.empty() || name == "." || name == "..") return {next.string(), -1, std::generic_category().message(EISDIR)};
    std::error_code error;
    const fs::path directory = fs::canonical(directory_of(next.string()), error);
    if (error) return {next.string(), -1, error.message()};
    const int descriptor = descriptor_of(directory, name);
    next = directory / name;
    if (descriptor >= 0) return {next.string(), descriptor, ""};
    const fs::path link = fs::read_symlink(next, error);
    if (error) return {next.string(), -1, ""};
    next = directory / link;
  }
  return {path, -1, std::generic_category().message(ELOOP)};
}

std::string why_not_readable(const std::string& path) {
  const NamedFile file = named_file(path);
  if (!file.problem.empty() || file.descriptor >= 0) return "";
  struct stat status {};
  return stat(file.path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode) ? "it is a named pipe" : "";
}

std::string directory_of(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  return slash == std::string::npos ? "./" : path.substr(0, slash + 1);
}

}  // namespace verlet_cable
