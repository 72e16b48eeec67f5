#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <istream>
#include <map>
#include <string_view>
#include <system_error>

#include "guarded_text.h"
#include "named_file.h"
#include "scene_size.h"
#include "text.h"
#include "value.h"
#include "verlet_cable/scene/scene_reader.h"
#include "within_memory.h"
#include "yaml_hint.h"
#include "yaml_text.h"

namespace verlet_cable {
namespace {

constexpr std::string_view document_start = "--- ";

/// A text as yaml-cpp is given it. It takes a scene in brackets (JSON) for what may be a key, and keeps all its tokens up to the
/// last bracket; it does not where the start of a document is in front.
class YamlText {
 public:
  explicit YamlText(const std::string& original) : text_(original) {
    const std::size_t first = std::min(text_.find_first_not_of(" \t\r\n"), text_.size());
    if (first == text_.size() || text_[first] != '{') return;
    const auto begin = text_.begin();
    line_ = static_cast<int>(std::count(begin, begin + static_cast<std::ptrdiff_t>(first), '\n'));
    text_.insert(line_ == 0 ? 0 : text_.rfind('\n', first) + 1, document_start);
  }

  const std::string& text() const { return text_; }
  /// A place of it in the original.
  std::string place(const YAML::Mark& mark) const {
    const int inserted = mark.line == line_ ? static_cast<int>(document_start.size()) : 0;
    return "line " + std::to_string(mark.line + 1) + ", column " + std::to_string(std::max(mark.column + 1 - inserted, 1)) + ": ";
  }

 private:
  std::string text_;
  int line_ = -1;  ///< which begins with the start of a document; -1: none was inserted
};

/// yaml-cpp takes a NUL for the start of an escape sequence, and one in front for wide characters; and what is not UTF-8 as it
/// is, though no message of ROS and no text of Python can hold it.
void check_encoding(const std::string& text) {
  const auto starts_with = [&](const std::string& bytes) { return text.compare(0, bytes.size(), bytes) == 0; };
  const bool wide = starts_with("\xff\xfe") || starts_with("\xfe\xff") || starts_with(std::string("\0\0\xfe\xff", 4));
  const std::size_t end = wide ? text.size() : length_of_text(text);
  if (end == text.size()) return;
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
  const std::string byte =
      text[end] == '\0' ? "a NUL byte" : "the byte " + in_quotes(text.substr(end, 1)) + ", which is not UTF-8";
  throw SceneError(
      {"line " + std::to_string(line) + ": " + byte + "; allowed: text in UTF-8, or in UTF-16 or UTF-32 with a byte order mark"});
}

/// Counts values and levels while YAML is parsed, before anything is built of it: a short text can stand for a tree without end.
class SizeCheck : public YAML::EventHandler {
 public:
  /// `guarded` is of `text`; both outlive this.
  SizeCheck(const YamlText& text, GuardedText& guarded) : text_(text), guarded_(guarded) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) fail(mark, "a second document (---); allowed: one");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add_value(mark, anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, const std::string&) override {
    add_value(mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto subtree = subtrees_.find(anchor);
    if (subtree == subtrees_.end()) fail(mark, "an alias inside of what it stands for");
    count(mark, subtree->second.values);
    check_depth(mark, subtree->second.levels);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    open(mark, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    open(mark, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Subtree {
    std::size_t values;
    std::size_t levels;
  };
  struct Open {
    YAML::anchor_t anchor;
    std::size_t values_before;
    std::size_t levels;
  };

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& message) const {
    throw SceneError({text_.place(mark) + message});
  }

  void count(const YAML::Mark& mark, std::size_t values) {
    guarded_.let_go();
    values_ += values;
    if (values_ > most_scene_values) fail(mark, "more than " + std::to_string(most_scene_values) + " values");
  }
  void check_depth(const YAML::Mark& mark, std::size_t levels) {
    for (std::size_t i = open_.size(); i-- > 0;) {
      ++levels;
      open_[i].levels = std::max(open_[i].levels, levels);
    }
    if (levels > deepest_scene_level) fail(mark, "nested deeper than " + std::to_string(deepest_scene_level) + " levels");
  }
  void add_value(const YAML::Mark& mark, YAML::anchor_t anchor) {
    count(mark, 1);
    if (anchor != 0) subtrees_[anchor] = {1, 0};
  }
  void open(const YAML::Mark& mark, YAML::anchor_t anchor) {
    open_.push_back({anchor, values_, 0});
    check_depth(mark, 0);
    count(mark, 1);
  }
  void close() {
    const Open closed = open_.back();
    open_.pop_back();
    if (closed.anchor != 0) subtrees_[closed.anchor] = {values_ - closed.values_before, closed.levels};
  }

  const YamlText& text_;
  GuardedText& guarded_;
  std::size_t documents_ = 0;
  std::size_t values_ = 0;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Subtree> subtrees_;
};

void check_size(const YamlText& text) {
  GuardedText guarded(text.text());
  std::istream stream(&guarded);
  YAML::Parser parser(stream);
  SizeCheck check(text, guarded);
  try {
    while (parser.HandleNextDocument(check)) {
    }
  } catch (const YAML::Exception&) {
    if (guarded.problem().empty()) throw;
  }
  if (!guarded.problem().empty()) throw SceneError({guarded.problem()});
}

}  // namespace

std::string scene_file_text(const std::string& path) {
  if (const std::string problem = why_not_readable(path); !problem.empty())
    throw SceneError({"cannot read: " + problem + "; allowed: a file"});
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  std::vector<char> block(std::size_t{1} << 16);
  // What is too large is not read to its end: it may have none.
  while (file && text.size() <= largest_scene_text) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (!file.is_open() || file.bad())
    throw SceneError({"scene: cannot read " + in_quotes(path) + ": " + std::generic_category().message(errno ? errno : EIO)});
  return text;
}

FileAccess access_beside(const std::string& scene) {
  return {true, std::filesystem::path(scene).parent_path().string()};
}

void read_yaml_text(const std::string& text, const std::function<void(const YAML::Node& root)>& read) {
  if (text.size() > largest_scene_text)
    throw SceneError(
        {"scene: " + std::to_string(text.size()) + " bytes or more; allowed: at most " + std::to_string(largest_scene_text)});
  check_encoding(text);
  within_memory([&] {
    const YamlText yaml(text);
    try {
      check_size(yaml);
      read(YAML::Load(yaml.text()));
    } catch (const YAML::Exception& error) {
      const std::string hint = yaml_hint(yaml.text(), error);
      throw SceneError({yaml.place(error.mark) + escaped(error.msg, longest_message) + (hint.empty() ? "" : "; " + hint)});
    }
  });
}

SceneDesc read_scene_text(const std::string& text, const SceneSources& sources) {
  SceneDesc scene;
  read_yaml_text(text, [&](const YAML::Node& root) { scene = read_scene(root, {}, sources); });
  return scene;
}

SceneDesc read_scene_file(const std::string& path) {
  return read_scene_file(path, {access_beside(path), {}});
}

SceneDesc read_scene_file(const std::string& path, const SceneSources& sources) {
  return read_scene_text(within_memory([&] { return scene_file_text(path); }), sources);
}

}  // namespace verlet_cable
