// A JSON value to be written: what `--json` prints. Keys keep the order in which they were set; a non-finite number becomes null.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tenon/core/eigen.hpp"

namespace tenon {

class Json {
 public:
  static Json object();
  static Json array();

  Json(double value);
  Json(int value);
  Json(long value);
  Json(bool value);
  Json(std::string_view text);
  Json(const std::string& text);
  Json(const char* text);
  Json(const Vector& values);
  Json(const std::vector<double>& values);
  Json(const std::vector<std::string>& texts);
  Json(const Json& other);
  Json(Json&&) noexcept;
  Json& operator=(Json other) noexcept;
  ~Json();

  /// Of an object.
  Json& set(const std::string& key, const Json& value);
  /// Of an array.
  Json& push(const Json& value);

  /// With line breaks and an indentation of 2, ending with a newline.
  std::string text() const;

 private:
  std::unique_ptr<nlohmann::ordered_json> value_;
};

/// Prints the object on stdout.
void print(const Json& json);

}  // namespace tenon
