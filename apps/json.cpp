#include "tenon/apps/json.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

namespace tenon {

using nlohmann::ordered_json;

Json Json::object() {
  Json json(0);
  *json.value_ = ordered_json::object();
  return json;
}

Json Json::array() {
  Json json(0);
  *json.value_ = ordered_json::array();
  return json;
}

Json::Json(double value) : value_(std::make_unique<ordered_json>(value)) {}
Json::Json(int value) : value_(std::make_unique<ordered_json>(value)) {}
Json::Json(long value) : value_(std::make_unique<ordered_json>(value)) {}
Json::Json(bool value) : value_(std::make_unique<ordered_json>(value)) {}
Json::Json(std::string_view text) : value_(std::make_unique<ordered_json>(std::string(text))) {}
Json::Json(const std::string& text) : value_(std::make_unique<ordered_json>(text)) {}
Json::Json(const char* text) : value_(std::make_unique<ordered_json>(text)) {}
Json::Json(const Vector& values) : value_(std::make_unique<ordered_json>(ordered_json::array())) {
  for (const double v : values) value_->push_back(v);
}
Json::Json(const std::vector<double>& values) : value_(std::make_unique<ordered_json>(values)) {}
Json::Json(const std::vector<std::string>& texts) : value_(std::make_unique<ordered_json>(texts)) {}
Json::Json(const Json& other) : value_(std::make_unique<ordered_json>(*other.value_)) {}
Json::Json(Json&&) noexcept = default;
Json& Json::operator=(Json other) noexcept {
  std::swap(value_, other.value_);
  return *this;
}
Json::~Json() = default;

Json& Json::set(const std::string& key, const Json& value) {
  (*value_)[key] = *value.value_;
  return *this;
}

Json& Json::push(const Json& value) {
  value_->push_back(*value.value_);
  return *this;
}

std::string Json::text() const {
  return value_->dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string Json::compact_text() const {
  return value_->dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

Json Json::parse(std::string_view text, const InputPosition& begin) {
  Json json(0);
  try {
    *json.value_ = ordered_json::parse(text);
  } catch (const ordered_json::parse_error& error) {
    const std::string_view before = text.substr(0, error.byte > 0 ? error.byte - 1 : 0);
    const auto lines = static_cast<int>(std::count(before.begin(), before.end(), '\n'));
    const std::size_t line_begin = lines == 0 ? 0 : before.rfind('\n') + 1;
    throw InputError({begin.file, std::max(1, begin.line) + lines, static_cast<int>(before.size() - line_begin) + 1}, "this is no JSON",
                     "an object with keys in double quotes");
  }
  return json;
}

bool Json::is_object() const { return value_->is_object(); }
bool Json::is_array() const { return value_->is_array(); }
bool Json::is_number() const { return value_->is_number(); }

std::optional<std::string> Json::string() const {
  return value_->is_string() ? std::optional(value_->get<std::string>()) : std::nullopt;
}

std::vector<std::string> Json::keys() const {
  std::vector<std::string> keys;
  if (!is_object()) return keys;
  for (const auto& [key, value] : value_->items()) keys.push_back(key);
  return keys;
}

bool Json::has(const std::string& key) const { return value_->contains(key); }

Json Json::operator[](const std::string& key) const {
  Json json(0);
  *json.value_ = has(key) ? value_->at(key) : ordered_json();
  return json;
}

std::optional<double> Json::number(const std::string& key) const {
  if (!has(key) || !value_->at(key).is_number()) return std::nullopt;
  return value_->at(key).get<double>();
}

std::vector<Json> Json::elements() const {
  std::vector<Json> list;
  if (!is_array()) return list;
  for (const ordered_json& element : *value_) {
    list.emplace_back(0);
    *list.back().value_ = element;
  }
  return list;
}

void print(const Json& json) {
  const std::string text = json.text();
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace tenon
