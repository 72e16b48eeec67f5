#pragma once

#include "report.h"

namespace verlet_cable::bench {

/// Each prints a table. `quick`: fewer sizes and a shorter search.
void step_cost(Report& report, bool quick);
void work_precision(Report& report, bool quick);
void released_against_bullet(Report& report, bool quick);
void released_against_simbody(Report& report, bool quick);
void driven_against_bullet(Report& report, bool quick);
void cantilever(Report& report, bool quick);
void contact(Report& report, bool quick);
void many(Report& report, bool quick);
void net(Report& report, bool quick);
void harness(Report& report, bool quick);
void python(Report& report, bool quick);

}  // namespace verlet_cable::bench
