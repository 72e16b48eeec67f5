#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace verlet_cable {

/// The text of an argument. Throws ValueError where UTF-8 cannot hold it: of half a surrogate pair.
std::string text_of(const pybind11::handle& text, const std::string& argument);

/// A path as the file system has it: of text, bytes, or what has __fspath__. Throws TypeError, and ValueError where no file has
/// such a name.
std::string path_of(const pybind11::handle& path, const std::string& argument);

/// Its representation in ASCII, for messages.
std::string ascii_text(const pybind11::handle& value);

}  // namespace verlet_cable
