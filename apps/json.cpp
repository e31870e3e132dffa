#include "tenon/apps/json.hpp"

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

void print(const Json& json) {
  const std::string text = json.text();
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace tenon
