#include "duration_text.h"

#include <cstdio>

#include "verlet_cable/core/number_text.h"

namespace verlet_cable::tools {
namespace {

constexpr double seconds_a_minute = 60, seconds_an_hour = 3600;

struct Unit {
  const char* name;
  double seconds;
};

/// Two minutes are minutes, one is seconds; `hours`: from which on they are.
Unit unit_of(double seconds, double hours) {
  if (seconds >= hours * seconds_an_hour) return {"h", seconds_an_hour};
  return seconds >= 2 * seconds_a_minute ? Unit{"min", seconds_a_minute} : Unit{"s", 1};
}

/// Whole ones, but of a few a tenth counts, too.
std::string rounded(double number, double largest) {
  constexpr double few = 10;
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", largest < few ? 1 : 0, number);
  return text;
}

}  // namespace

std::string progress_text(double done, double amount) {
  constexpr double hours = 48;  // hours would stand still for long
  const Unit unit = unit_of(amount, hours);
  return rounded(done / unit.seconds, amount / unit.seconds) + " of " + rounded_text(amount / unit.seconds) + " " + unit.name;
}

std::string duration_text(double seconds) {
  const Unit unit = unit_of(seconds, 2);
  return rounded(seconds / unit.seconds, seconds / unit.seconds) + " " + unit.name;
}

}  // namespace verlet_cable::tools
