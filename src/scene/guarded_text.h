#pragma once

#include <cstddef>
#include <streambuf>
#include <string>

namespace verlet_cable {

/// A text that ends early where a parser of YAML would have to keep too much before it can say anything: yaml-cpp keeps all
/// tokens of brackets in a list up to their end, some hundred bytes for each, whatever lines they are on. What it has said is let
/// go.
class GuardedText : public std::streambuf {
 public:
  /// `text` outlives this.
  explicit GuardedText(const std::string& text) : text_(text) {}

  /// The parser has said something of what it read.
  void let_go() { marks_ = brackets_ = 0; }
  /// Why the text ends early, with the line; empty if it does not.
  const std::string& problem() const { return problem_; }

 protected:
  int_type underflow() override;

 private:
  void count(char c);

  const std::string& text_;
  std::size_t next_ = 0;
  std::size_t line_ = 1;
  std::size_t marks_ = 0;  ///< characters that may begin tokens
  long brackets_ = 0;      ///< opened and not closed; those in quotes and comments are as good
  char last_ = '\n';
  std::string problem_;
};

}  // namespace verlet_cable
