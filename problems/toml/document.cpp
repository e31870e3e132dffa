#include "tenon/problems/toml/document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tenon/core/nearest_name.hpp"
#include "tenon/core/read_file.hpp"
#include "tenon/problems/toml/overrides.hpp"

namespace tenon::toml_file {

namespace {

struct Tree {
  std::string file;
  toml::table root;
  std::vector<detail::Override> overrides;
};

InputPosition position_of(const std::string& file, const toml::source_region& region) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

std::string kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::string:
      return "the text '" + **node.as_string() + "'";
    case toml::node_type::integer:
      return "the integer " + std::to_string(**node.as_integer());
    case toml::node_type::floating_point:
      return "the number " + std::to_string(**node.as_floating_point());
    case toml::node_type::boolean:
      return **node.as_boolean() ? "true" : "false";
    default:
      return "a date or time";
  }
}

}  // namespace

struct Table::Node {
  std::shared_ptr<const Tree> tree;
  const toml::table* table;
  std::string path;

  std::string path_of(const std::string& key) const {
    if (key.empty()) return path;
    return path.empty() ? key : path + "." + key;
  }

  /// An override at this path or above it; where the file does not have the path, one below it.
  InputPosition position(const std::string& at, const toml::source_region& region) const {
    for (auto o = tree->overrides.rbegin(); o != tree->overrides.rend(); ++o) {
      const bool covers = at == o->path || at.starts_with(o->path + ".") || (region.begin.line == 0 && o->path.starts_with(at + "."));
      if (covers) return detail::position_of_override(o->text);
    }
    return position_of(tree->file, region);
  }

  const toml::node& require(const std::string& key) const {
    const toml::node* value = table->get(key);
    if (value == nullptr) {
      throw InputError(position(path, table->source()), "key '" + key + "' is missing" + (path.empty() ? "" : " in " + path),
                       "a value for it");
    }
    return *value;
  }

  InputError wrong(const std::string& key, const toml::node& value, const std::string& expected) const {
    return InputError(position(path_of(key), value.source()), "'" + path_of(key) + "' is " + kind_of(value), expected);
  }

  double finite(const std::string& key, const toml::node& value, const std::string& expected) const {
    const std::optional<double> found = value.is_number() ? value.value<double>() : std::nullopt;
    if (!found) throw wrong(key, value, expected);
    if (!std::isfinite(*found)) throw wrong(key, value, "a finite number; leave the key out for no limit");
    return *found;
  }
};

namespace {

/// The list under a key, of exactly `size` entries where that is not 0.
const toml::array& list_of(const Table& table, const toml::node& value, const std::string& path, std::size_t size,
                           const InputError& no_list, const std::string& key, const std::string& expected) {
  const toml::array* array = value.as_array();
  if (array == nullptr) throw no_list;
  if (size != 0 && array->size() != size) {
    throw InputError(table.position(key), "'" + path + "' has " + std::to_string(array->size()) + " entries", expected);
  }
  return *array;
}

std::string expected_list(const std::string& what, std::size_t size) {
  return size == 0 ? "a list of " + what : "a list of " + std::to_string(size) + " " + what;
}

}  // namespace

bool Table::has(const std::string& key) const {
  return node_->table->contains(key);
}

std::vector<std::string> Table::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, value] : *node_->table) names.emplace_back(key.str());
  return names;
}

double Table::number(const std::string& key) const {
  return node_->finite(key, node_->require(key), "a number");
}

int Table::integer(const std::string& key) const {
  const toml::node& value = node_->require(key);
  const auto found = value.is_integer() ? value.value<int>() : std::nullopt;
  if (!found) throw node_->wrong(key, value, "an integer");
  return *found;
}

bool Table::flag(const std::string& key) const {
  const toml::node& value = node_->require(key);
  if (!value.is_boolean()) throw node_->wrong(key, value, "true or false");
  return **value.as_boolean();
}

std::string Table::text(const std::string& key) const {
  const toml::node& value = node_->require(key);
  if (!value.is_string()) throw node_->wrong(key, value, "text in quotes");
  return **value.as_string();
}

std::vector<double> Table::numbers(const std::string& key, std::size_t size) const {
  const std::string expected = expected_list("numbers", size);
  const toml::node& value = node_->require(key);
  std::vector<double> list;
  for (const toml::node& entry : list_of(*this, value, node_->path_of(key), size, node_->wrong(key, value, expected), key, expected))
    list.push_back(node_->finite(key + "." + std::to_string(list.size() + 1), entry, expected));
  return list;
}

Table::NumberOrText Table::number_or_text(const std::string& key) const {
  const toml::node& value = node_->require(key);
  if (value.is_string()) return {std::nullopt, **value.as_string()};
  return {node_->finite(key, value, "a number, or an expression in quotes"), ""};
}

