/// ISO 25178-71:2012 surface data file, "aISO-1.0" (text) and "bISO-1.0" (binary), and its
/// forerunner of the European project's report EUR 15178, "aBCR-1.0" and "bBCR-1.0".

#include <array>
#include <cmath>
#include <map>

#include "scintray/core/error.hpp"
#include "scintray/topography/detail/readers/bytes.hpp"
#include "scintray/topography/detail/readers/channels.hpp"
#include "scintray/topography/detail/readers/formats.hpp"
#include "scintray/topography/detail/readers/lines.hpp"

namespace scintray::topography {

namespace {

constexpr std::size_t kMagicSize = 8;

struct SdfHeader {
  double columns = 0, rows = 0;
  double step_x = 0, step_y = 0, step_z = 0;  ///< metres
  double compression = 0, type = 0;
};

SampleType sample_type(double code, const std::string& file) {
  constexpr std::array<SampleType, 8> kTypes{SampleType::uint8,   SampleType::uint16, SampleType::uint32,
                                             SampleType::float32, SampleType::int8,   SampleType::int16,
                                             SampleType::int32,   SampleType::float64};
  if (code >= 0.0 && code < 8.0 && code == std::floor(code)) return kTypes[static_cast<std::size_t>(code)];
  throw core::InputError(
      {{file}, "DataType is " + std::to_string(code) + "; expected 0 to 7", "the header is damaged"});
}

/// The number of a missing point, in the integer types of 16 and 32 bits.
std::optional<double> missing_mark(SampleType type) {
  switch (type) {
    case SampleType::uint16:
      return 65535.0;
    case SampleType::uint32:
      return 4294967295.0;
    case SampleType::int16:
      return -32768.0;
    case SampleType::int32:
      return -2147483648.0;
    default:
      return std::nullopt;
  }
}

void check(const SdfHeader& header, const std::string& file) {
  const auto require = [&](bool sound, const char* name, double value) {
    if (!sound)
      throw core::InputError(
          {{file},
           std::string(name) + " is " + std::to_string(value) + "; expected a positive length in metres",
           "the header is damaged"});
  };
  const auto positive = [](double v) { return v > 0.0 && std::isfinite(v * kUmPerMetre); };
  require(positive(header.step_x), "Xscale", header.step_x);
  require(positive(header.step_y), "Yscale", header.step_y);
  require(positive(header.step_z), "Zscale", header.step_z);
  require(positive(header.step_y / header.step_x), "Yscale / Xscale", header.step_y / header.step_x);
  if (header.compression != 0.0)
    throw core::InputError({{file},
                            "Compression is " + std::to_string(header.compression) + "; expected 0, none",
                            "save the file without compression"});
}

RawMap map_of(const SdfHeader& header, const std::string& format) {
  RawMap map;
  map.format = format;
  map.columns = static_cast<std::uint32_t>(header.columns);
  map.rows = static_cast<std::uint32_t>(header.rows);
  map.pitch_x_um = header.step_x * kUmPerMetre;
  map.pitch_y_um = header.step_y * kUmPerMetre;
  map.pitch_ratio = header.step_y / header.step_x;
  map.height_unit_um = header.step_z * kUmPerMetre;
  return map;
}

void mark_missing(RawMap& map, SampleType type) {
  if (const auto mark = missing_mark(type))
    for (double& value : map.values)
      if (value == *mark) value = std::nan("");
}

RawMap parse_binary(std::string_view content, const std::string& file) {
  Bytes bytes(content, file);
  bytes.skip(kMagicSize + 10 + 12 + 12);  // maker, date made, date changed
  SdfHeader header;
  header.columns = bytes.take<std::uint16_t>();
  header.rows = bytes.take<std::uint16_t>();
  header.step_x = bytes.take<double>();
  header.step_y = bytes.take<double>();
  header.step_z = bytes.take<double>();
  bytes.skip(sizeof(double));  // resolution along z
  header.compression = bytes.take<std::uint8_t>();
  header.type = bytes.take<std::uint8_t>();
  bytes.skip(1);  // check type
  check(header, file);
  const SampleType type = sample_type(header.type, file);
  const std::size_t points =
      checked_points(header.columns, header.rows, bytes.left(), sample_size(type), file);
  RawMap map = map_of(header, "ISO 25178-71 binary");
  map.values = decode_samples(bytes.take_view(points * sample_size(type)), type);
  mark_missing(map, type);
  return map;
}

/// "Name = value" lines up to a "*"; leaves `lines` behind it.
SdfHeader text_header(Lines& lines, const std::string& file) {
  std::map<std::string, std::string> fields;
  bool ended = false;
  while (const auto line = lines.next()) {
    if (ended = trimmed(*line) == "*"; ended) break;
    const std::size_t equals = line->find('=');
    if (equals != std::string_view::npos)
      fields[lower_case(trimmed(line->substr(0, equals)))] = std::string(trimmed(line->substr(equals + 1)));
  }
  if (!ended) throw core::InputError({{file}, "a header without its end, \"*\"", "the file is truncated"});
  const auto number = [&](const std::string& name) {
    const auto found = fields.find(lower_case(name));
    const auto value = found == fields.end() ? std::nullopt : whole_number(found->second);
    if (value && std::isfinite(*value)) return *value;
    throw core::InputError({{file},
                            name + " is " +
                                (found == fields.end() ? "missing" : core::in_quotes(found->second)) +
                                "; expected a number",
                            "the header is damaged"});
  };
  return {number("NumPoints"), number("NumProfiles"), number("Xscale"),  number("Yscale"),
          number("Zscale"),    number("Compression"), number("DataType")};
}

/// Numbers until the "*" behind them or the end; "BAD" is a missing one.
void read_numbers(Lines& lines, const std::string& file, RawMap& map) {
  constexpr std::string_view kBlanks = " \t\v\f,";
  const std::size_t points = std::size_t{map.columns} * map.rows;
  while (const auto line = lines.next()) {
    if (trimmed(*line) == "*") break;
    for (std::size_t at = line->find_first_not_of(kBlanks); at != std::string_view::npos;) {
      const std::size_t end = std::min(line->find_first_of(kBlanks, at), line->size());
      const std::string_view word = line->substr(at, end - at);
      const auto value = lower_case(word) == "bad" ? std::optional(std::nan("")) : whole_number(word);
      if (!value || map.values.size() == points)
        throw core::InputError(
            {{file, lines.number(), static_cast<long>(at) + 1},
             "found " + core::in_quotes(word) + "; expected " +
                 (value ? "no more than " + std::to_string(points) + " heights" : "a height"),
             "the file is damaged"});
      map.values.push_back(*value);
      at = line->find_first_not_of(kBlanks, end);
    }
  }
  if (map.values.size() != points)
    throw core::InputError(
        {{file},
         std::to_string(map.values.size()) + " heights; expected " + std::to_string(points),
         "the file is truncated"});
}

RawMap parse_text(std::string_view content, const std::string& file) {
  Lines lines(content);
  lines.next();
  const SdfHeader header = text_header(lines, file);
  check(header, file);
  // A number and the blank behind it are two bytes; the last may go without.
  checked_points(header.columns, header.rows, content.size() - lines.place() + 1, 2, file);
  const SampleType type = sample_type(header.type, file);
  RawMap map = map_of(header, "ISO 25178-71 text");
  read_numbers(lines, file, map);
  mark_missing(map, type);
  return map;
}

}  // namespace

bool is_sdf(std::string_view content) {
  if (content.size() < kMagicSize || (content[0] != 'a' && content[0] != 'b')) return false;
  const std::string_view rest = content.substr(1, kMagicSize - 1);
  return rest == "ISO-1.0" || rest == "BCR-1.0";
}

RawMap parse_sdf(std::string_view content, const ReadRequest& request) {
  require_channel({}, request);
  return content.starts_with('a') ? parse_text(content, request.file) : parse_binary(content, request.file);
}

}  // namespace scintray::topography
