#include "tenon/problems/nl/nl_tokens.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace tenon {

namespace {

/// The solver library keeps no more of a line than this; a word beyond would be cut in two without a sign.
constexpr std::size_t kLongestLine = 78;
constexpr std::size_t kLongestName = 120;

bool is_blank(char c) {
  return c == ' ';
}

/// What may part a word from what follows: a blank, a comment, the end of the line.
bool ends_word(char c) {
  return c == ' ' || c == '\t' || c == '#' || c == '\n' || c == '\r';
}

/// As text for a message: printable, and not endless.
std::string shown(std::string_view word) {
  std::string text(word.substr(0, 24));
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return "'" + text + (word.size() > 24 ? "..." : "") + "'";
}

template <class Value>
Value from_bytes(std::string_view bytes) {
  Value value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

}  // namespace

std::string shown(char key) {
  return key > ' ' && key <= '~' ? std::string("'") + key + "'" : "byte " + std::to_string(static_cast<unsigned char>(key));
}

void NlTokens::fail(const std::string& what_is_wrong, const std::string& expected) const {
  if (binary_) throw InputError({place_.file, 0, 0}, "byte " + std::to_string(word_ + 1) + ": " + what_is_wrong, expected);
  throw InputError(place_, what_is_wrong, expected);
}

void NlTokens::begin_word() {
  word_ = next_;
  place_.line = line_;
  place_.column = static_cast<int>(next_ - line_begin_) + 1;
}

std::string_view NlTokens::take(std::size_t size, const char* what) {
  begin_word();
  if (bytes_left() < size) fail("the file ends too early", what);
  next_ += size;
  return bytes_.substr(word_, size);
}

std::string_view NlTokens::word(const char* what) {
  while (next_ < bytes_.size() && is_blank(bytes_[next_])) ++next_;
  begin_word();
  while (next_ < bytes_.size() && !ends_word(bytes_[next_])) ++next_;
  if (word_ == bytes_.size()) fail("the file ends too early", what);
  if (next_ == word_) fail("the line ends too early", what);
  if (next_ == bytes_.size()) fail("the last line has no end: the file may have been cut", "a line break after " + std::string(what));
  if (next_ - line_begin_ > kLongestLine) fail("the line is too long", "words within the first " + std::to_string(kLongestLine) + " bytes");
  return bytes_.substr(word_, next_ - word_);
}

char NlTokens::key(const char* what) {
  return take(1, what).front();
}

int NlTokens::integer(const char* what, int at_least, int at_most) {
  int value = 0;
  if (binary_) {
    value = from_bytes<std::int32_t>(take(sizeof(std::int32_t), what));
  } else {
    const std::string_view text = word(what);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) fail("found " + shown(text), what);
  }
  return within(value, what, at_least, at_most);
}

int NlTokens::short_integer(const char* what, int at_least, int at_most) {
  if (!binary_) return integer(what, at_least, at_most);
  return within(from_bytes<std::int16_t>(take(sizeof(std::int16_t), what)), what, at_least, at_most);
}

int NlTokens::operator_code(int at_most) {
  return short_operators_ ? short_integer("an operator", 0, at_most) : integer("an operator", 0, at_most);
}

int NlTokens::within(int value, const char* what, int at_least, int at_most) const {
  if (value >= at_least && value <= at_most) return value;
  const std::string range = " from " + std::to_string(at_least) + " to " + std::to_string(at_most);
  fail("found " + std::to_string(value), what + (at_least > at_most ? ", but there is none" : range));
}

double NlTokens::number(const char* what) {
  double value = 0;
  if (binary_) {
    value = from_bytes<double>(take(sizeof(double), what));
  } else {
    const std::string_view text = word(what);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) fail("found " + shown(text), what);
  }
  if (!std::isfinite(value)) fail("found a number that is not finite", what);
  return value;
}

std::string_view NlTokens::name(const char* what) {
  const std::string_view text =
      binary_ ? take(static_cast<std::size_t>(integer("the length of a name", 1, static_cast<int>(kLongestName))), what) : word(what);
  if (text.size() > kLongestName) fail("the name is too long", std::string(what) + " of at most " + std::to_string(kLongestName) + " bytes");
  return text;
}

bool NlTokens::has_word() {
  while (next_ < bytes_.size() && is_blank(bytes_[next_])) ++next_;
  return next_ < bytes_.size() && !ends_word(bytes_[next_]);
}

void NlTokens::end_line() {
  if (binary_) return;
  if (has_word()) {
    const std::string_view extra = word("the end of the line");
    fail("found " + shown(extra), "the end of the line");
  }
  begin_word();
  const std::size_t end = std::min(bytes_.find('\n', next_), bytes_.size());
  const std::string_view rest = bytes_.substr(next_, end - next_);
  const std::size_t first = rest.find_first_not_of(" \t\r");
  if (first != std::string_view::npos && rest[first] != '#') fail("found " + shown(rest.substr(first)), "the end of the line");
  if (end == bytes_.size()) fail("the last line has no end: the file may have been cut", "a line break");
  if (rest.substr(0, rest.size() - rest.ends_with('\r')).find('\r') != std::string_view::npos) {
    fail("a carriage return within the line", "line breaks as \\n or \\r\\n");
  }
  next_ = line_begin_ = end + 1;
  ++line_;
}

}  // namespace tenon
