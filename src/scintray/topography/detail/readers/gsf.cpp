/// Gwyddion simple field, http://gwyddion.net/documentation/user-guide-en/gsf.html

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/topography/detail/readers/bytes.hpp"
#include "scintray/topography/detail/readers/channels.hpp"
#include "scintray/topography/detail/readers/formats.hpp"
#include "scintray/topography/height_map.hpp"

namespace scintray::topography {

namespace {

constexpr std::string_view kGsfMagic = "Gwyddion Simple Field 1.0\n";

using Fields = std::map<std::string, std::string, std::less<>>;

Fields header_fields(std::string_view header, const std::string& file) {
  Fields fields;
  long line = 1;
  for (header.remove_prefix(kGsfMagic.size()); !header.empty();) {
    ++line;
    const std::size_t end = std::min(header.find('\n'), header.size());
    const std::string_view text = header.substr(0, end);
    header.remove_prefix(std::min(end + 1, header.size()));
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos)
      throw core::InputError({{file, line},
                              "found " + core::in_quotes(text) + "; expected NAME = VALUE",
                              "the header is damaged"});
    fields[std::string(trimmed(text.substr(0, equals)))] = std::string(trimmed(text.substr(equals + 1)));
  }
  return fields;
}

std::uint32_t resolution(const Fields& fields, const char* name, const std::string& file) {
  const auto found = fields.find(name);
  const auto value = found == fields.end() ? std::nullopt : whole_number(found->second);
  if (!value || *value < 1 || *value > 1e6 || *value != std::floor(*value))
    throw core::InputError({{file},
                            std::string(name) + " is " +
                                (found == fields.end() ? "missing" : core::in_quotes(found->second)) +
                                "; expected a number of points",
                            "the header is damaged"});
  return static_cast<std::uint32_t>(*value);
}

/// Lateral size in um, when the file has both number and unit.
std::optional<double> extent_um(const Fields& fields, const char* name, const std::string& file) {
  const auto real = fields.find(name), unit = fields.find("XYUnits");
  if (real == fields.end() || unit == fields.end()) return std::nullopt;
  const auto value = whole_number(real->second);
  if (!value || !(*value > 0.0) || !std::isfinite(*value))
    throw core::InputError(
        {{file},
         std::string(name) + " is " + core::in_quotes(real->second) + "; expected a positive size",
         ""});
  const auto factor = length_unit_um(unit->second);
  return factor ? std::optional(*value * *factor) : std::nullopt;
}

}  // namespace

bool is_gsf(std::string_view content) { return content.starts_with(kGsfMagic); }

RawMap parse_gsf(std::string_view content, const ReadRequest& request) {
  const std::string& file = request.file;
  const std::size_t header_end = content.find('\0');
  if (header_end == std::string_view::npos)
    throw core::InputError(
        {{file}, "header of a Gwyddion simple field without its end", "the file is truncated"});
  const Fields fields = header_fields(content.substr(0, header_end), file);
  RawMap map;
  map.format = "Gwyddion simple field";
  map.columns = resolution(fields, "XRes", file);
  map.rows = resolution(fields, "YRes", file);
  // One to four zero bytes bring the header to a multiple of four.
  const std::string_view data = content.substr(std::min((header_end / 4 + 1) * 4, content.size()));
  const std::size_t points = checked_points(map.columns, map.rows, data.size(), sizeof(float), file);
  if (data.size() != points * sizeof(float))
    throw core::InputError({{file},
                            std::to_string(data.size()) + " bytes of heights; expected " +
                                std::to_string(points * sizeof(float)) + " for " +
                                std::to_string(map.columns) + " x " + std::to_string(map.rows) + " points",
                            "the header does not fit the data"});
  map.values = decode_samples(data, SampleType::float32);
  if (const auto width = extent_um(fields, "XReal", file)) map.pitch_x_um = *width / map.columns;
  if (const auto height = extent_um(fields, "YReal", file)) map.pitch_y_um = *height / map.rows;
  if (const auto unit = fields.find("ZUnits"); unit != fields.end()) map.height_unit = unit->second;
  map.height_unit_um = length_unit_um(map.height_unit);
  if (const auto title = fields.find("Title"); title != fields.end()) map.title = title->second;
  require_channel(map.title, request);
  return map;
}

void write_gsf(const std::filesystem::path& path, const HeightMap& map) {
  std::ostringstream header;
  header.precision(17);
  header << kGsfMagic << "XRes = " << map.columns << "\nYRes = " << map.rows
         << "\nXReal = " << map.columns * map.pitch_x_um * 1e-6
         << "\nYReal = " << map.rows * map.pitch_y_um * 1e-6
         << "\nXYUnits = m\nZUnits = m\nTitle = " << map.title << "\n";
  std::string content = header.str();
  content.append(4 - content.size() % 4, '\0');
  for (const double height : map.heights_um) {
    const auto metres = static_cast<float>(height * 1e-6);
    content.append(reinterpret_cast<const char*>(&metres), sizeof(float));
  }
  core::write_whole_file(path, content, "the height map");
}

}  // namespace scintray::topography
