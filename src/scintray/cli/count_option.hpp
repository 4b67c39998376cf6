#pragma once
/// Check of command-line options that count something.

#include <CLI/CLI.hpp>
#include <charconv>
#include <string>

namespace scintray::cli {

/// Most that may be counted: 1e15 photons at 1e6 a second on each of 1000 cores are 12 days.
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

}  // namespace scintray::cli
