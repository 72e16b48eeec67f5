#pragma once

#include <cstddef>
#include <string>

namespace verlet_cable::cable_sim {

/// Why a file cannot be written, as far as can be said without touching it; empty if it seems that it can.
std::string why_not_writable(const std::string& path);
/// Whether two paths name one file, which may not be there yet. Devices and pipes are never the same.
bool is_same_file(const std::string& a, const std::string& b);

/// A file that is written to its end, or left as it was.
class OutputFile {
 public:
  OutputFile() = default;
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Opens the file; what is in it stays until `start`. Returns why it cannot be opened, empty if it was.
  std::string open(const std::string& path);
  /// Empties the file. Without this, a file that `open` made is removed again.
  void start();
  void write(const char* text, std::size_t size);
  /// Closes the file. Returns what went wrong since `open`, empty if all is written.
  std::string close();

 private:
  std::string path_;
  int descriptor_ = -1;
  bool is_new_ = false;
  bool started_ = false;
  int error_ = 0;  ///< the first one
};

}  // namespace verlet_cable::cable_sim
