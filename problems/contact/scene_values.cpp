#include "tenon/problems/contact/scene_values.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "tenon/problems/contact/expression.hpp"

namespace tenon::contact {

using toml_file::Table;

SceneValues::SceneValues(const Table& root) : names_{"i"}, values_{1} {
  const auto parameters = root.table("parameters");
  if (!parameters) return;
  for (const std::string& key : parameters->keys()) {
    const Table::NumberOrText value = parameters->number_or_text(key);
    if (value.number) {
      names_.push_back(key);
      values_.push_back(*value.number);
    } else {
      words_.emplace_back(key, value.text);
    }
  }
}

double SceneValues::evaluate(const Table& table, const std::string& key, const Table::NumberOrText& value) const {
  if (value.number) return *value.number;
  try {
    const double result = Expression(value.text, names_).evaluate<double>(values_);
    if (!std::isfinite(result)) throw std::invalid_argument("expression '" + value.text + "' is not finite");
    return result;
  } catch (const std::invalid_argument& error) {
    throw InputError(table.position(key), error.what(), "a number, or an expression in the scene's parameters");
  }
}

int SceneValues::count(const Table& table) const {
  if (!table.has("count")) return 1;
  const double count = number(table, "count");
  if (!(count >= 0 && count <= 100'000 && count == std::floor(count))) {
    throw InputError(table.position("count"), fmt::format("'count' is {}", count), "an integer from 0 to 100000");
  }
  return static_cast<int>(count);
}

double SceneValues::number(const Table& table, const std::string& key) const {
  return evaluate(table, key, table.number_or_text(key));
}

std::vector<double> SceneValues::numbers(const Table& table, const std::string& key, std::size_t size) const {
  std::vector<double> list;
  for (const Table::NumberOrText& value : table.numbers_or_texts(key, size)) list.push_back(evaluate(table, key, value));
  return list;
}

std::string SceneValues::replaced(const Table& table, const std::string& key, std::string text) const {
  for (const auto& [name, word] : words_) {
    if (text == name) text = word;
  }
  for (std::size_t open; (open = text.find('{')) != std::string::npos;) {
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) throw InputError(table.position(key), "'" + text + "' lacks a '}'", "name{expression}");
    const double value = evaluate(table, key, {std::nullopt, text.substr(open + 1, close - open - 1)});
    text.replace(open, close - open + 1, std::to_string(std::lround(value)));
  }
  return text;
}

std::string SceneValues::text(const Table& table, const std::string& key) const {
  return replaced(table, key, table.text(key));
}

std::vector<std::string> SceneValues::texts(const Table& table, const std::string& key, std::size_t size) const {
  std::vector<std::string> list;
  for (const std::string& text : table.texts(key, size)) list.push_back(replaced(table, key, text));
  return list;
}

std::string SceneValues::with_values(const std::string& text) const {
  std::string out;
  for (std::size_t k = 0; k < text.size();) {
    if (!std::isalpha(static_cast<unsigned char>(text[k])) && text[k] != '_') {
      out += text[k++];
      continue;
    }
    std::size_t end = k;
    while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_')) ++end;
    std::string word = text.substr(k, end - k);
    for (std::size_t p = 0; p < names_.size(); ++p) {
      if (names_[p] == word) {
        word = fmt::format("({:.17g})", values_[p]);
        break;
      }
    }
    out += word;
    k = end;
  }
  return out;
}

}  // namespace tenon::contact
