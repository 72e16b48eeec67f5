#include "json_writer.h"

#include <cmath>

#include "verlet_cable/core/number_text.h"

namespace verlet_cable::tools {
namespace {

std::string number_or_null(double number) {
  return std::isfinite(number) ? number_text(number) : "null";
}

}  // namespace

void JsonWriter::key(const std::string& name) {
  separate();
  append_quoted(name);
  text_ += ": ";
  after_key_ = true;
}

void JsonWriter::value(double number) {
  separate();
  text_ += number_or_null(number);
}

void JsonWriter::value(std::int64_t number) {
  separate();
  text_ += std::to_string(number);
}

void JsonWriter::value(const std::string& text) {
  separate();
  append_quoted(text);
}

void JsonWriter::value(const Vector3& vector) {
  separate();
  text_ += '[' + number_or_null(vector.x()) + ", " + number_or_null(vector.y()) + ", " + number_or_null(vector.z()) + ']';
}

void JsonWriter::begin(char bracket) {
  separate();
  text_ += bracket;
  indent_ += "  ";
  is_first_ = true;
}

void JsonWriter::end(char bracket) {
  indent_.resize(indent_.size() - 2);
  if (!is_first_) text_ += indent_;
  text_ += bracket;
  is_first_ = false;
}

void JsonWriter::separate() {
  if (!after_key_ && indent_.size() > 1) text_ += is_first_ ? indent_ : "," + indent_;
  after_key_ = false;
  is_first_ = false;
}

void JsonWriter::append_quoted(const std::string& text) {
  constexpr char hexadecimal[] = "0123456789abcdef";
  text_ += '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') text_ += '\\';
    if (byte < 0x20) {
      text_ += {'\\', 'u', '0', '0', hexadecimal[byte / 16], hexadecimal[byte % 16]};
    } else {
      text_ += c;
    }
  }
  text_ += '"';
}

}  // namespace verlet_cable::tools
