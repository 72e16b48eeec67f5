#include "yaml_hint.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

constexpr const char* blanks = " \t\r";

/// A line of a text, and its number from 1.
struct Line {
  int number = 0;
  std::string text;

  std::size_t indentation() const { return std::min(text.find_first_not_of(blanks), text.size()); }
  bool has_content() const { return indentation() < text.size() && text[indentation()] != '#'; }
  std::string name() const { return "line " + std::to_string(number); }
};

/// The last two lines up to one with content, the later first.
std::vector<Line> lines_up_to(const std::string& text, int last) {
  std::vector<Line> lines;
  std::size_t begin = 0;
  for (int number = 1; number <= last && begin <= text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    Line line{number, text.substr(begin, end - begin)};
    begin = end + 1;
    if (line.has_content()) lines.insert(lines.begin(), std::move(line));
    if (lines.size() > 2) lines.pop_back();
  }
  return lines;
}

/// A place where a value may begin, behind the dashes of lists.
std::size_t first_key(const std::string& line) {
  std::size_t at = std::min(line.find_first_not_of(blanks), line.size());
  while (at + 1 < line.size() && line[at] == '-' && line[at + 1] == ' ')
    at = std::min(line.find_first_not_of(blanks, at + 1), line.size());
  return at;
}

std::size_t end_of_word(const std::string& line, std::size_t begin) {
  const auto is_word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  const auto first = line.begin() + static_cast<std::ptrdiff_t>(begin);
  return static_cast<std::size_t>(std::find_if_not(first, line.end(), is_word) - line.begin());
}

std::string missing_space(const Line& line) {
  std::size_t at = first_key(line.text);
  if (at + 1 < line.text.size() && line.text[at] == '-' && end_of_word(line.text, at + 1) > at + 1)
    return line.name() + ": a space is missing after the dash";
  const std::size_t end = end_of_word(line.text, at);
  if (end == at || end + 1 >= line.text.size() || line.text[end] != ':') return "";
  const bool is_spaced = std::string(blanks).find(line.text[end + 1]) != std::string::npos;
  return is_spaced ? "" : line.name() + ": a space is missing after " + in_quotes(line.text.substr(at, end + 1 - at));
}

/// What is wrong in a map or list of which `lines` are the last two, the later first.
std::string structure_hint(const std::vector<Line>& lines) {
  for (const Line& line : lines) {
    if (line.text.substr(0, line.indentation()).find('\t') != std::string::npos)
      return line.name() + " begins with a tab; allowed: spaces";
    if (const std::string hint = missing_space(line); !hint.empty()) return hint;
  }
  if (lines.empty()) return "";
  const Line& line = lines.front();
  const std::size_t at = first_key(line.text), colon = line.text.find(": ", at);
  if (colon != std::string::npos && line.text.find_first_of("\"'[{", colon) == std::string::npos &&
      line.text.find(": ", colon + 1) != std::string::npos)
    return line.name() + ": a value that contains \": \" needs quotes";
  if (lines.size() < 2) return "";
  const Line& before = lines.back();
  if (before.text.find(':') == std::string::npos && first_key(before.text) == before.indentation())
    return before.name() + ": a colon is missing after " + in_quotes(before.text.substr(before.indentation()));
  if (at != first_key(before.text))
    return line.name() + " is indented by " + std::to_string(at) + ", " + before.name() + " by " +
           std::to_string(first_key(before.text)) + "; the keys of a map begin in the same column";
  return "";
}

/// Where a bracket was opened.
struct Bracket {
  char sign;
  int line;
};

/// The innermost bracket that is open at a place.
std::optional<Bracket> open_bracket(const std::string& text, const YAML::Mark& end) {
  std::vector<Bracket> open;
  char quote = 0;
  bool begins = true;  // a value may begin here
  int line = 0, column = 0;
  for (std::size_t i = 0; i < text.size() && (line < end.line || (line == end.line && column < end.column)); ++i, ++column) {
    const char c = text[i];
    if (c == '\n') {
      ++line;
      column = -1;
      begins = true;
    } else if (quote != 0) {
      if (c == '\\' && quote == '"') {
        ++i;
        ++column;
      } else if (c == quote) {
        quote = 0;
      }
    } else if (begins && (c == '"' || c == '\'')) {
      quote = c;
      begins = false;
    } else if (c == '#' && (i == 0 || std::string(" \t\n").find(text[i - 1]) != std::string::npos)) {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if ((c == '[' || c == '{') && (begins || !open.empty())) {
      open.push_back({c, line + 1});
      begins = true;
    } else if ((c == ']' || c == '}') && !open.empty()) {
      open.pop_back();
      begins = false;
    } else if (c == ':' || (c == ',' && !open.empty())) {
      begins = true;
    } else if (std::string(blanks).find(c) == std::string::npos && !(c == '-' && begins)) {
      begins = false;
    }
  }
  return open.empty() ? std::nullopt : std::make_optional(open.back());
}

std::string bracket_hint(const std::string& text, const YAML::Mark& place) {
  const std::optional<Bracket> bracket = open_bracket(text, place);
  if (!bracket) return "";
  return std::string("a comma or \"") + (bracket->sign == '[' ? ']' : '}') + "\" is missing before it, for the \"" +
         bracket->sign + "\" in line " + std::to_string(bracket->line);
}

}  // namespace

std::string yaml_hint(const std::string& text, const YAML::Exception& error) {
  namespace message = YAML::ErrorMsg;
  if (error.mark.is_null()) return "";
  const auto is_any_of = [&](std::initializer_list<const char*> messages) {
    return std::find(messages.begin(), messages.end(), error.msg) != messages.end();
  };
  if (is_any_of({message::END_OF_MAP_FLOW, message::END_OF_SEQ_FLOW, message::FLOW_END})) return bracket_hint(text, error.mark);
  if (is_any_of({message::UNKNOWN_TOKEN, message::UNKNOWN_ANCHOR})) return "text that begins with one of @ ` % * & needs quotes";
  if (is_any_of({message::MAP_VALUE, message::END_OF_MAP, message::END_OF_SEQ, message::TAB_IN_INDENTATION}))
    return structure_hint(lines_up_to(text, error.mark.line + 1));
  return "";
}

}  // namespace verlet_cable
