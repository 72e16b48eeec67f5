#include "written_files.h"

#include <iostream>

#include "common/messages.h"
#include "common/output_file.h"

namespace verlet_cable::cable_fit {

void check_output(const char* option, const std::string& path, const std::vector<std::string>& others,
                  std::vector<std::string>& errors) {
  if (path.empty()) return;
  const std::string problem = tools::why_not_writable(path);
  if (!problem.empty()) errors.push_back(std::string(option) + ": " + tools::cannot_write(path, problem));
  for (const std::string& other : others)
    if (!other.empty() && tools::is_same_file(path, other))
      errors.push_back(std::string(option) + ": " + in_quotes(path) + " is " + in_quotes(other) + "; allowed: another file");
}

bool report_failures(const std::vector<std::string>& failures) {
  bool good = true;
  for (const std::string& failure : failures) {
    if (failure.empty()) continue;
    std::cerr << "cable_fit: stopped: " << failure << "\n";
    good = false;
  }
  return good;
}

std::string written_text(const std::vector<const std::string*>& paths, const std::string& next) {
  std::string files;
  for (const std::string* path : paths)
    if (!path->empty() && !tools::is_standard_output(*path)) files += (files.empty() ? "" : ", ") + tools::path_text(*path);
  return files.empty() ? "" : "written: " + files + next + "\n";
}

}  // namespace verlet_cable::cable_fit
