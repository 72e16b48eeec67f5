#pragma once

#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace verlet_cable {

/// Writes numbers, flags and choices one after the other, as this kind of machine has them.
class ByteWriter {
 public:
  template <class Number>
  void operator()(const Number& number) {
    static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  /// Its length goes before it.
  void write_text(std::string_view text) {
    (*this)(text.size());
    bytes_.append(text);
  }
  template <class Number>
  void write_list(const std::vector<Number>& numbers) {
    (*this)(numbers.size());
    for (const Number& number : numbers) (*this)(number);
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads what a ByteWriter has written, in the same order. Throws std::invalid_argument where the bytes end before that, or are
/// none that it writes for a flag.
class ByteReader {
 public:
  /// The bytes must outlive the reader.
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <class Number>
  void operator()(Number& number) {
    static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
    const char* first = take(sizeof number).data();
    if constexpr (std::is_same_v<Number, bool>) {
      if (*first != 0 && *first != 1) throw std::invalid_argument("a flag is neither set nor unset");
      number = *first == 1;
    } else {
      std::memcpy(&number, first, sizeof number);
    }
  }
  /// Of what is written with at least a byte each.
  std::size_t read_length() {
    std::size_t length = 0;
    (*this)(length);
    if (length > bytes_.size()) fail();
    return length;
  }
  std::string read_text() { return std::string(take(read_length())); }
  template <class Number>
  void read_list(std::vector<Number>& numbers) {
    numbers.resize(read_length());
    for (Number& number : numbers) (*this)(number);
  }
  bool is_at_end() const { return bytes_.empty(); }

 private:
  [[noreturn]] static void fail() { throw std::invalid_argument("they end too early"); }
  std::string_view take(std::size_t count) {
    if (count > bytes_.size()) fail();
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  std::string_view bytes_;
};

}  // namespace verlet_cable
