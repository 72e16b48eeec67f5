#include "xml_outline.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

/// Goes through the markup once. It refuses what parsers read differently (they disagree on where a stray `<` ends, and skip
/// bytes that are no UTF-8), since the levels of one parser would not be those of another.
class Scanner {
 public:
  Scanner(const std::string& xml, const std::set<std::string>& names) : xml_(xml), end_(length_of_text(xml)), names_(names) {}

  XmlOutline outline() && {
    while (outline_.problem.empty() && (at_ = xml_.find('<', at_)) < end_) {
      if (starts("<!--")) {
        skip_to("-->", "a comment without end");
      } else if (starts("<![CDATA[")) {
        skip_to("]]>", "a CDATA section without end");
      } else if (starts("<?")) {
        skip_instruction();
      } else if (starts("<!")) {
        skip_declaration();
      } else if (starts("</")) {
        skip_to(">", "an end tag without end");
        open_ -= std::min<std::size_t>(open_, 1);
        if (is_in_named_ && open_ == level_of_named_) end_named();
      } else {
        read_start_tag();
      }
    }
    if (outline_.problem.empty() && end_ < xml_.size()) fail(end_, "no text in UTF-8");
    return std::move(outline_);
  }

 private:
  bool starts(const char* with) const { return xml_.compare(at_, std::string(with).size(), with) == 0; }

  void fail(std::size_t at, const std::string& what) { outline_.problem = "byte " + std::to_string(at) + ": " + what; }

  void skip_to(const std::string& end, const char* problem) {
    const std::size_t found = xml_.find(end, at_);
    if (found == std::string::npos) return fail(at_, problem);
    at_ = found + end.size();
  }

  /// Some parsers end it at the first `>`, others at `?>`.
  void skip_instruction() {
    const std::size_t end = xml_.find('>', at_);
    if (end == std::string::npos || xml_[end - 1] != '?')
      return fail(at_, "a processing instruction that does not end with its first >");
    at_ = end + 1;
  }

  void skip_declaration() {
    const std::size_t end = xml_.find('>', at_), inner = xml_.find_first_of("<[", at_ + 1);
    if (end == std::string::npos || inner < end) return fail(at_, "a document type with definitions");
    at_ = end + 1;
  }

  void read_start_tag() {
    const std::size_t name = at_ + 1;
    const auto first = static_cast<unsigned char>(name < xml_.size() ? xml_[name] : 0);
    if (!std::isalpha(first) && first != '_' && first < 0x80) return fail(at_, "a < that starts no tag");
    const std::size_t name_end = std::min(xml_.find_first_of(" \t\r\n/>", name), xml_.size());
    std::size_t at = name_end, attributes = 0;
    while (at < xml_.size() && xml_[at] != '>') {
      if (xml_[at] == '<') return fail(at, "a < inside of a tag");
      // Each attribute has one outside of quotes; a parser that takes values without quotes may see fewer attributes.
      if (xml_[at] == '=') ++attributes;
      if (xml_[at] == '"' || xml_[at] == '\'') at = xml_.find(xml_[at], at + 1);
      if (at == std::string::npos) break;
      ++at;
    }
    if (at >= xml_.size()) return fail(at_, "a tag without end");
    outline_.levels = std::max(outline_.levels, open_ + 1);
    outline_.attributes = std::max(outline_.attributes, attributes);
    if (xml_.compare(name, name_end - name, "link") == 0) ++outline_.links;
    const bool is_named = !is_in_named_ && names_.count(xml_.substr(name, name_end - name)) > 0;
    if (is_named) begin_named();
    at_ = at + 1;
    if (xml_[at - 1] != '/')
      ++open_;
    else if (is_named)
      end_named();
  }

  void begin_named() {
    is_in_named_ = true;
    level_of_named_ = open_;
    outline_.named.emplace_back(at_, xml_.size());
  }
  void end_named() {
    is_in_named_ = false;
    outline_.named.back().second = at_;
  }

  const std::string& xml_;
  const std::size_t end_;  ///< of what is text
  const std::set<std::string>& names_;
  XmlOutline outline_;
  std::size_t at_ = 0;
  std::size_t open_ = 0;
  bool is_in_named_ = false;
  std::size_t level_of_named_ = 0;
};

}  // namespace

XmlOutline outline_of(const std::string& xml, const std::set<std::string>& names) {
  return Scanner(xml, names).outline();
}

}  // namespace verlet_cable
