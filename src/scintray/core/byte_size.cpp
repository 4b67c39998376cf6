#include "scintray/core/byte_size.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "scintray/core/words.hpp"

namespace scintray::core {

namespace {

constexpr Word<double> kUnits[] = {{"B", 1.0},         {"kB", 1e3},           {"MB", 1e6},
                                   {"GB", 1e9},        {"TB", 1e12},          {"KiB", 1024.0},
                                   {"MiB", 1048576.0}, {"GiB", 1073741824.0}, {"TiB", 1099511627776.0}};
constexpr double kMostBytes = 9e18;

}  // namespace

std::optional<std::uint64_t> parse_byte_size(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  while (text.starts_with(' ')) text.remove_prefix(1);
  if (number == 0.0 && text.empty()) return 0;
  const std::optional<double> unit = find_word(kUnits, text);
  if (!unit || !(number >= 0.0) || !(number * *unit < kMostBytes)) return std::nullopt;
  return static_cast<std::uint64_t>(std::round(number * *unit));
}

std::string byte_size_text(std::uint64_t bytes) {
  constexpr std::array<const char*, 4> kSteps{"B", "KiB", "MiB", "GiB"};
  double value = static_cast<double>(bytes);
  std::size_t step = 0;
  for (; value >= 1024.0 && step + 1 < kSteps.size(); ++step) value /= 1024.0;
  char text[40];
  std::snprintf(text, sizeof text, step == 0 ? "%.0f %s" : "%.1f %s", value, kSteps[step]);
  return text;
}

}  // namespace scintray::core
