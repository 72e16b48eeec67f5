#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "verlet_cable/core/scene_fields.h"

namespace CLI {
class App;
}

namespace verlet_cable::tools {

/// The command line of a program, `--option value` and `--option=value`, of which every mistake is told at once. What options
/// are added for has to live until `parse` is done.
class CommandLine {
 public:
  /// What --help says before the options, and after them.
  CommandLine(const std::string& usage, const std::string& footer);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// `placeholder`: the value's name in --help, which says `description`.
  void add_number(const std::string& name, const std::string& placeholder, const std::string& description, double& number,
                  const Range& range, const char* unit);
  void add_integer(const std::string& name, const std::string& placeholder, const std::string& description, int& integer,
                   const Range& range);
  void add_text(const std::string& name, const std::string& placeholder, const std::string& description, std::string& text,
                const std::string& allowed);
  void add_flag(const std::string& name, const std::string& description, bool& flag);

  /// Reads the arguments after the program's name, and adds a line to `errors` for each that is wrong. Arguments that roslaunch
  /// appends (`__name:=...`) are skipped. Returns those that are neither options nor their values; what follows an option that
  /// there is not counts as its value, unless a flag was meant.
  std::vector<std::string> parse(const std::vector<std::string>& arguments, std::vector<std::string>& errors);

  /// Whether something may have been left out in this way that was not a value.
  bool left_out() const { return left_out_; }

  /// What --help prints; empty if it was not asked for.
  std::string help() const;

 private:
  using Reader = std::function<bool(const std::string& value)>;

  /// `read`: false for a value that is not allowed. Flags are options without a value, and without a placeholder.
  void add(const std::string& name, const std::string& placeholder, const std::string& description, const std::string& allowed,
           const Reader& read);

  std::unique_ptr<CLI::App> app_;
  bool help_ = false;
  bool left_out_ = false;
  std::vector<std::string> errors_;
};

}  // namespace verlet_cable::tools
