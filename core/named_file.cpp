#include "tenon/core/named_file.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "tenon/core/nearest_name.hpp"
#include "tenon/core/read_file.hpp"

namespace tenon {

namespace {

const EmbeddedFile* find(const std::string& name, const std::vector<EmbeddedFile>& carried) {
  const auto found = std::ranges::find(carried, name, &EmbeddedFile::name);
  return found == carried.end() ? nullptr : &*found;
}

}  // namespace

NamedFile open_named_file(const std::string& kind, const std::string& name_or_path, const std::vector<EmbeddedFile>& carried) {
  if (const EmbeddedFile* file = find(name_or_path, carried)) return {name_or_path, std::string(file->text)};
  const bool is_path =
      name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".toml") || std::filesystem::exists(name_or_path);
  if (is_path) return {name_or_path, read_file(name_or_path)};
  const std::vector<std::string> names = names_of(carried);
  std::string list;
  for (const std::string& name : names) list += name + ", ";
  throw std::invalid_argument("unknown " + kind + " '" + name_or_path + "', the nearest is '" + nearest_name(name_or_path, names) +
                              "' (expected one of " + list + "or a TOML file)");
}

std::vector<std::string> names_of(const std::vector<EmbeddedFile>& carried) {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : carried) names.emplace_back(file.name);
  std::ranges::sort(names);
  return names;
}

std::string description_of(const std::string& name, const std::vector<EmbeddedFile>& carried) {
  const EmbeddedFile* file = find(name, carried);
  return file ? std::string(file->text.substr(2, file->text.find('\n') - 2)) : "";
}

}  // namespace tenon
