// A JSON value, to be written (what `--json` prints) or as it was read. Keys keep their order; a non-finite number becomes null.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tenon/core/eigen.hpp"
#include "tenon/core/input_error.hpp"

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

  /// Parses a text that begins at that position. Throws InputError with the place where it is no JSON.
  static Json parse(std::string_view text, const InputPosition& begin);

  bool is_object() const;
  bool is_array() const;
  bool is_number() const;
  /// Of a string, else nothing.
  std::optional<std::string> string() const;
  /// Of an object, else none and false.
  std::vector<std::string> keys() const;
  bool has(const std::string& key) const;
  /// The value under a key, null where an object has none.
  Json operator[](const std::string& key) const;
  /// The number under a key, nothing where there is none.
  std::optional<double> number(const std::string& key) const;
  /// Of an array, else none.
  std::vector<Json> elements() const;

 private:
  std::unique_ptr<nlohmann::ordered_json> value_;
};

/// Prints the object on stdout.
void print(const Json& json);

}  // namespace tenon
