/// Agilent (Molecular Imaging, Keysight) PicoView. Keys fill 14 characters; a "bufferLabel" begins
/// the lines of one channel; "data" ends the header and states how the numbers behind it are stored,
/// as parts of the channel's range, bottom row first.

#include <cmath>
#include <map>

#include "scintray/core/error.hpp"
#include "scintray/topography/detail/readers/bytes.hpp"
#include "scintray/topography/detail/readers/channels.hpp"
#include "scintray/topography/detail/readers/formats.hpp"
#include "scintray/topography/detail/readers/lines.hpp"

namespace scintray::topography {

namespace {

constexpr std::string_view kPicoMagic = "fileType      ";
constexpr std::size_t kKeyWidth = 14;

using Fields = std::map<std::string, std::string>;

struct PicoHeader {
  Fields common;
  std::vector<Fields> buffers;
  std::string storage;   ///< "BINARY", "BINARY_32"
  std::size_t size = 0;  ///< bytes
};

PicoHeader parse_header(std::string_view content, const std::string& file) {
  PicoHeader header;
  Lines lines(content);
  while (const auto line = lines.next()) {
    const std::string key(trimmed(line->substr(0, kKeyWidth)));
    const std::string value(trimmed(line->substr(std::min(kKeyWidth, line->size()))));
    if (key == "data") {
      header.storage = value;
      header.size = lines.place();
      return header;
    }
    if (key == "bufferLabel") header.buffers.emplace_back();
    (header.buffers.empty() ? header.common : header.buffers.back())[key] = value;
  }
  throw core::InputError({{file}, "a header without its last line, \"data\"", "the file is truncated"});
}

std::string text_of(const Fields& fields, const char* key) {
  const auto found = fields.find(key);
  return found == fields.end() ? std::string() : found->second;
}

double positive(const Fields& fields, const char* key, const std::string& file) {
  const std::string text = text_of(fields, key);
  const auto value = whole_number(text);
  if (!value || !(*value > 0.0) || !std::isfinite(*value * 1e6))
    throw core::InputError(
        {{file},
         std::string(key) + " is " + core::in_quotes(text) + "; expected a positive number",
         "the header is damaged"});
  return *value;
}

}  // namespace

bool is_picoview(std::string_view content) { return content.starts_with(kPicoMagic); }

RawMap parse_picoview(std::string_view content, const ReadRequest& request) {
  const std::string& file = request.file;
  const PicoHeader header = parse_header(content, file);
  if (const std::string type = text_of(header.common, "fileType"); type != "Image")
    throw core::InputError(
        {{file, 1}, "PicoView file of type " + core::in_quotes(type) + "; expected an \"Image\"", ""});
  if (header.storage != "BINARY" && header.storage != "BINARY_32")
    throw core::InputError(
        {{file},
         "numbers stored as " + core::in_quotes(header.storage) + "; expected \"BINARY\" or \"BINARY_32\"",
         "save the file from PicoView as binary, or from Gwyddion as .gsf"});
  std::vector<ChannelInfo> channels;
  for (const Fields& buffer : header.buffers) {
    ChannelInfo info{text_of(buffer, "bufferLabel"), text_of(buffer, "bufferUnit"), false,
                     text_of(buffer, "direction")};
    if (const std::string trace = text_of(buffer, "trace"); !trace.empty()) info.direction = trace;
    info.length = length_unit_um(info.unit).has_value();
    channels.push_back(info);
  }
  const ChosenChannel chosen = choose_channel(channels, request);
  const bool wide = header.storage == "BINARY_32";
  const std::size_t bytes = wide ? 4 : 2;
  const double columns = positive(header.common, "xPixels", file),
               rows = positive(header.common, "yPixels", file);
  const std::string_view data = content.substr(header.size);
  const std::size_t points = checked_points(columns, rows, data.size() / header.buffers.size(), bytes, file);
  RawMap map;
  map.format = "PicoView";
  take_channel(map, chosen, channels[chosen.index]);
  map.columns = static_cast<std::uint32_t>(columns);
  map.rows = static_cast<std::uint32_t>(rows);
  map.values = decode_samples(data.substr(chosen.index * points * bytes, points * bytes),
                              wide ? SampleType::int32 : SampleType::int16);
  const double step =
      std::ldexp(positive(header.buffers[chosen.index], "bufferRange", file), wide ? -31 : -15);
  for (double& value : map.values) value *= step;
  map.height_unit_um = length_unit_um(map.height_unit);
  map.pitch_x_um = positive(header.common, "xLength", file) * kUmPerMetre / map.columns;
  map.pitch_y_um = positive(header.common, "yLength", file) * kUmPerMetre / map.rows;
  map.pitch_ratio = *map.pitch_y_um / *map.pitch_x_um;
  flip_rows(map);
  return map;
}

}  // namespace scintray::topography
