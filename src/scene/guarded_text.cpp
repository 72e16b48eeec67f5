#include "guarded_text.h"

#include <algorithm>
#include <cstring>

namespace verlet_cable {
namespace {

constexpr std::size_t block = 1024;
constexpr std::size_t most_marks = 1'000'000;  // takes up to 270 MB
constexpr long most_brackets = 1000;

bool is_one_of(const char* characters, char c) {
  return c != '\0' && std::strchr(characters, c) != nullptr;
}

}  // namespace

GuardedText::int_type GuardedText::underflow() {
  const std::size_t begin = next_;
  const std::size_t end = std::min(text_.size(), begin + block);
  for (; next_ < end && problem_.empty(); ++next_) count(text_[next_]);
  if (next_ == begin) return traits_type::eof();
  // Nothing is written through these pointers: it is for reading only.
  char* const start = const_cast<char*>(text_.data());
  setg(start + begin, start + begin, start + next_);
  return traits_type::to_int_type(text_[begin]);
}

void GuardedText::count(char c) {
  if (c == '\n') ++line_;
  if (is_one_of("[{", c)) ++brackets_;
  if (is_one_of("]}", c)) --brackets_;
  // A dash is a mark of its own before a blank only.
  if (is_one_of("[]{},:?\"'&*!|>%", c) || (last_ == '-' && is_one_of(" \t\r\n", c))) ++marks_;
  last_ = c;
  if (brackets_ > most_brackets)
    problem_ = "brackets inside of brackets; allowed: at most " + std::to_string(most_brackets) + " levels";
  if (marks_ > most_marks)
    problem_ =
        "more than " + std::to_string(most_marks) +
        " signs [ ] { } , : and others in one value in brackets; allowed: its lists with one element a line, each after \"- \"";
  if (!problem_.empty()) problem_ = "line " + std::to_string(line_) + ": " + problem_;
}

}  // namespace verlet_cable
