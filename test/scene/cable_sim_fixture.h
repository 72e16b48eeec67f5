#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "verlet_cable/core/types.h"
#include "yaml-cpp/yaml.h"

namespace verlet_cable {

/// All of a file.
inline std::string content(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// One row of the output.
struct Row {
  double time;
  std::string cable;
  int node;
  Vector3 position;
  Vector3 velocity;
  double tension;
};

/// Runs the program in a directory of its own.
class CableSim : public testing::Test {
 protected:
  CableSim() {
    std::string pattern = testing::TempDir() + "cable_sim_XXXXXX";
    directory_ = std::string(mkdtemp(pattern.data())) + "/";
  }
  ~CableSim() override { EXPECT_EQ(std::system(("rm -r " + directory_).c_str()), 0); }

  std::string path(const std::string& name) const { return directory_ + name; }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  bool exists(const std::string& name) const { return access(path(name).c_str(), F_OK) == 0; }

  /// All that is in the directory, sorted.
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(directory_)) found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }
  /// Those of files that are written aside.
  std::vector<std::string> parts() const {
    std::vector<std::string> found = names();
    found.erase(std::remove_if(found.begin(), found.end(),
                               [](const std::string& name) { return name.find(".part") == std::string::npos; }),
                found.end());
    return found;
  }
  /// Paths by which what a process has open in the directory can be reached, with or without a name.
  std::vector<std::string> open_files(pid_t process) const {
    std::vector<std::string> found;
    std::error_code gone;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/fd", gone))
      if (std::filesystem::read_symlink(entry.path(), gone).string().rfind(directory_, 0) == 0) found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Exit status of the program; what it printed is in `out` and `err`. `before`: commands of the same shell.
  int run(const std::string& arguments, const std::string& before = "") {
    return run_program(CABLE_SIM_PROGRAM, arguments, before);
  }
  int run_program(const std::string& program, const std::string& arguments, const std::string& before) {
    const std::string command = before + program + " " + arguments + " > " + path("out") + " 2> " + path("err");
    const int status = std::system(command.c_str());
    out = content(path("out"));
    err = content(path("err"));
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  std::vector<Row> rows(const std::string& name) const {
    std::istringstream file(content(path(name)));
    std::string line;
    std::getline(file, line);
    EXPECT_EQ(line, "t,cable,node,x,y,z,vx,vy,vz,tension");
    std::vector<Row> result;
    while (std::getline(file, line)) {
      std::vector<std::string> cells;
      std::istringstream stream(line);
      for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
      EXPECT_EQ(cells.size(), 10u) << line;
      std::array<double, 10> n{};
      for (std::size_t i = 0; i < cells.size(); ++i) n[i] = std::strtod(cells[i].c_str(), nullptr);
      result.push_back({n[0], cells[1], static_cast<int>(n[2]), {n[3], n[4], n[5]}, {n[6], n[7], n[8]}, n[9]});
    }
    return result;
  }

  YAML::Node summary(const std::string& name) const { return YAML::Load(content(path(name))); }

  std::string out;
  std::string err;

 private:
  std::string directory_;
};

}  // namespace verlet_cable
