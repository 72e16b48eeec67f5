#include <algorithm>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "common/command_line.h"
#include "common/program.h"
#include "rows.h"
#include "verlet_cable/core/quoted_text.h"

namespace {

struct NamedRow {
  const char* name;
  std::function<void(verlet_cable::bench::Report&, bool)> run;
};

}  // namespace

int main(int argc, char** argv) {
  using namespace verlet_cable::bench;
  const std::vector<NamedRow> rows{{"step", step_cost},
                                   {"precision", work_precision},
                                   {"cantilever", cantilever},
                                   {"contact", contact},
                                   {"many", many},
                                   {"net", net},
                                   {"harness", harness},
                                   {"python", python},
                                   {"driven", driven_against_bullet},
                                   {"bullet", released_against_bullet},
                                   {"simbody", released_against_simbody}};
  bool quick = false;
  verlet_cable::tools::CommandLine line("usage: verlet_cable_bench [TABLE...] [--quick]", "");
  line.add_flag("--quick", "fewer and shorter runs", quick);
  std::vector<std::string> errors;
  const std::vector<std::string> wanted = line.parse({argv + 1, argv + argc}, errors);
  std::cout << line.help();
  if (!line.help().empty()) return verlet_cable::tools::exit_done;
  std::string names;
  for (const NamedRow& row : rows) names += std::string(names.empty() ? "" : ", ") + row.name;
  for (const std::string& name : wanted)
    if (std::none_of(rows.begin(), rows.end(), [&](const NamedRow& row) { return name == row.name; }))
      errors.push_back(verlet_cable::in_quotes(name) + ": no such table; allowed: " + names);
  if (!errors.empty()) return verlet_cable::tools::refuse("verlet_cable_bench", errors, "nothing was measured");
  Report report;
  for (const NamedRow& row : rows) {
    if (wanted.empty() || std::count(wanted.begin(), wanted.end(), row.name) > 0) row.run(report, quick);
  }
  report.summary();
  return 0;
}
