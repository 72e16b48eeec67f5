#include "binding/appearance.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "binding/text_arguments.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

[[noreturn]] void refuse(const std::string& name, const py::handle& value, const std::string& allowed) {
  throw py::value_error(name + ": " + ascii_text(value) + "; allowed: " + allowed);
}

double read_number(const std::string& name, const py::handle& value, const Range& range, const char* unit) {
  double number = 0;
  try {
    number = value.cast<double>();
  } catch (const py::cast_error&) {
    refuse(name, value, range.text(unit));
  }
  if (!range.contains(number)) refuse(name, value, range.text(unit));
  return number;
}

bool read_flag(const std::string& name, const py::handle& value) {
  const bool is_flag = py::isinstance<py::bool_>(value) || py::isinstance(value, py::module_::import("numpy").attr("bool_"));
  if (!is_flag) refuse(name, value, "True or False");
  return py::bool_(py::reinterpret_borrow<py::object>(value));
}

std::array<double, 3> read_three(const std::string& name, const py::handle& value, const Range& range, const char* allowed) {
  const Numbers numbers = Numbers::ensure(value);
  if (!numbers) PyErr_Clear();
  if (!numbers || numbers.ndim() != 1 || numbers.size() != 3 ||
      !std::all_of(numbers.data(), numbers.data() + 3, [&](double number) { return range.contains(number); }))
    refuse(name, value, allowed);
  return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

view::Color read_color(const std::string& name, const py::handle& value) {
  return read_three(name, value, unit_interval, "red, green, blue: three numbers from 0 to 1");
}

/// Calls read(key, value) for each; it returns whether it knows the key.
template <class Read>
void read_keys(const std::string& name, const py::handle& given, const char* keys, const Read& read) {
  if (!py::isinstance<py::dict>(given)) refuse(name, given, std::string("a dict with some of the keys ") + keys);
  for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(given)) {
    const std::string text = py::isinstance<py::str>(key) ? text_of(key, name) : "";
    if (!read(text, value)) refuse(name, key, std::string("the keys ") + keys);
  }
}

view::Light read_light(const py::handle& given) {
  view::Light light;
  read_keys("light", given, "direction, ambient, shadows", [&](const std::string& key, const py::handle& value) {
    if (key == "direction") {
      const auto [x, y, z] = read_three("light.direction", value, coordinate, "three finite numbers, not all 0");
      light.direction = {x, y, z};
      if (!(light.direction.norm() > 1e-9)) refuse("light.direction", value, "three finite numbers, not all 0");
    } else if (key == "ambient") {
      light.ambient = read_number("light.ambient", value, unit_interval, "");
    } else if (key == "shadows") {
      light.shadows = read_flag("light.shadows", value);
    } else {
      return false;
    }
    return true;
  });
  return light;
}

constexpr Range stripes_range{0, 1000, "an integer, 0 or more"};
constexpr const char* look_keys = "color, second_color, pattern, stripes, stripe_width, check_size, shininess";

void read_look(const std::string& name, const py::handle& given, view::Look& look) {
  using Pattern = view::Look::Pattern;
  read_keys(name, given, look_keys, [&](const std::string& key, const py::handle& value) {
    const std::string full = name + "." + key;
    if (key == "color") {
      look.color = read_color(full, value);
    } else if (key == "second_color") {
      look.second_color = read_color(full, value);
    } else if (key == "pattern") {
      const std::string pattern = py::isinstance<py::str>(value) ? text_of(value, full) : "";
      if (pattern == "plain")
        look.pattern = Pattern::plain;
      else if (pattern == "stripes")
        look.pattern = Pattern::stripes;
      else if (pattern == "checks")
        look.pattern = Pattern::checks;
      else
        refuse(full, value, "plain, stripes (cables), checks (all else)");
    } else if (key == "stripes") {
      const double stripes = read_number(full, value, stripes_range, "");
      if (stripes != std::floor(stripes)) refuse(full, value, stripes_range.text(""));
      look.stripes = static_cast<int>(stripes);
    } else if (key == "stripe_width") {
      look.stripe_width = read_number(full, value, not_negative, "rad");
    } else if (key == "check_size") {
      look.check_size = read_number(full, value, positive, "m");
    } else if (key == "shininess") {
      look.shininess = read_number(full, value, unit_interval, "");
    } else {
      return false;
    }
    return true;
  });
}

}  // namespace

Appearance::Appearance(const py::dict& given) {
  read_keys("appearance", given, "light, background, looks, stripes, distinct_colors, least_radius",
            [&](const std::string& key, const py::handle& value) {
              if (key == "light") {
                light_ = read_light(value);
              } else if (key == "background") {
                background_ = read_color("background", value);
              } else if (key == "stripes") {
                options_.stripes = read_flag("stripes", value);
              } else if (key == "distinct_colors") {
                options_.distinct_colors = read_flag("distinct_colors", value);
              } else if (key == "least_radius") {
                options_.least_radius = read_number("least_radius", value, not_negative, "m");
              } else if (key == "looks") {
                if (!py::isinstance<py::dict>(value)) refuse("looks", value, "a dict of looks by the names of things");
                for (const auto& [name, look] : py::reinterpret_borrow<py::dict>(value)) {
                  view::Look unused;
                  read_look("looks[" + ascii_text(name) + "]", look, unused);
                  looks_.emplace(py::isinstance<py::str>(name) ? text_of(name, "looks") : ascii_text(name),
                                 py::reinterpret_borrow<py::dict>(look));
                }
              } else {
                return false;
              }
              return true;
            });
}

view::Drawing Appearance::drawing_of(const World& world) const {
  view::Drawing drawing = view::drawing_of(world, options_);
  if (light_) drawing.light = *light_;
  if (background_) drawing.background = *background_;
  for (const auto& [name, look] : looks_) {
    bool is_there = false;
    for (view::Thing& thing : drawing.things) {
      if (thing.name != name) continue;
      read_look("looks", look, thing.look);
      is_there = true;
    }
    if (is_there) continue;
    NameList names;
    for (const view::Thing& thing : drawing.things) names.add(thing.name);
    throw py::value_error("looks: " + in_quotes(name) + "; allowed: the names of what is there: " + names.text("nothing"));
  }
  return drawing;
}

}  // namespace verlet_cable
