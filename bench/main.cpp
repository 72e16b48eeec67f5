#include <cstring>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "rows.h"

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
                                   {"driven", driven_against_bullet},
                                   {"bullet", released_against_bullet},
                                   {"simbody", released_against_simbody}};
  bool quick = false;
  std::vector<std::string> wanted;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--quick") == 0)
      quick = true;
    else
      wanted.emplace_back(argv[i]);
  }
  Report report;
  for (const std::string& name : wanted) {
    bool known = false;
    for (const NamedRow& row : rows) known = known || name == row.name;
    if (known) continue;
    std::cerr << "unknown table '" << name << "'; allowed:";
    for (const NamedRow& row : rows) std::cerr << ' ' << row.name;
    std::cerr << " and --quick\n";
    return 2;
  }
  for (const NamedRow& row : rows) {
    bool run = wanted.empty();
    for (const std::string& name : wanted) run = run || name == row.name;
    if (run) row.run(report, quick);
  }
  report.summary();
  return 0;
}
