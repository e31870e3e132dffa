// The words of a .nl file, text or binary, with the place of each for errors.
//
// A text file is lines: a key (one letter or digit) where the grammar has one, then numbers parted by blanks, then perhaps a comment. In a
// binary file the same keys and numbers follow one another as bytes: integers of 4 (short ones of 2), numbers of 8, little end first.
// Either way every file begins with ten lines of text. Source: D. M. Gay, Writing .nl Files, Sandia report 2005-7907P.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "tenon/core/input_error.hpp"

namespace tenon {

/// A key as a message shows it.
std::string shown(char key);

class NlTokens {
 public:
  /// Refers to the bytes, which must outlive this; `file` is the name used in messages.
  NlTokens(std::string_view bytes, const std::string& file) : bytes_(bytes), place_{file, 1, 1} {}

  /// From here on the file is binary; one kind writes operators as short integers.
  void begin_binary(bool short_operators) { binary_ = true, short_operators_ = short_operators; }
  bool is_binary() const { return binary_; }
  bool has_short_operators() const { return short_operators_; }

  /// Where the next byte stands in the file, from 0.
  std::size_t offset() const { return next_; }

  /// Whether nothing follows but the end of the file; asked between two lines.
  bool at_end() const { return next_ == bytes_.size(); }
  /// How many bytes follow: nothing longer than that can.
  std::size_t bytes_left() const { return bytes_.size() - next_; }

  /// Each reads one word and throws InputError where it is not there or not what it should be; `what` names it in the message.
  char key(const char* what);
  int integer(const char* what, int at_least, int at_most);
  int short_integer(const char* what, int at_least, int at_most);
  int operator_code(int at_most);
  double number(const char* what);  // finite
  std::string_view name(const char* what);

  /// Whether the line has one more word; text only.
  bool has_word();
  /// The end of a line: nothing but a comment may follow. In a binary file there are no lines.
  void end_line();

  /// Throws InputError at the word read last.
  [[noreturn]] void fail(const std::string& what_is_wrong, const std::string& expected = "") const;

 private:
  void begin_word();
  std::string_view word(const char* what);
  int within(int value, const char* what, int at_least, int at_most) const;
  std::string_view take(std::size_t size, const char* what);

  std::string_view bytes_;
  bool binary_ = false, short_operators_ = false;
  std::size_t next_ = 0;        // the byte that comes next
  std::size_t line_begin_ = 0;  // the first byte of this line
  int line_ = 1;

  std::size_t word_ = 0;  // the first byte of the word read last
  InputPosition place_;   // of that word
};

}  // namespace tenon
