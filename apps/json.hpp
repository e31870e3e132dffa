// A JSON value: what `--json` prints, and what a dump is read from. Keys keep the order in which they were set; a non-finite number becomes null.
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

  /// Throws InputError with the place where the text is no JSON; `file` is the name used in messages.
  static Json parse(const std::string& text, const std::string& file);

  /// Of an object; throws std::invalid_argument, naming the key, where there is none.
  bool has(const std::string& key) const;
  Json at(const std::string& key) const;
  /// Throw std::invalid_argument where the value is of another type, or a number not finite.
  bool is_null() const;
  double number() const;
  std::string as_text() const;
  Vector as_vector() const;

  /// With line breaks and an indentation of 2, ending with a newline.
  std::string text() const;

 private:
  std::unique_ptr<nlohmann::ordered_json> value_;
};

/// Prints the object on stdout.
void print(const Json& json);

}  // namespace tenon
