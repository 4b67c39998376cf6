#include "mutate.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace scintray::fuzz {

namespace {

std::size_t below(std::size_t n, core::Rng& rng) {
  return std::min(static_cast<std::size_t>(rng.uniform() * static_cast<double>(n)), n == 0 ? 0 : n - 1);
}

/// Replaces a run of digits by a hostile number.
void replace_number(std::string& text, core::Rng& rng) {
  constexpr std::array<std::string_view, 14> kNumbers{
      "0",       "-1",  "1", "2147483647", "4294967296", "99999999999999999999", "nan", "inf", "1e308",
      "-1e-308", "1,5", "",  "x",          "0x7fffffff"};
  const std::size_t from = below(text.size(), rng);
  const std::size_t first = text.find_first_of("0123456789", from);
  if (first == std::string::npos) return;
  const std::size_t end = std::min(text.find_first_not_of("0123456789.e+-", first), text.size());
  text.replace(first, end - first, kNumbers[below(kNumbers.size(), rng)]);
}

/// Overwrites one, two, four or eight bytes.
void overwrite(std::string& text, core::Rng& rng) {
  constexpr std::array<std::uint64_t, 10> kWords{
      0, 1, 0x7F, 0xFF, 0x7FFF, 0xFFFFFFFF, 0x7FFFFFFF, 0x80000000, 0x7FF0000000000000, 0xFFFFFFFFFFFFFFFF};
  const std::uint64_t word = kWords[below(kWords.size(), rng)];
  const std::size_t size = std::size_t{1} << below(4, rng), at = below(text.size(), rng);
  for (std::size_t k = 0; k < size && at + k < text.size(); ++k)
    text[at + k] = static_cast<char>(word >> (8 * k) & 0xFF);
}

void change(std::string& text, const std::vector<std::string>& others, core::Rng& rng) {
  if (text.empty()) text = "0";
  const std::size_t at = below(text.size(), rng), length = 1 + below(16, rng);
  switch (below(9, rng)) {
    case 0:
      text[at] = static_cast<char>(text[at] ^ 1 << below(8, rng));
      break;
    case 1:
      text[at] = static_cast<char>(below(256, rng));
      break;
    case 2:
      text.erase(at, length);
      break;
    case 3:
      text.insert(at, text.substr(at, length));
      break;
    case 4:
      text.insert(at, std::string(length, static_cast<char>(below(256, rng))));
      break;
    case 5:
      text.resize(at);
      break;
    case 6:
      overwrite(text, rng);
      break;
    case 7:
      replace_number(text, rng);
      break;
    default: {
      const std::string& other = others[below(others.size(), rng)];
      text.replace(at, length, other.substr(below(other.size(), rng), length));
    }
  }
}

}  // namespace

std::string mutated(const std::string& seed, const std::vector<std::string>& others, core::Rng& rng) {
  std::string result = seed;
  for (std::size_t changes = 1 + below(4, rng); changes > 0; --changes) change(result, others, rng);
  return result;
}

}  // namespace scintray::fuzz
