// A file that the binary carries with it: see tenon_embed in core/cmake/TenonTargets.cmake.
#pragma once

#include <string_view>
#include <vector>

namespace tenon {

struct EmbeddedFile {
  std::string_view name;  // the file's name without its extension
  std::string_view text;
};

}  // namespace tenon
