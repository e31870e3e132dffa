// The values of a scene file: numbers, or expressions in its parameters; texts with {expressions} in them.
#pragma once

#include <string>
#include <vector>

#include "tenon/problems/toml/document.hpp"

namespace tenon::contact {

class SceneValues {
 public:
  /// Reads [parameters]. Throws InputError where one of them is neither a number nor text.
  explicit SceneValues(const toml_file::Table& root);

  /// The number of this copy of a table with `count`, from 1; known as i.
  void set_index(int i) { values_.front() = i; }
  /// How many copies a table stands for.
  int count(const toml_file::Table& table) const;

  double number(const toml_file::Table& table, const std::string& key) const;
  double number(const toml_file::Table& table, const std::string& key, double fallback) const {
    return table.has(key) ? number(table, key) : fallback;
  }
  std::vector<double> numbers(const toml_file::Table& table, const std::string& key, std::size_t size = 0) const;
  /// Text, or the text of the parameter that it names; {expression} becomes its integer.
  std::string text(const toml_file::Table& table, const std::string& key) const;
  std::string text(const toml_file::Table& table, const std::string& key, const std::string& fallback) const {
    return table.has(key) ? text(table, key) : fallback;
  }
  std::vector<std::string> texts(const toml_file::Table& table, const std::string& key, std::size_t size = 0) const;

  const std::vector<std::string>& names() const { return names_; }
  /// An expression with the parameters' values written into it: what is left are the given variables.
  std::string with_values(const std::string& text) const;

 private:
  double evaluate(const toml_file::Table& table, const std::string& key, const toml_file::Table::NumberOrText& value) const;
  std::string replaced(const toml_file::Table& table, const std::string& key, std::string text) const;

  std::vector<std::string> names_;  // of the parameters that are numbers, after i
  std::vector<double> values_;
  std::vector<std::pair<std::string, std::string>> words_;  // parameters that are texts
};

}  // namespace tenon::contact
