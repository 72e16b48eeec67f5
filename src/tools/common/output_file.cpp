#include "output_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <optional>
#include <utility>

#include "messages.h"
#include "scene/named_file.h"

namespace verlet_cable::tools {
namespace {

constexpr mode_t permissions = 07777;
constexpr mode_t everyone = 0666;
/// [characters] of the name in a .part's: names have at most 255.
constexpr std::size_t longest_name = 200;

/// Paths of what is not finished: what a signal handler can read.
std::array<std::atomic<const char*>, 16> unfinished{};

int remember_unfinished(const char* path) {
  for (std::size_t slot = 0; slot < unfinished.size(); ++slot) {
    const char* none = nullptr;
    if (unfinished[slot].compare_exchange_strong(none, path)) return static_cast<int>(slot);
  }
  return -1;
}

std::string why_not_written(const struct stat& status) {
  if (S_ISDIR(status.st_mode)) return error_text(EISDIR);
  if (S_ISFIFO(status.st_mode)) return "it is a named pipe";
  if (S_ISSOCK(status.st_mode)) return "it is a socket";
  return S_ISBLK(status.st_mode) ? "it is a disk" : "";
}

std::string why_no_access(const std::string& path, int mode) {
  return access(path.c_str(), mode) == 0 ? "" : error_text(errno);
}

std::string why_not_writable(const NamedFile& file) {
  if (!file.problem.empty()) return file.problem;
  if (file.descriptor >= 0) {
    const int flags = fcntl(file.descriptor, F_GETFL);
    return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY ? "" : error_text(EBADF);
  }
  struct stat status {};
  if (stat(file.path.c_str(), &status) == 0) {
    const std::string problem = why_not_written(status);
    if (!problem.empty()) return problem;
    const std::string refused = why_no_access(file.path, W_OK);
    if (!refused.empty() || !S_ISREG(status.st_mode)) return refused;
  } else if (errno != ENOENT) {
    return error_text(errno);
  }
  const std::string refused = why_no_access(directory_of(file.path), W_OK | X_OK);
  return refused.empty() ? "" : "no file can be made in its directory: " + refused;
}

/// A file without a name, which the system removes with the process that has it open; -1 where there is no such thing, or no way
/// to name it later.
int open_nameless(const std::string& directory) {
  if (access("/proc/self/fd", X_OK) != 0) return -1;
  return open(directory.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, everyone);
}

std::optional<struct stat> status_of(const NamedFile& file) {
  struct stat status {};
  const int failed = file.descriptor >= 0 ? fstat(file.descriptor, &status) : stat(file.path.c_str(), &status);
  return failed ? std::nullopt : std::optional(status);
}

}  // namespace

std::string why_not_writable(const std::string& path) {
  return why_not_writable(named_file(path));
}

std::string cannot_write(const std::string& path, const std::string& why) {
  return "cannot write " + quoted_path(path) + ": " + why + "; allowed: a file in a directory that can be written, or a device";
}

bool is_same_file(const std::string& a, const std::string& b) {
  const NamedFile file_a = named_file(a), file_b = named_file(b);
  if (!file_a.problem.empty() || !file_b.problem.empty()) return false;
  if (file_a.descriptor >= 0 && file_a.descriptor == file_b.descriptor) return true;
  const auto status_a = status_of(file_a), status_b = status_of(file_b);
  if (status_a && status_b)
    return status_a->st_dev == status_b->st_dev && status_a->st_ino == status_b->st_ino && !S_ISCHR(status_a->st_mode);
  return !status_a && !status_b && file_a.path == file_b.path;
}

bool is_standard_output(const std::string& path) {
  return !path.empty() && named_file(path).descriptor == STDOUT_FILENO;
}

std::string OutputFile::open(const std::string& path) {
  const NamedFile file = named_file(path);
  const std::string problem = why_not_writable(file);
  if (!problem.empty()) return problem;
  struct stat status {};
  if (file.descriptor >= 0) {
    descriptor_ = fcntl(file.descriptor, F_DUPFD_CLOEXEC, 0);
  } else if (stat(file.path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    descriptor_ = ::open(file.path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  } else {
    return open_aside(file.path);
  }
  return descriptor_ >= 0 ? "" : error_text(errno);
}

std::string OutputFile::open_aside(const std::string& target) {
  target_ = target;
  descriptor_ = open_nameless(directory_of(target));
  if (descriptor_ < 0)
    descriptor_ = make_part([](const char* part) { return ::open(part, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, everyone); });
  if (descriptor_ < 0) return error_text(errno);
  struct stat status {};
  if (stat(target.c_str(), &status) != 0) return "";
  // Only root may give a file away; others keep what they make.
  const bool is_given = fchown(descriptor_, status.st_uid, status.st_gid) == 0;
  if (fchmod(descriptor_, status.st_mode & (is_given ? permissions : everyone)) != 0) error_ = errno;
  return "";
}

/// Names what is written aside. `make` makes a file of that name, which nothing has yet; -1 and errno where it cannot.
int OutputFile::make_part(const std::function<int(const char*)>& make) {
  const std::string name = target_.substr(target_.find_last_of('/') + 1);
  const std::string start = directory_of(target_) + name.substr(0, longest_name) + '.' + std::to_string(getpid()) + '-';
  // What an earlier run of the same number has left is in nobody's way.
  for (int i = 0;; ++i) {
    part_ = start + std::to_string(i) + ".part";
    const int made = make(part_.c_str());
    if (made < 0 && errno == EEXIST) continue;
    if (made < 0)
      part_.clear();
    else
      slot_ = remember_unfinished(part_.c_str());
    return made;
  }
}

void OutputFile::write(const char* text, std::size_t size) {
  while (size > 0 && error_ == 0) {
    const ssize_t written = ::write(descriptor_, text, size);
    if (written >= 0) {
      text += written;
      size -= static_cast<std::size_t>(written);
      written_ += static_cast<std::size_t>(written);
    } else if (errno == EAGAIN) {
      pollfd ready{descriptor_, POLLOUT, 0};
      poll(&ready, 1, -1);
    } else if (errno != EINTR) {
      error_ = errno;
    }
  }
}

void OutputFile::reserve(std::size_t size) {
  if (is_direct() || fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, 0, static_cast<off_t>(size)) != 0) return;
  is_reserved_ = true;
}

std::string OutputFile::keep_first(std::size_t size) {
  const bool is_full = error_ == ENOSPC || error_ == EFBIG || error_ == EDQUOT;
  if (!is_full || is_direct() || size > written_ || ftruncate(descriptor_, static_cast<off_t>(size)) != 0) return "";
  written_ = size;
  return error_text(std::exchange(error_, 0));
}

std::string OutputFile::finish() {
  // To its own size: that gives back the room behind it.
  if (error_ == 0 && is_reserved_ && ftruncate(descriptor_, static_cast<off_t>(written_)) != 0) error_ = errno;
  // Some file systems find out only then that there is no room.
  if (error_ == 0 && !is_direct() && fsync(descriptor_) != 0 && errno != EINVAL) error_ = errno;
  if (error_ == 0 && !is_direct() && part_.empty()) {
    const std::string nameless = "/proc/self/fd/" + std::to_string(descriptor_);
    const auto link = [&](const char* part) { return linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, part, AT_SYMLINK_FOLLOW); };
    if (make_part(link) < 0) error_ = errno;
  }
  close();
  if (error_ != 0 || is_direct()) {
    discard();
    return error_ != 0 ? error_text(error_) : "";
  }
  if (slot_ >= 0) unfinished[static_cast<std::size_t>(slot_)] = nullptr;
  slot_ = -1;
  const std::string whole = std::exchange(part_, "");
  if (rename(whole.c_str(), target_.c_str()) == 0) return "";
  error_ = errno;
  const bool is_left = access(whole.c_str(), F_OK) == 0;
  return error_text(error_) + (is_left ? "; all of it is in " + quoted_path(whole) : "");
}

void OutputFile::close() {
  if (descriptor_ < 0) return;
  // Linux closes also where a signal comes between.
  if (::close(descriptor_) != 0 && errno != EINTR && error_ == 0) error_ = errno;
  descriptor_ = -1;
}

void OutputFile::discard() {
  close();
  if (slot_ >= 0) unfinished[static_cast<std::size_t>(slot_)] = nullptr;
  slot_ = -1;
  if (!part_.empty()) unlink(part_.c_str());
  part_.clear();
}

std::string write_file(const std::string& path, const std::string& text) {
  OutputFile file;
  std::string problem = file.open(path);
  if (problem.empty()) {
    file.write(text.data(), text.size());
    problem = file.finish();
  }
  return problem.empty() ? "" : "cannot write " + quoted_path(path) + ": " + problem;
}

void remove_unfinished_files() {
  for (const std::atomic<const char*>& path : unfinished) {
    if (const char* part = path) unlink(part);
  }
}

}  // namespace verlet_cable::tools
