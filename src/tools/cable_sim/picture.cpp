#include "picture.h"

#include <sys/stat.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <vector>

#include "cable_sim/plot_text.h"
#include "common/messages.h"
#include "scene/child_process.h"

namespace verlet_cable::cable_sim {
namespace {

constexpr auto patience = std::chrono::minutes(10);  // for drawing, on a busy machine, too

/// The programs of that name, in the order of PATH, then that of the system.
std::vector<std::string> paths_of(const std::string& name) {
  std::vector<std::string> paths;
  const char* listed = std::getenv("PATH");
  std::istringstream directories(std::string(listed ? listed : "") + ":/usr/bin");
  for (std::string directory; std::getline(directories, directory, ':');) {
    const std::string path = directory + "/" + name;
    if (!directory.empty() && access(path.c_str(), X_OK) == 0) paths.push_back(path);
  }
  return paths;
}

/// A file without a name, with a text in it, to be read from its start. Throws ResourceError.
FileDescriptor file_with(const std::string& text) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() || std::fflush(file.get()) != 0)
    throw ResourceError("no temporary file can be written: " + tools::error_text(errno));
  std::rewind(file.get());
  return FileDescriptor(dup(fileno(file.get())));
}

Painter::Picture run(const std::string& python, const std::string& kind, const std::string& record) {
  try {
    ChildProcess process(python, {"-c", plot_text, kind}, file_with(record));
    const Patience limit{std::chrono::steady_clock::now() + patience};
    std::string output;
    std::array<char, 65536> part{};
    for (std::size_t count = part.size(); count == part.size();) {
      count = process.read(part.data(), part.size(), limit);
      output.append(part.data(), count);
    }
    const int status = process.wait();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {output, ""};
    return {"", output.empty() ? "it ended early" : escaped(output)};
  } catch (const ResourceError& error) {
    return {"", error.what()};
  }
}

}  // namespace

Painter::Painter(bool needs_mp4) {
  const std::vector<std::string> candidates = paths_of("python3");
  for (const std::string& path : candidates) {
    const std::string why = run(path, "check", "").problem;
    if (why.empty()) {
      python_ = path;
      problem_.clear();
      if (needs_mp4) movie_problem_ = run(path, "check_mp4", "").problem;
      if (!movie_problem_.empty())
        movie_problem_ += "; allowed: a name that ends in .gif, or a PATH that has ffmpeg (Debian: sudo apt-get install ffmpeg)";
      return;
    }
    problem_ += (problem_.empty() ? "" : "; ") + tools::path_text(path) + ": " + why;
  }
  problem_ = (candidates.empty() ? "there is no python3" : problem_) +
             "; allowed: a python3 that has matplotlib and Pillow (Debian: sudo apt-get install python3-matplotlib)";
}

Painter::Picture Painter::draw(const std::string& kind, const std::string& record) const {
  return run(python_, kind, record);
}

}  // namespace verlet_cable::cable_sim
