#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace verlet_cable::tools {

/// Why a file cannot be written, as far as can be said without touching it; empty if it seems that it can. Named pipes, sockets
/// and disks are refused.
std::string why_not_writable(const std::string& path);
/// An error for `why_not_writable`'s answer: with the path, and what is allowed.
std::string cannot_write(const std::string& path, const std::string& why);
/// Whether two paths name one file, which may not be there yet; also the same open stream. Devices are never the same.
bool is_same_file(const std::string& a, const std::string& b);
/// Whether a path names this program's standard output.
bool is_standard_output(const std::string& path);

/// A file that is there when it is whole, and else as it was: written aside, and renamed. Until it is whole it has no name, so
/// that nothing is left of it whatever ends the program; on file systems that do not know such files it is NAME.PID-N.part beside
/// it. Links are followed and stay; permissions stay. Devices, and streams that are open already (/dev/stdout, /dev/fd/N), are
/// written directly.
class OutputFile {
 public:
  OutputFile() = default;
  /// What is not finished is removed.
  ~OutputFile() { discard(); }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Returns why the file cannot be written, empty if it is open.
  std::string open(const std::string& path);
  /// Does nothing after an error.
  void write(const char* text, std::size_t size);
  bool has_failed() const { return error_ != 0; }
  /// [byte] in the file so far.
  std::size_t written() const { return written_; }
  /// Takes room on the disk for so many bytes, if it can.
  void reserve(std::size_t size);
  /// Where the disk became full, keeps the first `size` bytes for `finish` to put in their place. Returns what the error was;
  /// empty if there was none or nothing can be kept.
  std::string keep_first(std::size_t size);
  bool is_open() const { return descriptor_ >= 0; }
  /// Whether it is written directly, so that others may read it already.
  bool is_direct() const { return target_.empty(); }
  /// Puts the whole file in its place. Returns what went wrong since `open`, empty if nothing: nothing is left of it then, but
  /// for a whole file that is there and could not be renamed, which is named.
  std::string finish();

 private:
  std::string open_aside(const std::string& target);
  int make_part(const std::function<int(const char*)>& make);
  void close();
  void discard();

  std::string target_;  ///< links followed; empty: written directly
  std::string part_;    ///< name of what is written aside; empty: it has none
  int descriptor_ = -1;
  std::size_t written_ = 0;
  bool is_reserved_ = false;
  int error_ = 0;  ///< the first one
  int slot_ = -1;  ///< in the list of what is to be removed when the program ends early
};

/// Writes all of a file. Returns why not, with its name; empty if it was written.
std::string write_file(const std::string& path, const std::string& text);

/// Removes what is not finished. For signal handlers, too.
void remove_unfinished_files();

}  // namespace verlet_cable::tools
