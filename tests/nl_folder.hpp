// The .nl files of the tests.
#pragma once

#include <string>

#include "tenon/core/read_file.hpp"

namespace tenon {

inline std::string nl_path(const std::string& name) {
  return TENON_SOURCE_DIR "/tests/data/nl/" + name + ".nl";
}

inline std::string nl_text(const std::string& name) {
  return read_file(nl_path(name));
}

/// The text with the first `what` replaced; the text as it is where there is none.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

}  // namespace tenon
