#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace verlet_cable {

/// What is known of an XML text before a recursive parser sees it.
struct XmlOutline {
  std::size_t levels = 0;  ///< of nested elements
  std::size_t links = 0;   ///< elements named `link`
  /// The most of one element, counted as its `=` outside of quotes: no parser finds more.
  std::size_t attributes = 0;
  /// Elements with one of the names that were asked for, outside of each other: their first byte and that after their last.
  std::vector<std::pair<std::size_t, std::size_t>> named;
  /// Why the text is not one that all parsers take alike, with the byte where; empty if it is. The numbers are those before it.
  std::string problem;
};

XmlOutline outline_of(const std::string& xml, const std::set<std::string>& names = {});

}  // namespace verlet_cable
