/// Height maps as text: Gwyddion's export, optical profilers' matrix, and bare numbers.

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "scintray/core/error.hpp"
#include "scintray/topography/raw_map.hpp"

namespace scintray {

namespace {

/// Splits a text into lines and knows their numbers.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  /// The next line without its end; nothing after the last.
  std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }

  long number() const { return number_; }

 private:
  std::string_view rest_;
  long number_ = 0;
};

constexpr std::string_view kBlanks = " \t\v\f";

/// Appends the numbers of one line; returns how many there were.
std::uint32_t read_row(std::string_view line, const FileLocation& line_place, std::vector<double>& values) {
  std::uint32_t count = 0;
  std::size_t at = line.find_first_not_of(kBlanks);
  while (at != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    const std::string_view word = line.substr(at, end - at);
    const auto value = whole_number(word);
    if (!value) {
      FileLocation place = line_place;
      place.column = static_cast<long>(at) + 1;
      throw InputError({place, "found \"" + std::string(word.substr(0, 40)) + "\"; expected a number",
                        word.find(',') != std::string_view::npos
                            ? "write decimal points, and blanks between numbers"
                            : "numbers are separated by blanks"});
    }
    values.push_back(*value);
    ++count;
    at = line.find_first_not_of(kBlanks, end);
  }
  return count;
}

/// Reads rows of equal length until the end of the text. `first` is a line already taken.
void read_matrix(Lines& lines, std::optional<std::string_view> first, const std::string& file, RawMap& map) {
  for (auto line = first; line; line = lines.next()) {
    if (trimmed(*line).empty()) continue;
    const FileLocation place{file, lines.number()};
    const std::uint32_t count = read_row(*line, place, map.values);
    if (map.rows == 0) map.columns = count;
    if (count != map.columns)
      throw InputError({place,
                        "row with " + std::to_string(count) + " numbers; expected " +
                            std::to_string(map.columns) + " as in the rows before",
                        "the file is truncated, or is no height map"});
    ++map.rows;
  }
}

/// "12.34 um" in um; InputError when it is no length.
double length_um(std::string_view text, const FileLocation& place) {
  text = trimmed(text);
  const std::size_t gap = text.find_first_of(kBlanks);
  const auto value = whole_number(text.substr(0, gap));
  const auto unit = gap == std::string_view::npos ? std::nullopt : length_unit_um(trimmed(text.substr(gap)));
  if (!value || !unit || !(*value > 0.0) || !std::isfinite(*value * *unit))
    throw InputError({place, "found \"" + std::string(text) + "\"; expected a positive length with its unit",
                      "for example 90 um, with a decimal point"});
  return *value * *unit;
}

struct GwyddionHeader {
  std::optional<double> width_um, height_um;
};

/// One "# Key: value" line of Gwyddion's text export, in English or German.
void read_gwyddion_line(std::string_view line, const FileLocation& place, RawMap& map,
                        GwyddionHeader& header) {
  line.remove_prefix(1);
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return;  // a comment
  const std::string_view key = trimmed(line.substr(0, colon)), value = trimmed(line.substr(colon + 1));
  if (key == "Channel" || key == "Kanal") map.title = std::string(value);
  if (key == "Width" || key == "Breite") header.width_um = length_um(value, place);
  if (key == "Height" || key == "H\xC3\xB6he" || key == "H\xF6he") header.height_um = length_um(value, place);
  if (key == "Value units" || key == "Werteinheiten" || key == "Wert-Einheiten")
    map.height_unit_um = length_unit_um(value);
}

RawMap parse_commented_matrix(std::string_view content, const std::string& file) {
  Lines lines(content);
  RawMap map;
  map.format = "text matrix";
  GwyddionHeader header;
  auto line = lines.next();
  for (; line && (line->starts_with('#') || trimmed(*line).empty()); line = lines.next())
    if (line->starts_with('#')) read_gwyddion_line(*line, {file, lines.number()}, map, header);
  read_matrix(lines, line, file, map);
  if (map.rows == 0) throw InputError({{file}, "no numbers; expected a height map", ""});
  if (header.width_um) map.pitch_x_um = *header.width_um / map.columns;
  if (header.height_um) map.pitch_y_um = *header.height_um / map.rows;
  if (header.width_um || header.height_um || map.height_unit_um) map.format = "Gwyddion text export";
  return map;
}

/// Number behind `key=` in `line`.
double keyed_number(std::string_view line, std::string_view key, const FileLocation& place) {
  const std::size_t at = line.find(key);
  if (at != std::string_view::npos) {
    std::string_view text = line.substr(at + key.size());
    text = text.substr(0, text.find_first_of(kBlanks));
    if (const auto value = whole_number(text); value && *value > 0.0 && std::isfinite(*value)) return *value;
  }
  throw InputError(
      {place,
       "found \"" + std::string(line.substr(0, 80)) + "\"; expected \"" + std::string(key) +
           "\" and a positive number",
       "a profiler's matrix starts with h= w=, pixel size=, data unit=, height conversion factor (-> m)="});
}

RawMap parse_profiler(std::string_view content, const std::string& file) {
  Lines lines(content);
  const auto header = [&] { return lines.next().value_or(std::string_view{}); };
  RawMap map;
  map.format = "optical profiler matrix";
  const std::string_view sizes = header();
  const double rows = keyed_number(sizes, "h=", {file, lines.number()});
  const double columns = keyed_number(sizes, "w=", {file, lines.number()});
  const std::string_view pixel = header();
  const double size = keyed_number(pixel, "pixel size=", {file, lines.number()});
  const auto unit = length_unit_um(trimmed(pixel.substr(pixel.find_last_of(kBlanks) + 1)));
  if (!unit) throw InputError({{file, lines.number()}, "pixel size without a length unit", ""});
  map.pitch_x_um = map.pitch_y_um = size * *unit;
  header();  // the unit of the data, which the conversion factor takes to metres
  const std::string_view factor = header();
  map.height_unit_um = keyed_number(factor, "height conversion factor (-> m)=", {file, lines.number()}) * 1e6;
  read_matrix(lines, lines.next(), file, map);
  if (map.rows != rows || map.columns != columns)
    throw InputError({{file},
                      std::to_string(map.columns) + " x " + std::to_string(map.rows) +
                          " points; the header says " + std::to_string(static_cast<long>(columns)) + " x " +
                          std::to_string(static_cast<long>(rows)),
                      "the file is truncated"});
  return map;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\v\f\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\v\f\r\n") - first + 1);
}

std::optional<double> whole_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

std::optional<double> length_unit_um(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, double>, 11> kUnits{{{"m", 1e6},
                                                                        {"cm", 1e4},
                                                                        {"mm", 1e3},
                                                                        {"um", 1.0},
                                                                        {"\xC2\xB5m", 1.0},  // micro sign
                                                                        {"\xCE\xBCm", 1.0},  // Greek mu
                                                                        {"\xB5m", 1.0},      // Latin-1
                                                                        {"nm", 1e-3},
                                                                        {"pm", 1e-6},
                                                                        {"\xC3\x85", 1e-4},  // Angstrom
                                                                        {"\xC5", 1e-4}}};
  for (const auto& [name, factor] : kUnits)
    if (unit == name) return factor;
  return std::nullopt;
}

RawMap parse_text_map(std::string_view content, const std::string& file) {
  return trimmed(content).starts_with("h=") ? parse_profiler(content, file)
                                            : parse_commented_matrix(content, file);
}

}  // namespace scintray
