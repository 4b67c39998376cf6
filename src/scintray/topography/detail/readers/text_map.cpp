/// Height maps as text: Gwyddion's export, optical profilers' matrix, and bare numbers.

#include <algorithm>
#include <cmath>
#include <sstream>

#include "scintray/core/error.hpp"
#include "scintray/topography/detail/readers/channels.hpp"
#include "scintray/topography/detail/readers/formats.hpp"
#include "scintray/topography/detail/readers/lines.hpp"

namespace scintray::topography {

namespace {

constexpr double kTolerance = 0.01;

/// Equally spaced positions along one axis.
struct GridAxis {
  double first = 0.0, step = 0.0;
  double count = 0.0;  ///< whole; beyond kMostPoints when the points do not lie on a grid

  /// Index of the position next to `value`.
  std::size_t index(double value) const {
    return static_cast<std::size_t>(std::lround((value - first) / step));
  }
  bool holds(double value) const {
    const double at = (value - first) / step;
    return std::abs(at - std::round(at)) <= kTolerance;
  }
};

/// The grid of sorted positions; the step is the mean over the gaps that are not rounding.
GridAxis axis_of(std::vector<double> positions) {
  std::sort(positions.begin(), positions.end());
  GridAxis axis{positions.front(), 0.0, 1.0};
  const double range = positions.back() - positions.front();
  // A point's digits may differ from row to row, but by far less than a grid's step.
  const double rounding = 1e-6 * range;
  double smallest = range;
  for (std::size_t k = 1; k < positions.size(); ++k)
    if (const double gap = positions[k] - positions[k - 1]; gap > rounding)
      smallest = std::min(smallest, gap);
  if (!(smallest > 0.0) || !std::isfinite(range)) return axis;
  axis.count = std::round(range / smallest) + 1.0;
  axis.step = range / (axis.count - 1.0);
  return axis;
}

/// True for a matrix of numbers with three columns and at least four rows: no height map is as
/// narrow.
bool is_xyz_list(const RawMap& matrix) { return matrix.columns == 3 && matrix.rows >= 4; }

/// The height map of a list of points in any order; points of the grid that the list lacks are
/// NaN. x and y have no unit, so only the ratio of the pitches is known. InputError unless the
/// points lie, within 1 % of its step, on a regular grid of which they fill at least half.
/// @param values x y z, x y z, ...
RawMap grid_of_xyz(const std::vector<double>& values, const std::string& file) {
  const std::size_t points = values.size() / 3;
  std::vector<double> xs, ys;
  for (std::size_t k = 0; k < points; ++k) {
    xs.push_back(values[3 * k]);
    ys.push_back(values[3 * k + 1]);
  }
  const auto finite = [](double v) { return std::isfinite(v); };
  const bool sound = std::all_of(xs.begin(), xs.end(), finite) && std::all_of(ys.begin(), ys.end(), finite);
  const GridAxis x = sound ? axis_of(xs) : GridAxis(), y = sound ? axis_of(ys) : GridAxis();
  const auto refuse = [&](const std::string& what) {
    throw core::InputError(
        {{file},
         "three numbers a line, read as x y z, " + what + "; expected points of a regular grid",
         "put them on a grid in Gwyddion (Rasterize) and save that as .gsf"});
  };
  if (!(x.step > 0.0) || !(y.step > 0.0) || !std::isfinite(y.step / x.step)) refuse("do not span a plane");
  if (x.count * y.count > 2.0 * static_cast<double>(points)) refuse("fill less than half of their grid");
  RawMap map;
  map.format = "x y z list";
  map.columns = static_cast<std::uint32_t>(x.count);
  map.rows = static_cast<std::uint32_t>(y.count);
  map.pitch_ratio = y.step / x.step;
  map.values.assign(std::size_t{map.columns} * map.rows, std::nan(""));
  std::vector<bool> taken(map.values.size(), false);
  for (std::size_t k = 0; k < points; ++k) {
    if (!x.holds(xs[k]) || !y.holds(ys[k])) refuse("do not lie at equal distances");
    // y points up, and the first row is the top one.
    const std::size_t at = (map.rows - 1 - y.index(ys[k])) * map.columns + x.index(xs[k]);
    if (taken[at]) refuse("contain a point twice (number " + std::to_string(k + 1) + ")");
    taken[at] = true;
    map.values[at] = values[3 * k + 2];
  }
  return map;
}

constexpr std::string_view kBlanks = " \t\v\f;", kByteOrderMark = "\xEF\xBB\xBF";

/// Treatment of a locale's decimal comma.
enum class Comma { refused, decimal };

std::optional<double> number_of(std::string_view word, Comma comma) {
  const auto value = whole_number(word);
  const std::size_t at = word.find(',');
  if (value || comma == Comma::refused || at == std::string_view::npos) return value;
  std::string with_point(word);
  with_point[at] = '.';
  return whole_number(with_point);
}

/// Appends the numbers of one line; returns how many there were.
std::uint32_t read_row(std::string_view line, const core::FileLocation& line_place, Comma comma,
                       std::vector<double>& values) {
  std::uint32_t count = 0;
  std::size_t at = line.find_first_not_of(kBlanks);
  while (at != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    const std::string_view word = line.substr(at, end - at);
    const auto value = number_of(word, comma);
    if (!value) {
      core::FileLocation place = line_place;
      place.column = static_cast<long>(at) + 1;
      throw core::InputError({place, "found " + core::in_quotes(word) + "; expected a number",
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

/// Reads rows of equal length until the end of the text. `first` is a line already read.
void read_matrix(Lines& lines, std::optional<std::string_view> first, const std::string& file, Comma comma,
                 RawMap& map) {
  for (auto line = first; line; line = lines.next()) {
    if (trimmed(*line).empty()) continue;
    const core::FileLocation place{file, lines.number()};
    const std::uint32_t count = read_row(*line, place, comma, map.values);
    if (map.rows == 0) map.columns = count;
    if (count != map.columns)
      throw core::InputError({place,
                              "row with " + std::to_string(count) + " numbers; expected " +
                                  std::to_string(map.columns) + " as in the rows before",
                              "the file is truncated, or is not a height map"});
    ++map.rows;
  }
}

/// "12.34 um" in um; InputError when it is not a length.
double length_um(std::string_view text, const core::FileLocation& place) {
  text = trimmed(text);
  const std::size_t gap = text.find_first_of(kBlanks);
  const auto value = number_of(text.substr(0, gap), Comma::decimal);
  const auto unit = gap == std::string_view::npos ? std::nullopt : length_unit_um(trimmed(text.substr(gap)));
  if (!value || !unit || !(*value > 0.0) || !std::isfinite(*value * *unit))
    throw core::InputError({place,
                            "found " + core::in_quotes(text) + "; expected a positive length with its unit",
                            "for example 90 um"});
  return *value * *unit;
}

struct GwyddionHeader {
  bool found = false;
  std::optional<double> width_um, height_um;
};

/// One "# Key: value" line of Gwyddion's text export, in English or German.
void read_gwyddion_line(std::string_view line, const core::FileLocation& place, RawMap& map,
                        GwyddionHeader& header) {
  line.remove_prefix(1);
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return;  // a comment
  const std::string_view key = trimmed(line.substr(0, colon)), value = trimmed(line.substr(colon + 1));
  if (key == "Channel" || key == "Kanal") map.title = map.channel = std::string(value);
  if (key == "Width" || key == "Breite") header.width_um = length_um(value, place);
  if (key == "Height" || key == "H\xC3\xB6he" || key == "H\xF6he") header.height_um = length_um(value, place);
  if (key == "Value units" || key == "Werteinheiten" || key == "Wert-Einheiten") {
    map.height_unit = std::string(value);
    map.height_unit_um = length_unit_um(value);
    header.found = true;
  }
}

RawMap parse_commented_matrix(std::string_view content, const std::string& file) {
  Lines lines(content);
  RawMap map;
  map.format = "text matrix";
  GwyddionHeader header;
  auto line = lines.next();
  for (; line && (line->starts_with('#') || trimmed(*line).empty()); line = lines.next())
    if (line->starts_with('#')) read_gwyddion_line(*line, {file, lines.number()}, map, header);
  header.found = header.found || header.width_um || header.height_um;
  // Gwyddion separates numbers by tabs, so that a comma inside one can only be a locale's decimal sign.
  read_matrix(lines, line, file, header.found ? Comma::decimal : Comma::refused, map);
  if (map.rows == 0) throw core::InputError({{file}, "no numbers; expected a height map", ""});
  if (!header.found && is_xyz_list(map)) return grid_of_xyz(map.values, file);
  if (header.width_um) map.pitch_x_um = *header.width_um / map.columns;
  if (header.height_um) map.pitch_y_um = *header.height_um / map.rows;
  if (map.pitch_x_um && map.pitch_y_um) map.pitch_ratio = *map.pitch_y_um / *map.pitch_x_um;
  if (header.found) map.format = "Gwyddion text export";
  return map;
}

/// Number behind `key=` in `line`.
double keyed_number(std::string_view line, std::string_view key, const core::FileLocation& place) {
  const std::size_t at = line.find(key);
  if (at != std::string_view::npos) {
    std::string_view text = line.substr(at + key.size());
    text = text.substr(0, text.find_first_of(kBlanks));
    if (const auto value = whole_number(text); value && *value > 0.0 && std::isfinite(*value)) return *value;
  }
  throw core::InputError(
      {place,
       "found " + core::in_quotes(line) + "; expected " + core::in_quotes(key) + " and a positive number",
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
  if (!unit)
    throw core::InputError(
        {{file, lines.number()}, "pixel size without a length unit; expected \"pixel size=3.5e-7 m\"", ""});
  map.pitch_x_um = map.pitch_y_um = size * *unit;
  header();  // the unit of the data, which the conversion factor converts to metres
  const std::string_view factor = header();
  map.height_unit_um = keyed_number(factor, "height conversion factor (-> m)=", {file, lines.number()}) * 1e6;
  read_matrix(lines, lines.next(), file, Comma::refused, map);
  if (map.rows != rows || map.columns != columns) {
    std::ostringstream said;
    said << columns << " x " << rows;
    throw core::InputError({{file},
                            std::to_string(map.columns) + " x " + std::to_string(map.rows) +
                                " points; the header states " + said.str(),
                            "the file is truncated"});
  }
  return map;
}

}  // namespace

bool is_profiler_matrix(std::string_view content) {
  return trimmed(content.substr(0, 256)).starts_with("h=");
}

RawMap parse_profiler_matrix(std::string_view content, const ReadRequest& request) {
  require_channel({}, request);
  return parse_profiler(content, request.file);
}

bool is_number_text(std::string_view content) {
  constexpr std::size_t kProbe = 4096;
  if (content.substr(0, kProbe).find('\0') != std::string_view::npos) return false;
  content.remove_prefix(content.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
  Lines lines(content);
  while (const auto line = lines.next()) {
    std::string_view text = trimmed(*line);
    if (text.empty() || text.starts_with('#')) continue;
    if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
    if (text.starts_with('.')) text.remove_prefix(1);
    return (!text.empty() && text[0] >= '0' && text[0] <= '9') || lower_case(text.substr(0, 3)) == "nan";
  }
  return false;
}

RawMap parse_number_text(std::string_view content, const ReadRequest& request) {
  RawMap map = parse_commented_matrix(
      content.substr(content.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0), request.file);
  require_channel(map.title, request);
  return map;
}

}  // namespace scintray::topography
