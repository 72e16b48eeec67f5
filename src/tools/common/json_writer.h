#pragma once

#include <cstdint>
#include <string>

#include "verlet_cable/core/types.h"

namespace verlet_cable::tools {

/// Writes JSON, indented. Numbers that JSON does not have are null.
class JsonWriter {
 public:
  void begin_object() { begin('{'); }
  void end_object() { end('}'); }
  void begin_array() { begin('['); }
  void end_array() { end(']'); }
  /// The key of what is written next, inside an object.
  void key(const std::string& name);

  void value(double number);
  void value(std::int64_t number);
  void value(const std::string& text);
  void value(const Vector3& vector);  ///< an array of three numbers

  template <class Value>
  void entry(const std::string& name, const Value& entry_value) {
    key(name);
    value(entry_value);
  }

  const std::string& text() const { return text_; }

 private:
  void begin(char bracket);
  void end(char bracket);
  void separate();
  void append_quoted(const std::string& text);

  std::string text_;
  std::string indent_ = "\n";
  bool is_first_ = true;
  bool after_key_ = false;
};

}  // namespace verlet_cable::tools
