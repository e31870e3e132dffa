#include "tenon/apps/json.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "tenon/core/input_error.hpp"

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

Json Json::parse(const std::string& text, const std::string& file, const std::string& expected) {
  try {
    Json json(0);
    *json.value_ = ordered_json::parse(text);
    return json;
  } catch (const ordered_json::parse_error& error) {
    const std::size_t at = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
    const std::string before = text.substr(0, at);
    const auto line = static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1;
    const auto column = static_cast<int>(at - (before.rfind('\n') + 1)) + 1;
    throw InputError({file, line, column}, "this is no JSON", expected);
  } catch (const ordered_json::exception&) {  // a number out of range
    throw InputError({file, 0, 0}, "a number beyond double precision", expected);
  }
}

bool Json::has(const std::string& key) const {
  return value_->is_object() && value_->contains(key);
}

Json Json::at(const std::string& key) const {
  if (!has(key)) throw std::invalid_argument("the key '" + key + "' is missing");
  Json json(0);
  *json.value_ = (*value_)[key];
  return json;
}

std::vector<std::string> Json::keys() const {
  std::vector<std::string> keys;
  if (!is_object()) return keys;
  for (const auto& [key, value] : value_->items()) keys.push_back(key);
  return keys;
}

std::vector<Json> Json::elements() const {
  std::vector<Json> list;
  if (!value_->is_array()) return list;
  for (const ordered_json& element : *value_) {
    list.emplace_back(0);
    *list.back().value_ = element;
  }
  return list;
}

bool Json::is_null() const {
  return value_->is_null();
}
bool Json::is_number() const {
  return value_->is_number();
}
bool Json::is_text() const {
  return value_->is_string();
}
bool Json::is_object() const {
  return value_->is_object();
}

double Json::number() const {
  if (!value_->is_number()) throw std::invalid_argument("a number is missing where " + value_->dump().substr(0, 40) + " stands");
  const auto value = value_->get<double>();
  if (!std::isfinite(value)) throw std::invalid_argument("a number is not finite");
  return value;
}

std::string Json::as_text() const {
  if (!value_->is_string()) throw std::invalid_argument("a text is missing where " + value_->dump().substr(0, 40) + " stands");
  return value_->get<std::string>();
}

Vector Json::as_vector() const {
  if (!value_->is_array()) throw std::invalid_argument("a list is missing where " + value_->dump().substr(0, 40) + " stands");
  Vector values(static_cast<Eigen::Index>(value_->size()));
  Json entry(0);
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    *entry.value_ = (*value_)[static_cast<std::size_t>(k)];
    values[k] = entry.number();
  }
  return values;
}

void print(const Json& json) {
  const std::string text = json.text();
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace tenon
