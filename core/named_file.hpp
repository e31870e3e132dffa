// A file asked for by the name of one that the binary carries, or by its path.
#pragma once

#include <string>
#include <vector>

#include "tenon/core/embedded_file.hpp"

namespace tenon {

struct NamedFile {
  std::string name;  // as in messages
  std::string text;
};

/// The carried file of that name, else the one at that path. Throws InputError where that cannot be read, std::invalid_argument for a word
/// that is neither, the nearest name named; `kind` is what is looked for: "unknown robot ...".
NamedFile open_named_file(const std::string& kind, const std::string& name_or_path, const std::vector<EmbeddedFile>& carried);

/// Their names, sorted.
std::vector<std::string> names_of(const std::vector<EmbeddedFile>& carried);
/// What the one of that name is, from the comment that opens it; empty where there is none.
std::string description_of(const std::string& name, const std::vector<EmbeddedFile>& carried);

}  // namespace tenon
