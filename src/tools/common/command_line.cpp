#include "command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstddef>

#include "scene/text.h"

namespace verlet_cable::tools {
namespace {

/// Stands for the value that an option lacks: no argument contains it.
const std::string no_value(1, '\0');

/// Without what CLI11 says of defaults and types.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_usage(const CLI::App* /*app*/, std::string /*name*/) const override { return ""; }
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_type_name().empty() ? "" : " " + option->get_type_name();
  }
};

bool is_ros_argument(const std::string& argument) {
  return argument.rfind("__", 0) == 0 && argument.find(":=") != std::string::npos;
}

/// The last first, as CLI11 wants them. CLI11 takes `--option=` for an option whose value follows.
std::vector<std::string> reversed(const std::vector<std::string>& arguments) {
  std::vector<std::string> last_first;
  for (auto argument = arguments.rbegin(); argument != arguments.rend(); ++argument) {
    if (is_ros_argument(*argument)) continue;
    const bool is_empty_value = argument->rfind("--", 0) == 0 && argument->back() == '=';
    if (is_empty_value) last_first.emplace_back();
    last_first.push_back(is_empty_value ? argument->substr(0, argument->size() - 1) : *argument);
  }
  return last_first;
}

bool is_option(const std::string& argument) {
  return argument.size() > 1 && argument[0] == '-';
}

std::vector<std::string> names_of_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) names.push_back(option->get_name());
  return names;
}

std::string nearest_option(const std::string& argument, const CLI::App& app) {
  return nearest_name(argument.substr(0, argument.find('=')), names_of_options(app));
}

/// Whether what follows an option that there is not may be its value.
bool may_have_value(const std::string& argument, const CLI::App& app) {
  const bool has_name = argument.size() > 2 && argument[1] == '-' && std::isalpha(static_cast<unsigned char>(argument[2])) != 0;
  if (!has_name || argument.find('=') != std::string::npos) return false;
  const std::string nearest = nearest_option(argument, app);
  return nearest.empty() || !app.get_option(nearest)->get_type_name().empty();
}

std::string no_such_option(const std::string& argument, const CLI::App& app) {
  std::string allowed;
  for (const std::string& name : names_of_options(app)) allowed += (allowed.empty() ? "" : ", ") + name;
  const std::string nearest = nearest_option(argument, app);
  return escaped(argument) + ": no such option" + (nearest.empty() ? "" : " (did you mean " + nearest + "?)") +
         "; allowed: " + allowed;
}

}  // namespace

CommandLine::CommandLine(const std::string& usage, const std::string& footer) : app_(std::make_unique<CLI::App>(usage)) {
  app_->formatter(std::make_shared<HelpFormatter>());
  app_->footer(footer);
  app_->allow_extras();
  app_->set_help_flag();
  add_flag("--help,-h", "this text", help_);
}

CommandLine::~CommandLine() = default;

void CommandLine::add_number(const std::string& name, const std::string& placeholder, const std::string& description,
                             double& number, const Range& range, const char* unit) {
  add(name, placeholder, description, range.text(unit), [&number, range](const std::string& value) {
    const auto read = parse_number(value);
    if (!read || !range.contains(*read)) return false;
    number = *read;
    return true;
  });
}

void CommandLine::add_integer(const std::string& name, const std::string& placeholder, const std::string& description,
                              int& integer, const Range& range) {
  add(name, placeholder, description, range.text(), [&integer, range](const std::string& value) {
    const auto read = parse_number(value);
    if (!read || !range.contains(*read) || *read != static_cast<int>(*read)) return false;
    integer = static_cast<int>(*read);
    return true;
  });
}

void CommandLine::add_text(const std::string& name, const std::string& placeholder, const std::string& description,
                           std::string& text, const std::string& allowed) {
  add(name, placeholder, description, allowed, [&text](const std::string& value) {
    text = value;
    return !value.empty();
  });
}

void CommandLine::add_flag(const std::string& name, const std::string& description, bool& flag) {
  add(name, "", description, "no value", [&flag](const std::string& value) { return flag = value == no_value; });
}

std::vector<std::string> CommandLine::parse(const std::vector<std::string>& arguments, std::vector<std::string>& errors) {
  errors_.clear();
  left_out_ = false;
  std::vector<std::string> last_first = reversed(arguments);
  app_->parse(last_first);
  std::vector<std::string> others;
  const std::vector<std::string> remaining = app_->remaining();
  for (std::size_t i = 0; i < remaining.size(); ++i) {
    if (!is_option(remaining[i])) {
      others.push_back(remaining[i]);
      continue;
    }
    errors_.push_back(no_such_option(remaining[i], *app_));
    if (i + 1 == remaining.size() || !may_have_value(remaining[i], *app_)) continue;
    const auto pair = remaining.begin() + static_cast<std::ptrdiff_t>(i);
    const bool is_next = std::search(arguments.begin(), arguments.end(), pair, pair + 2) != arguments.end();
    if (!is_next || (is_option(remaining[i + 1]) && !parse_number(remaining[i + 1]))) continue;
    left_out_ = true;
    ++i;
  }
  errors.insert(errors.end(), errors_.begin(), errors_.end());
  return others;
}

std::string CommandLine::help() const {
  return help_ ? app_->help() : "";
}

void CommandLine::add(const std::string& name, const std::string& placeholder, const std::string& description,
                      const std::string& allowed, const Reader& read) {
  const bool is_flag = placeholder.empty();
  const auto read_all = [this, name, allowed, is_flag, read](const CLI::results_t& values) {
    if (values.size() > 1) errors_.push_back(name + ": given twice; allowed: once");
    for (const std::string& value : values) {
      if (value == no_value && !is_flag) {
        errors_.push_back(name + ": no value; allowed: " + allowed);
      } else if (!read(value)) {
        errors_.push_back(name + ": " + in_quotes(value) + "; allowed: " + allowed);
      }
    }
    return true;  // else CLI11 would stop at the first mistake
  };
  app_->add_option(name, read_all, description)
      ->type_name(placeholder)
      ->expected(0, is_flag ? 0 : 1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->default_str(no_value);
}

}  // namespace verlet_cable::tools
