#include "report.h"

#include <algorithm>
#include <cstdio>
#include <iostream>

namespace verlet_cable::bench {

void Report::table(const std::string& title, std::vector<std::string> columns) {
  title_ = title;
  columns_ = std::move(columns);
  widths_.clear();
  std::cout << '\n' << title_ << '\n';
  for (const std::string& column : columns_) widths_.push_back(column.size());
  row(columns_);
}

void Report::row(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t width = std::max(widths_[i], cells[i].size());
    line += std::string(width - cells[i].size(), ' ') + cells[i] + "  ";
  }
  std::cout << "  " << line.substr(0, line.find_last_not_of(' ') + 1) << std::endl;
}

void Report::note(const std::string& line) {
  std::cout << "  " << line << std::endl;
}

std::string Report::at_least(double value, double target) {
  return judge(value >= target);
}

std::string Report::at_most(double value, double target) {
  return judge(value <= target);
}

std::string Report::judge(bool reached) {
  if (reached)
    ++reached_;
  else
    missed_.push_back(title_);
  return reached ? "reached" : "MISSED";
}

void Report::summary() const {
  std::cout << '\n' << reached_ << " targets reached, " << missed_.size() << " missed\n";
  for (std::size_t i = 0; i < missed_.size(); ++i)
    if (i == 0 || missed_[i] != missed_[i - 1])
      std::cout << "  missed " << std::count(missed_.begin(), missed_.end(), missed_[i]) << " in: " << missed_[i] << '\n';
}

std::string figure(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

}  // namespace verlet_cable::bench
