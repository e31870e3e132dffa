// A JSON value, to be written (what `--json` prints) or as it was read. Keys keep their order; a non-finite number becomes null.
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
  /// On one line, without blanks.
  std::string compact_text() const;

  /// Throws InputError with the place where the text is no JSON; `file` is the name used in messages, `expected` what should be there.
  static Json parse(const std::string& text, const std::string& file, const std::string& expected = "a JSON value");

  /// Of an object; at() throws std::invalid_argument, naming the key, where there is none.
  bool has(const std::string& key) const;
  Json at(const std::string& key) const;
  std::vector<std::string> keys() const;
  /// Of an array, else none.
  std::vector<Json> elements() const;
  bool is_null() const;
  bool is_number() const;
  bool is_text() const;
  bool is_object() const;
  /// Throw std::invalid_argument where the value is of another type, or a number not finite.
  double number() const;
  std::string as_text() const;
  Vector as_vector() const;

 private:
  std::unique_ptr<nlohmann::ordered_json> value_;
};

/// Prints the object on stdout.
void print(const Json& json);

}  // namespace tenon
