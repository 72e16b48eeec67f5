#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {

constexpr std::size_t longest_message = 300;  ///< of another library, in one of ours

/// The number that a text is: decimal, with or without exponent, or [+-][.]inf[inity] in any case. None for NaN, hexadecimal and
/// numbers that a double cannot hold. Does not depend on the locale.
std::optional<double> parse_number(const std::string& text);

/// How many characters have to be put in, left out or replaced to get from one text to the other (Levenshtein); 64 for long
/// texts.
std::size_t spelling_distance(const std::string& a, const std::string& b);

/// The one of `known` that is spelled most alike, empty if none is near.
template <class Names>
std::string nearest_name(const std::string& name, const Names& known) {
  std::string nearest;
  std::size_t least = 2 + name.size() / 3;
  for (const std::string& candidate : known) {
    const std::size_t distance = spelling_distance(name, candidate);
    if (distance >= least) continue;
    nearest = candidate;
    least = distance;
  }
  return nearest;
}

}  // namespace verlet_cable
