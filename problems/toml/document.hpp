// A TOML file with typed access, and errors that say where.
//
// Every table is asked for together with the keys it may have, so that a key nobody knows is an error with the nearest known one named,
// before anything else is read. Numbers must be finite: "no limit" is said by leaving a key out. `--set key.path=value` overrides one
// value; elements of an array count from 1, as in rotor.3.spin. An error in an overridden value names the override, not the file.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tenon/core/eigen.hpp"
#include "tenon/core/input_error.hpp"

namespace tenon::toml_file {

/// A view of one table; it shares the document that it looks into. Getters throw InputError where the value has another type, is not
/// finite or, where no fallback is given, is not there.
class Table {
 public:
  bool has(const std::string& key) const;
  std::vector<std::string> keys() const;

  double number(const std::string& key) const;
  double number(const std::string& key, double fallback) const { return has(key) ? number(key) : fallback; }
  int integer(const std::string& key) const;
  int integer(const std::string& key, int fallback) const { return has(key) ? integer(key) : fallback; }
  bool flag(const std::string& key) const;
  bool flag(const std::string& key, bool fallback) const { return has(key) ? flag(key) : fallback; }
  std::string text(const std::string& key) const;
  std::string text(const std::string& key, const std::string& fallback) const { return has(key) ? text(key) : fallback; }
  Eigen::Vector3d vector3(const std::string& key) const;
  Eigen::Vector3d vector3(const std::string& key, const Eigen::Vector3d& fallback) const { return has(key) ? vector3(key) : fallback; }
  /// A list of numbers of any length; of exactly `size` where that is not 0.
  std::vector<double> numbers(const std::string& key, std::size_t size = 0) const;

  /// A number, or text that stands for one: what a reader evaluates itself.
  struct NumberOrText {
    std::optional<double> number;
    std::string text;
  };
  NumberOrText number_or_text(const std::string& key) const;
  /// A list of them, of any length; of exactly `size` where that is not 0.
  std::vector<NumberOrText> numbers_or_texts(const std::string& key, std::size_t size = 0) const;
  /// A list of texts, of exactly `size` where that is not 0.
  std::vector<std::string> texts(const std::string& key, std::size_t size = 0) const;

  /// The table under a key, nothing where there is none. With no known keys given, any key goes.
  std::optional<Table> table(const std::string& key, const std::vector<std::string>& known_keys = {}) const;
  /// The [[key]] tables in the order of the file, none where there are none.
  std::vector<Table> tables(const std::string& key, const std::vector<std::string>& known_keys = {}) const;

  /// Where the value of a key stands (the table itself where it has no such key), for errors of meaning.
  InputPosition position(const std::string& key = "") const;
  /// The path of this table, as in --set: "" for the root, else "rotor.3".
  const std::string& path() const;

 private:
  friend class Document;
  struct Node;
  explicit Table(std::shared_ptr<const Node> node) : node_(std::move(node)) {}
  void reject_unknown_keys(const std::vector<std::string>& known_keys) const;

  std::shared_ptr<const Node> node_;
};

class Document {
 public:
  /// Parses `text`; `file` is the name used in messages, `overrides` are "key.path=value". Throws InputError.
  Document(const std::string& text, const std::string& file, const std::vector<std::string>& overrides = {});
  /// The same from a file.
  static Document read(const std::string& file, const std::vector<std::string>& overrides = {});

  /// The root table; throws InputError where it has a key that is not known.
  Table root(const std::vector<std::string>& known_keys) const;

 private:
  std::shared_ptr<const Table::Node> root_;
};

}  // namespace tenon::toml_file
