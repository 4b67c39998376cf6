#pragma once
/// Check of command-line options that count something.

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

namespace scintray::cli {

/// Largest count: 1e15 photons at 1e6 per second on each of 1000 cores take 12 days.
inline constexpr double kMostCounted = 1e15;

/// Check that an option's value is a number above zero, and no more than kMostCounted; otherwise a usage
/// error that names the value.
inline CLI::Validator above_zero() {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0.0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = status == std::errc{} && end == text.data() + text.size();
    if (!whole || !(value > 0.0)) return "\"" + text + "\" is not a number above 0";
    return value <= kMostCounted ? "" : "\"" + text + "\" is more than 1e15, which no run would end";
  };
  return {check, "ABOVE 0"};
}

/// Check that an option's value is a whole number above zero, and no more than kMostCounted. It may be
/// written as in scene files and with an exponent: 400_000, 4e5.
inline CLI::Validator whole_count() {
  const auto convert = [](std::string& text) -> std::string {
    std::string digits;
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] != '_' || i == 0 || i + 1 == text.size() || text[i - 1] == '_') digits += text[i];
    if (std::string problem = above_zero()(digits); !problem.empty()) return problem;
    double value = 0.0;
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (value != std::floor(value)) return "\"" + text + "\" is not a whole number";
    text = std::to_string(static_cast<std::uint64_t>(value));
    return {};
  };
  return {convert, "COUNT"};
}

}  // namespace scintray::cli
