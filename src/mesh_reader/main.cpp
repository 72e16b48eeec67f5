// mesh_reader FORMAT: a mesh file on standard input becomes plain vertices and triangles on standard output, see
// scene/mesh_protocol.h. Started by the library, for each file.

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "file_checks.h"
#include "import.h"
#include "scene/mesh_protocol.h"

namespace {

using namespace verlet_cable;
using mesh_reader::Refused;

constexpr int lowest_priority = 19;

void write_all(const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(STDOUT_FILENO, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) std::_Exit(1);
    at += written;
    size -= static_cast<std::size_t>(written);
  }
}

template <class Element>
void write_all(const std::vector<Element>& elements) {
  write_all(elements.data(), elements.size() * sizeof(Element));
}

/// Allocates nothing.
[[noreturn]] void refuse_for_memory() {
  static_assert(mesh_protocol::memory == std::size_t{1} << 30);
  const char text[] = "Eit takes more than 1 GB of memory to read";
  write_all(text, sizeof text - 1);
  std::_Exit(1);
}

/// What the process that started this one had open.
void close_other_files() {
  std::vector<int> files;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd"))
    files.push_back(std::stoi(entry.path().filename()));
  for (const int file : files)
    if (file > STDERR_FILENO) close(file);
}

void set_limit(int resource, rlim_t limit) {
  const rlimit both{limit, limit};
  // A lower limit that is in force already is as good.
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

void give_up_rights() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  setpriority(PRIO_PROCESS, 0, lowest_priority);  // a node's own work comes first
  close_other_files();
  set_limit(RLIMIT_NOFILE, STDERR_FILENO + 1);  // none is opened any more
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_AS, mesh_protocol::memory);
  set_limit(RLIMIT_CPU, mesh_protocol::processor_time);
}

std::string read_input() {
  std::string content;
  std::vector<char> block(std::size_t{1} << 16);
  while (true) {
    const ssize_t size = read(STDIN_FILENO, block.data(), block.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) throw Refused("it cannot be read");
    if (size == 0) return content;
    content.append(block.data(), static_cast<std::size_t>(size));
    // It may have grown since its size was asked for, and may go on growing.
    if (content.size() > mesh_protocol::largest_file) throw Refused("it is larger than 64 MB");
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string format = argc == 2 ? argv[1] : "";
  if (format != "stl" && format != "obj" && format != "dae") {
    std::cerr << "usage: mesh_reader stl|obj|dae < FILE; started by verlet_cable for each mesh that it reads\n";
    return 2;
  }
  try {
    give_up_rights();
    std::set_new_handler(refuse_for_memory);
    const std::string content = read_input();
    mesh_reader::check_file(format, content);
    const mesh_reader::Mesh mesh = mesh_reader::import(format, content);
    const mesh_protocol::Header header{mesh.vertices.size(), mesh.triangles.size()};
    write_all(&mesh_protocol::success, 1);
    write_all(&header, sizeof header);
    write_all(mesh.vertices);
    write_all(mesh.triangles);
    std::_Exit(0);  // nothing is left to tidy up
  } catch (const std::exception& error) {
    const std::string text = mesh_protocol::refusal + std::string(error.what()).substr(0, mesh_protocol::longest_refusal);
    write_all(text.data(), text.size());
  }
  return 1;
}
