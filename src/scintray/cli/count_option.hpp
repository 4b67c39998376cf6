#pragma once
/// Check of command-line options that count something.

#include <CLI/CLI.hpp>
#include <charconv>
#include <string>

namespace scintray::cli {

/// Check that an option's value is a number above zero; otherwise a usage error that names the value.
inline CLI::Validator above_zero() {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0.0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = status == std::errc{} && end == text.data() + text.size();
    return whole && value > 0.0 ? "" : "\"" + text + "\" is not a number above 0";
  };
  return {check, "ABOVE 0"};
}

}  // namespace scintray::cli
