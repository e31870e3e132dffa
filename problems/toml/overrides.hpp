// `--set key.path=value` applied to a parsed TOML table. Included by document.cpp alone, so that toml++ is compiled once.
#pragma once

#include <charconv>
#include <string>
#include <vector>

#include "tenon/core/input_error.hpp"

#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

namespace tenon::toml_file::detail {

struct Override {
  std::string path;  // rotor.3.spin
  std::string text;  // as on the command line
};

inline InputPosition position_of_override(const std::string& text) {
  return {"--set " + text, 0, 0};
}

inline std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t dot; (dot = path.find('.', begin)) != std::string::npos; begin = dot + 1)
    parts.push_back(path.substr(begin, dot - begin));
  parts.push_back(path.substr(begin));
  return parts;
}

/// The value of an override: TOML, or else a bare word, which is a string.
inline toml::table parse_override_value(const std::string& text, const std::string& value) {
  try {
    return toml::parse("value = " + value);
  } catch (const toml::parse_error&) {
    constexpr std::string_view kNotInAWord = "\"'[]{}=,#\n";
    if (value.empty() || value.find_first_of(kNotInAWord) != std::string::npos) {
      throw InputError(position_of_override(text), "'" + value + "' is no TOML value", "a number, true, false, a word or a [list]");
    }
    return toml::table{{"value", value}};
  }
}

inline toml::node* element(toml::array& array, const std::string& part, const std::string& text) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error != std::errc() || end != part.data() + part.size() || index < 1 || index > array.size()) {
    throw InputError(position_of_override(text), "there is no element '" + part + "'",
                     array.empty() ? "no element: the list is empty" : "a number from 1 to " + std::to_string(array.size()));
  }
  return array.get(index - 1);
}

inline void apply_override(toml::table& root, const Override& override_, const std::string& value_text) {
  const toml::table parsed = parse_override_value(override_.text, value_text);
  const toml::node& value = *parsed.get("value");
  const std::vector<std::string> parts = split_path(override_.path);
  toml::node* node = &root;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const bool last = k + 1 == parts.size();
    if (parts[k].empty()) throw InputError(position_of_override(override_.text), "the key has an empty part", "key.path=value");
    if (toml::table* table = node->as_table()) {
      if (last)
        table->insert_or_assign(parts[k], value);
      else
        node = table->contains(parts[k]) ? table->get(parts[k]) : &table->insert(parts[k], toml::table{}).first->second;
    } else if (toml::array* array = node->as_array()) {
      node = element(*array, parts[k], override_.text);
      if (last) array->replace(array->cbegin() + (std::stoll(parts[k]) - 1), value);
    } else {
      throw InputError(position_of_override(override_.text), "'" + parts[k - 1] + "' is a single value", "a table or a list there");
    }
  }
}

}  // namespace tenon::toml_file::detail
