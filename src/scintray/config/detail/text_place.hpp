#pragma once
/// The place in a text where a parser stopped: its line, its key and its value.

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>

namespace scintray::config {

/// End of the string that starts at `i` (one past its closing quotes, or the end of the line or text).
std::size_t skip_string(const std::string& text, std::size_t i);
/// `text` without blanks at its ends.
std::string trimmed(const std::string& text);
/// `text` for a message, in quotes unless it begins with its own (core::in_quotes).
std::string shown(const std::string& text);
/// True when the text begins with one of `beginnings`.
bool starts_with_any(const std::string& text, std::initializer_list<const char*> beginnings);

/// The text around a place. `text` must outlive it.
class TextPlace {
 public:
  /// @param offset  of the place in bytes
  TextPlace(const std::string& text, std::size_t offset);

  std::size_t offset() const { return offset_; }
  std::size_t line_begin() const { return line_begin_; }
  /// Number of the line of an offset, from 1.
  std::size_t line_number(std::size_t at) const;
  /// The line without blanks at its ends.
  std::string line() const { return trimmed(text_.substr(line_begin_, line_end_ - line_begin_)); }
  /// The rest of the line from the place on.
  std::string rest() const { return trimmed(text_.substr(offset_, line_end_ - offset_)); }
  /// Offset of the innermost bracket that is open at the place.
  std::optional<std::size_t> open_bracket() const { return bracket_; }
  /// That bracket, or a zero character.
  char bracket() const { return bracket_ ? text_[*bracket_] : '\0'; }
  /// Key of the value at the place; empty where the value began on an earlier line.
  const std::string& key() const { return key_; }
  /// The value, or element of a list, at the place as written, and its offset.
  const std::string& item() const { return item_; }
  std::size_t item_offset() const { return item_offset_; }
  /// "key = value" for a value that replaces the one at the place; the value alone in a list.
  std::string with_value(const std::string& value) const;
  /// True when nothing but blank lines and comments stand before the line.
  bool at_start() const;

 private:
  void find_key_and_item();
  void find_end_of_item();

  const std::string& text_;
  std::size_t offset_, line_begin_ = 0, line_end_ = 0, item_offset_ = 0;
  std::optional<std::size_t> bracket_;
  std::string key_, item_;
};

}  // namespace scintray::config
