#pragma once

#include <cstddef>
#include <string>

namespace verlet_cable {

/// How many bytes the character of UTF-8 has that begins at a place of a text; 0 where none does.
inline std::size_t character_size(const std::string& text, std::size_t place) {
  const auto lead = static_cast<unsigned char>(text[place]);
  if (lead < 0x80) return 1;
  if (lead < 0xc2 || lead > 0xf4) return 0;
  const std::size_t size = lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
  if (place + size > text.size()) return 0;
  for (std::size_t i = place + 1; i < place + size; ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) return 0;
  // Neither more bytes than needed, nor halves of UTF-16, nor beyond the last character.
  const auto second = static_cast<unsigned char>(text[place + 1]);
  const bool is_other = (lead == 0xe0 && second < 0xa0) || (lead == 0xed && second > 0x9f) || (lead == 0xf0 && second < 0x90) ||
                        (lead == 0xf4 && second > 0x8f);
  return is_other ? 0 : size;
}

/// How many bytes of a text there are before the first that is a NUL, or not of a character of UTF-8.
inline std::size_t length_of_text(const std::string& text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t size = character_size(text, at);
    if (size == 0 || text[at] == '\0') break;
    at += size;
  }
  return at;
}

/// Text from a user, for messages: one line of valid UTF-8 without control characters, truncated after about `longest` bytes.
inline std::string escaped(const std::string& text, std::size_t longest = 60) {
  constexpr char hexadecimal[] = "0123456789abcdef";
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (result.size() >= longest) return result + "...";
    const std::size_t size = character_size(text, i);
    const auto byte = static_cast<unsigned char>(text[i]);
    if (size == 0 || byte < 0x20 || byte == 0x7f) {
      result += {'\\', 'x', hexadecimal[byte / 16], hexadecimal[byte % 16]};
      ++i;
    } else {
      result.append(text, i, size);
      i += size;
    }
  }
  return result;
}

/// The same in quotes.
inline std::string in_quotes(const std::string& text) {
  return '"' + escaped(text) + '"';
}

}  // namespace verlet_cable
