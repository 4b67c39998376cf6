#include "scintray/tables/number_text.hpp"

#include <charconv>
#include <cmath>
#include <optional>

#include "scintray/core/error.hpp"
#include "scintray/core/input_file.hpp"
#include "scintray/core/zlib_stream.hpp"

namespace scintray::tables {

namespace {

/// Most bytes of text that one number may take, white space included. Double precision needs 24.
constexpr std::size_t kBytesPerNumber = 32;

std::size_t most_bytes(NumberCount count) { return (count.most + 64) * kBytesPerNumber; }

[[noreturn]] void refuse(const std::string& file, const std::string& what, const std::string& hint) {
  throw core::InputError({{file}, what, hint});
}

constexpr const char* kDamaged = "the file is truncated or damaged, or of another kind; fetch it again";

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// Reads text piece by piece; a number may be split by the end of a piece.
class NumberList {
 public:
  NumberList(const std::string& file, NumberCount count) : file_(file), count_(count) {}

  void feed(std::string_view text) {
    std::size_t at = 0;
    while (at < text.size()) {
      if (is_space(text[at])) {
        end_word();
        ++at;
        continue;
      }
      std::size_t end = at;
      while (end < text.size() && !is_space(text[end])) ++end;
      if (end < text.size() && word_.empty()) {
        add(text.substr(at, end - at));
      } else {
        if (word_.size() + (end - at) > kLongestWord) not_a_number(text.substr(at, kLongestWord));
        word_ += text.substr(at, end - at);
      }
      at = end;
    }
  }

  std::vector<float> finish() {
    end_word();
    if (numbers_.size() < count_.least)
      refuse(file_, std::to_string(numbers_.size()) + " numbers; expected " + std::to_string(count_.least),
             kDamaged);
    return std::move(numbers_);
  }

 private:
  static constexpr std::size_t kLongestWord = 512;

  void end_word() {
    if (word_.empty()) return;
    add(word_);
    word_.clear();
  }

  void add(std::string_view word) {
    if (numbers_.size() == count_.most)
      refuse(file_, "more than " + std::to_string(count_.most) + " numbers; expected no more",
             "the file is of another kind, or two were joined");
    std::string_view digits = word;
    if (digits.size() > 1 && digits.front() == '+' && digits[1] != '-') digits.remove_prefix(1);
    float value = 0.0f;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (end != digits.data() + digits.size() || error == std::errc::invalid_argument) not_a_number(word);
    // Too small for single precision is zero; too large is not a measured value.
    if (error == std::errc::result_out_of_range) value = underflows(digits) ? 0.0f : HUGE_VALF;
    if (!std::isfinite(value)) not_a_number(word);
    numbers_.push_back(value);
  }

  static bool underflows(std::string_view digits) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc{} && std::abs(value) < 1.0;
  }

  [[noreturn]] void not_a_number(std::string_view word) const {
    std::string shown(word.substr(0, 24));
    for (char& c : shown)
      if (c < ' ' || c > '~') c = '?';
    refuse(file_,
           "\"" + shown + "\" as number " + std::to_string(numbers_.size() + 1) +
               "; expected a finite number within single precision",
           kDamaged);
  }

  const std::string& file_;
  NumberCount count_;
  std::vector<float> numbers_;
  std::string word_;
};

/// The two bytes that begin a zlib stream (RFC 1950, section 2.2). A text may begin with "80", which would
/// be valid for a window of 2 KiB, so that one is excluded.
bool is_zlib(std::string_view content) {
  if (content.size() < 2) return false;
  const auto first = static_cast<unsigned char>(content[0]), second = static_cast<unsigned char>(content[1]);
  return (first & 15) == 8 && first < 0x80 && first != '8' && (first * 256 + second) % 31 == 0;
}

void inflate_into(NumberList& list, std::string_view packed, const std::string& file, std::size_t limit) {
  std::size_t bytes = 0;
  const core::Unpacked end = core::unpack(packed, core::Packing::zlib, [&](std::string_view part) {
    bytes += part.size();
    if (bytes > limit)
      refuse(file,
             "a zlib stream that unpacks to more than " + std::to_string(limit) +
                 " bytes; expected at most that for as many numbers as the format has",
             "the file is of another kind, or made to harm");
    list.feed(part);
  });
  if (!end.complete) refuse(file, "a damaged or truncated zlib stream", kDamaged);
  if (end.bytes_after > 0)
    refuse(file, std::to_string(end.bytes_after) + " bytes after the end of the zlib stream; expected none",
           "pack one file only");
}

}  // namespace

std::vector<float> parse_numbers(std::string_view content, const std::string& file, NumberCount count) {
  if (content.starts_with("\x1f\x8b"))
    refuse(file, "gzip data; expected text or a zlib stream, which is what Geant4 reads",
           "unpack it with gunzip");
  if (content.size() > most_bytes(count))
    refuse(file,
           std::to_string(content.size()) + " bytes; expected at most " + std::to_string(most_bytes(count)),
           "the file is of another kind");
  NumberList list(file, count);
  if (is_zlib(content))
    inflate_into(list, content, file, most_bytes(count));
  else
    list.feed(content);
  return list.finish();
}

std::string load_number_file(const std::filesystem::path& path, NumberCount count) {
  std::error_code error;
  const bool regular = std::filesystem::is_regular_file(path, error);
  const auto size = regular ? std::filesystem::file_size(path, error) : 0;
  if (!regular || error) refuse(path.string(), "no such file, or not one that can be read", "check the name");
  if (size > most_bytes(count))
    refuse(path.string(),
           std::to_string(size) + " bytes; expected at most " + std::to_string(most_bytes(count)),
           "the file is of another kind");
  std::optional<std::string> content = core::read_whole_file(path);
  if (!content) throw core::SystemError(path.string() + ": cannot read");
  return *std::move(content);
}

}  // namespace scintray::tables
