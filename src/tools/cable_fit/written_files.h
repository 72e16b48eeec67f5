#pragma once

#include <string>
#include <vector>

namespace verlet_cable::cable_fit {

/// Adds a line to `errors` where the file of an option, if it is given, cannot be written, or is one of some others.
void check_output(const char* option, const std::string& path, const std::vector<std::string>& others,
                  std::vector<std::string>& errors);

/// Says on standard error what could not be written; false if there was anything. Entries may be empty.
bool report_failures(const std::vector<std::string>& failures);

/// A line that names the files that were written: those that are not empty, and not standard output. Empty if there is none.
/// `next`: what goes on that line behind them.
std::string written_text(const std::vector<const std::string*>& paths, const std::string& next = "");

}  // namespace verlet_cable::cable_fit
