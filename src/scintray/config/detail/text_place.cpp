#include "scintray/config/detail/text_place.hpp"

#include <algorithm>
#include <vector>

#include "scintray/core/error.hpp"

namespace scintray::config {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string shown(const std::string& text) {
  const std::string quoted = core::in_quotes(text);
  const bool own = !text.empty() && (text[0] == '"' || text[0] == '\'');
  return own ? quoted.substr(1, quoted.size() - 2) : quoted;
}

bool starts_with_any(const std::string& text, std::initializer_list<const char*> beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](const char* beginning) { return text.rfind(beginning, 0) == 0; });
}

std::size_t skip_string(const std::string& text, std::size_t i) {
  const char quote = text[i];
  const bool multiline = text.compare(i, 3, std::string(3, quote)) == 0;
  const std::string close(multiline ? 3 : 1, quote);
  i += close.size();
  while (i < text.size()) {
    if (text[i] == '\\' && quote == '"') {
      i += 2;
    } else if (text.compare(i, close.size(), close) == 0) {
      return i + close.size();
    } else if (text[i] == '\n' && !multiline) {
      return i;
    } else {
      ++i;
    }
  }
  return text.size();
}

TextPlace::TextPlace(const std::string& text, std::size_t offset)
    : text_(text), offset_(std::min(offset, text.size())) {
  const std::size_t newline = offset_ > 0 ? text_.rfind('\n', offset_ - 1) : std::string::npos;
  line_begin_ = newline == std::string::npos ? 0 : newline + 1;
  line_end_ = std::min(text_.find('\n', offset_), text_.size());
  find_key_and_item();
  find_end_of_item();
}

std::size_t TextPlace::line_number(std::size_t at) const {
  return 1 + static_cast<std::size_t>(
                 std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

std::string TextPlace::with_value(const std::string& value) const {
  return key_.empty() || bracket() == '[' ? value : key_ + " = " + value;
}

bool TextPlace::at_start() const {
  for (std::size_t begin = 0; begin < line_begin_;) {
    const std::size_t end = std::min(text_.find('\n', begin), text_.size());
    const std::string before = trimmed(text_.substr(begin, end - begin));
    if (!before.empty() && before[0] != '#') return false;
    begin = end + 1;
  }
  return !line().empty();
}

void TextPlace::find_key_and_item() {
  item_offset_ = line_begin_;
  std::vector<std::size_t> open;
  std::size_t key_begin = line_begin_;
  for (std::size_t i = 0; i < offset_; ++i) {
    const char c = text_[i];
    if (c == '"' || c == '\'') {
      i = skip_string(text_, i) - 1;
      continue;
    }
    if (c == '#') i = std::min(text_.find('\n', i), offset_);
    if (c == '[' || c == '{') open.push_back(i);
    if ((c == ']' || c == '}') && !open.empty()) open.pop_back();
    if (i < line_begin_ || i >= offset_) continue;
    if (c == '=') {
      key_ = trimmed(text_.substr(key_begin, i - key_begin));
      item_offset_ = i + 1;
    } else if (c == '[' || c == '{' || (c == ',' && !open.empty())) {
      item_offset_ = i + 1;
      if (c != '[') key_begin = i + 1;
    }
  }
  if (!open.empty()) bracket_ = open.back();
  item_offset_ = std::min(text_.find_first_not_of(" \t", item_offset_), text_.size());
}

void TextPlace::find_end_of_item() {
  const auto ends = [&](char c) { return c == '#' || (bracket_ && (c == ',' || c == ']' || c == '}')); };
  std::size_t end = item_offset_;
  while (end < line_end_ && !ends(text_[end])) {
    const bool quoted = text_[end] == '"' || text_[end] == '\'';
    end = quoted ? std::max(end + 1, skip_string(text_, end)) : end + 1;
  }
  item_ = trimmed(text_.substr(item_offset_, std::max(end, item_offset_) - item_offset_));
}

}  // namespace scintray::config
