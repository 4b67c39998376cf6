#include "scintray/topography/detail/readers/raw_map.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace scintray::topography {

std::optional<double> length_unit_um(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, double>, 13> kUnits{
      {{"m", 1e6},
       {"cm", 1e4},
       {"mm", 1e3},
       {"um", 1.0},
       {"~m", 1.0},         // Nanoscope
       {"\xC2\xB5m", 1.0},  // micro sign
       {"\xCE\xBCm", 1.0},  // Greek mu
       {"\xB5m", 1.0},      // Latin-1
       {"nm", 1e-3},
       {"pm", 1e-6},
       {"\xC3\x85", 1e-4},      // Angstrom
       {"\xE2\x84\xAB", 1e-4},  // Angstrom sign
       {"\xC5", 1e-4}}};
  for (const auto& [name, factor] : kUnits)
    if (unit == name) return factor;
  return std::nullopt;
}

std::optional<double> whole_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\v\f\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\v\f\r\n") - first + 1);
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

std::size_t checked_points(double columns, double rows, std::size_t bytes_there, std::size_t bytes_a_point,
                           const std::string& file) {
  const auto text = [](double value) { return std::to_string(static_cast<long long>(value)); };
  const auto sound = [](double n) { return n >= 1.0 && n <= 1e12 && n == std::floor(n); };
  if (!sound(columns) || !sound(rows))
    throw core::InputError({{file},
                            "the file states that it holds " + std::to_string(columns) + " x " +
                                std::to_string(rows) + " points; expected whole numbers from 1",
                            "the header is damaged"});
  if (columns * rows > static_cast<double>(kMostPoints))
    throw core::InputError(
        {{file},
         text(columns) + " x " + text(rows) + " points; expected at most " + std::to_string(kMostPoints),
         "crop the map"});
  const auto points = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  if (points * bytes_a_point > bytes_there)
    throw core::InputError({{file},
                            std::to_string(bytes_there) + " bytes of heights; expected at least " +
                                std::to_string(points * bytes_a_point) + " for " + text(columns) + " x " +
                                text(rows) + " points",
                            "the file is truncated, or its header does not fit the data"});
  return points;
}

void flip_rows(RawMap& map) {
  const auto row = [&](std::uint32_t j) {
    return map.values.begin() + static_cast<std::ptrdiff_t>(std::size_t{j} * map.columns);
  };
  for (std::uint32_t j = 0; j < map.rows / 2; ++j)
    std::swap_ranges(row(j), row(j) + map.columns, row(map.rows - 1 - j));
}

}  // namespace scintray::topography
