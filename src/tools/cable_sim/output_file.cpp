#include "output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

namespace verlet_cable::cable_sim {
namespace {

std::string message_of(int error) {
  return std::generic_category().message(error);
}

std::string directory_of(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  return slash == std::string::npos ? "." : path.substr(0, slash + 1);
}

}  // namespace

std::string why_not_writable(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) return message_of(EISDIR);
    return access(path.c_str(), W_OK) == 0 ? "" : message_of(errno);
  }
  if (errno != ENOENT) return message_of(errno);
  if (path.back() == '/') return message_of(EISDIR);
  return access(directory_of(path).c_str(), W_OK | X_OK) == 0 ? "" : message_of(errno);
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (std::filesystem::exists(a, error) && !std::filesystem::is_regular_file(a, error)) return false;
  if (std::filesystem::equivalent(a, b, error)) return true;
  const auto path_a = std::filesystem::weakly_canonical(a, error);
  return !error && path_a == std::filesystem::weakly_canonical(b, error) && !error;
}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  if (is_new_ && !started_) unlink(path_.c_str());
}

std::string OutputFile::open(const std::string& path) {
  path_ = path;
  constexpr mode_t everyone = 0666;
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, everyone);
  is_new_ = descriptor_ >= 0;
  if (!is_new_) descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, everyone);
  return descriptor_ >= 0 ? "" : message_of(errno);
}

void OutputFile::start() {
  started_ = true;
  // Devices and pipes cannot be emptied, and need not be.
  if (ftruncate(descriptor_, 0) != 0 && errno != EINVAL) error_ = errno;
}

void OutputFile::write(const char* text, std::size_t size) {
  while (size > 0 && error_ == 0) {
    const ssize_t written = ::write(descriptor_, text, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      error_ = errno;
      return;
    }
    text += written;
    size -= static_cast<std::size_t>(written);
  }
}

std::string OutputFile::close() {
  if (::close(descriptor_) != 0 && error_ == 0) error_ = errno;
  descriptor_ = -1;
  return error_ == 0 ? "" : message_of(error_);
}

}  // namespace verlet_cable::cable_sim