std::vector<Table::NumberOrText> Table::numbers_or_texts(const std::string& key, std::size_t size) const {
  const std::string expected = expected_list("numbers or expressions", size);
  const toml::node& value = node_->require(key);
  std::vector<NumberOrText> list;
  for (const toml::node& entry : list_of(*this, value, node_->path_of(key), size, node_->wrong(key, value, expected), key, expected)) {
    if (entry.is_string())
      list.push_back({std::nullopt, **entry.as_string()});
    else
      list.push_back({node_->finite(key + "." + std::to_string(list.size() + 1), entry, expected), ""});
  }
  return list;
}

std::vector<std::string> Table::texts(const std::string& key, std::size_t size) const {
  const std::string expected = expected_list("texts", size);
  const toml::node& value = node_->require(key);
  std::vector<std::string> list;
  for (const toml::node& entry : list_of(*this, value, node_->path_of(key), size, node_->wrong(key, value, expected), key, expected)) {
    if (!entry.is_string()) throw node_->wrong(key + "." + std::to_string(list.size() + 1), entry, "text in quotes");
    list.push_back(**entry.as_string());
  }
  return list;
}

Eigen::Vector3d Table::vector3(const std::string& key) const {
  const std::vector<double> list = numbers(key, 3);
  return {list[0], list[1], list[2]};
}

std::optional<Table> Table::table(const std::string& key, const std::vector<std::string>& known_keys) const {
  if (!has(key)) return std::nullopt;
  const toml::node& value = node_->require(key);
  if (!value.is_table()) throw node_->wrong(key, value, "a table [" + node_->path_of(key) + "]");
  Table found(std::make_shared<const Node>(Node{node_->tree, value.as_table(), node_->path_of(key)}));
  found.reject_unknown_keys(known_keys);
  return found;
}

std::vector<Table> Table::tables(const std::string& key, const std::vector<std::string>& known_keys) const {
  std::vector<Table> found;
  if (!has(key)) return found;
  const std::string expected = "tables [[" + node_->path_of(key) + "]]";
  const toml::node& value = node_->require(key);
  if (!value.is_array()) throw node_->wrong(key, value, expected);
  for (const toml::node& entry : *value.as_array()) {
    const std::string name = key + "." + std::to_string(found.size() + 1);
    if (!entry.is_table()) throw node_->wrong(name, entry, expected);
    found.push_back(Table(std::make_shared<const Node>(Node{node_->tree, entry.as_table(), node_->path_of(name)})));
    found.back().reject_unknown_keys(known_keys);
  }
  return found;
}

InputPosition Table::position(const std::string& key) const {
  const toml::node* value = key.empty() ? nullptr : node_->table->get(key);
  return node_->position(node_->path_of(key), value == nullptr ? node_->table->source() : value->source());
}

const std::string& Table::path() const {
  return node_->path;
}

void Table::reject_unknown_keys(const std::vector<std::string>& known_keys) const {
  if (known_keys.empty()) return;
  for (const auto& [key, value] : *node_->table) {
    const std::string name(key.str());
    if (std::count(known_keys.begin(), known_keys.end(), name) > 0) continue;
    throw InputError(node_->position(node_->path_of(name), key.source()),
                     "unknown key '" + name + "'" + (path().empty() ? "" : " in " + path()) + "; the nearest known key is '" +
                         nearest_name(name, known_keys) + "'",
                     fmt::format("one of {}", fmt::join(known_keys, ", ")));
  }
}

Document::Document(const std::string& text, const std::string& file, const std::vector<std::string>& overrides) {
  const auto tree = std::make_shared<Tree>();
  tree->file = file;
  try {
    tree->root = toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    std::string what(error.description());
    std::replace(what.begin(), what.end(), '\n', ' ');
    throw InputError(position_of(file, error.source()), what, "TOML");
  }
  for (const std::string& override_text : overrides) {
    const auto equals = override_text.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw InputError(detail::position_of_override(override_text), "is no assignment", "key.path=value");
    }
    tree->overrides.push_back({override_text.substr(0, equals), override_text});
    detail::apply_override(tree->root, tree->overrides.back(), override_text.substr(equals + 1));
  }
  root_ = std::make_shared<const Table::Node>(Table::Node{tree, &tree->root, ""});
}

Document Document::read(const std::string& file, const std::vector<std::string>& overrides) {
  return Document(read_file(file), file, overrides);
}

Table Document::root(const std::vector<std::string>& known_keys) const {
  Table table(root_);
  table.reject_unknown_keys(known_keys);
  return table;
}

}  // namespace tenon::toml_file
