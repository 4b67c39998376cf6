#include "scintray/report/text/format.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace scintray::report {

namespace {

/// Decimals that show two significant digits of `error`.
int decimals_of(double error) {
  if (!(error > 0.0) || !std::isfinite(error)) return 4;
  const int decimals = 1 - static_cast<int>(std::floor(std::log10(error)));
  return std::clamp(decimals, 0, 12);
}

}  // namespace

std::string fate_text(core::Fate fate) {
  std::string name = fate == core::Fate::not_detected ? "not detected" : core::fate_name(fate);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string escape_html(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string fixed(double value, int decimals) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

std::string with_error(const core::Estimate& estimate) {
  const int decimals = decimals_of(estimate.error);
  return fixed(estimate.value, decimals) + " ± " + fixed(estimate.error, decimals);
}

std::string with_errors(double value, double low, double high) {
  const int decimals = decimals_of(std::min(value - low, high - value));
  return fixed(value, decimals) + " +" + fixed(high - value, decimals) + " −" + fixed(value - low, decimals);
}

std::string percent_with_error(const core::Estimate& estimate) {
  return with_error({100.0 * estimate.value, 100.0 * estimate.error}) + " %";
}

std::string grouped(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, " ");  // thin space
  return digits;
}

std::string compact(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

std::size_t display_width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string aligned(const std::vector<std::vector<std::string>>& table) {
  std::vector<std::size_t> widths;
  for (const auto& row : table) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], display_width(row[i]));
  }
  std::string text;
  for (const auto& row : table) {
    text += "  ";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - display_width(row[i]), ' ');
      text += (i == 0 ? row[i] + padding : "   " + padding + row[i]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

}  // namespace scintray::report
