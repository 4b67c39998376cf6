/// Igor binary wave, version 5, as in WaveMetrics' technical note TN003, and the names that Asylum
/// Research's software gives its channels.

#include <array>
#include <cmath>
#include <map>

#include "scintray/core/error.hpp"
#include "scintray/topography/detail/readers/bytes.hpp"
#include "scintray/topography/detail/readers/channels.hpp"
#include "scintray/topography/detail/readers/formats.hpp"

namespace scintray::topography {

namespace {

constexpr std::size_t kDimensions = 4, kFileHeader = 64, kWaveHeader = 320, kLabelSize = 32;

/// The version's other byte is zero.
std::endian byte_order(std::string_view content) {
  return content[0] == 0 ? std::endian::big : std::endian::little;
}

struct Wave {
  std::endian order = std::endian::little;
  std::string name, unit;
  std::array<std::uint32_t, kDimensions> points{};  ///< along x, y, channel, frame
  std::array<double, kDimensions> step{};
  std::array<std::string, kDimensions> units;
  std::vector<std::string> labels;  ///< of the channels
  std::map<std::string, std::string> notes;
  SampleType type = SampleType::float32;
  std::string_view data;
};

std::string padded_text(Bytes& bytes, std::size_t size) {
  const std::string_view text = bytes.take_view(size);
  return std::string(text.substr(0, text.find('\0')));
}

std::size_t take_size(Bytes& bytes) {
  const auto size = bytes.take<std::int32_t>();
  if (size < 0)
    throw core::InputError(
        {{bytes.file()}, "a part of negative size, " + std::to_string(size), "the header is damaged"});
  return static_cast<std::size_t>(size);
}

SampleType sample_type(std::int16_t code, const std::string& file) {
  static const std::map<int, SampleType> kTypes{{0x02, SampleType::float32}, {0x04, SampleType::float64},
                                                {0x08, SampleType::int8},    {0x10, SampleType::int16},
                                                {0x20, SampleType::int32},   {0x48, SampleType::uint8},
                                                {0x50, SampleType::uint16},  {0x60, SampleType::uint32}};
  const auto found = kTypes.find(code);
  if (found == kTypes.end())
    throw core::InputError({{file},
                            "wave of number type " + std::to_string(code) + "; expected real numbers",
                            "complex and text waves are not height maps"});
  return found->second;
}

/// "Key: value" lines that end in a carriage return.
std::map<std::string, std::string> parse_note(std::string_view note) {
  std::map<std::string, std::string> result;
  while (!note.empty()) {
    const std::size_t end = std::min(note.find_first_of("\r\n"), note.size());
    const std::string_view line = note.substr(0, end);
    note.remove_prefix(std::min(end + 1, note.size()));
    if (const std::size_t colon = line.find(':'); colon != std::string_view::npos)
      result[std::string(trimmed(line.substr(0, colon)))] = std::string(trimmed(line.substr(colon + 1)));
  }
  return result;
}

/// The parts after the data.
struct Tail {
  std::size_t formula = 0, note = 0, unit = 0;
  std::array<std::size_t, kDimensions> units{}, labels{};
};

void read_tail(Bytes& bytes, const Tail& tail, std::size_t label_dimension, Wave& wave) {
  bytes.skip(tail.formula);
  wave.notes = parse_note(bytes.take_view(tail.note));
  if (tail.unit > 0) wave.unit = padded_text(bytes, tail.unit);
  for (std::size_t d = 0; d < kDimensions; ++d)
    if (tail.units[d] > 0) wave.units[d] = padded_text(bytes, tail.units[d]);
  for (std::size_t d = 0; d < kDimensions; ++d) {
    const std::string_view block = bytes.take_view(tail.labels[d]);
    if (d != label_dimension) continue;
    Bytes labels(block, bytes.file());
    // The first names the dimension, the others its elements.
    if (labels.left() >= kLabelSize) labels.skip(kLabelSize);
    while (labels.left() >= kLabelSize) wave.labels.push_back(padded_text(labels, kLabelSize));
  }
}

void read_wave_header(Bytes& bytes, Wave& wave) {
  bytes.skip(16);  // pointer, two dates, number of points
  wave.type = sample_type(bytes.take<std::int16_t>(), bytes.file());
  bytes.skip(10);
  wave.name = padded_text(bytes, 32);
  bytes.skip(8);
  for (std::uint32_t& n : wave.points) n = static_cast<std::uint32_t>(take_size(bytes));
  for (double& step : wave.step) step = bytes.take<double>();
  bytes.skip(kDimensions * sizeof(double));  // offsets
  wave.unit = padded_text(bytes, 4);
  for (std::string& unit : wave.units) unit = padded_text(bytes, 4);
  bytes.skip(kWaveHeader - 168);
}

Wave parse_wave(std::string_view content, const std::string& file) {
  Wave wave;
  wave.order = byte_order(content);
  Bytes bytes(content, file, 0, wave.order);
  bytes.skip(2);  // version, which is_ibw has seen
  bytes.skip(2);  // checksum
  const std::size_t wave_size = take_size(bytes);
  Tail tail;
  tail.formula = take_size(bytes);
  tail.note = take_size(bytes);
  tail.unit = take_size(bytes);
  for (std::size_t& size : tail.units) size = take_size(bytes);
  for (std::size_t& size : tail.labels) size = take_size(bytes);
  bytes.skip(kFileHeader - 52);
  read_wave_header(bytes, wave);
  if (wave.points[0] == 0 || wave.points[1] == 0 || wave.points[3] > 1)
    throw core::InputError({{file},
                            "wave with " + std::to_string(wave.points[0]) + " x " +
                                std::to_string(wave.points[1]) + " x " + std::to_string(wave.points[2]) +
                                " x " + std::to_string(wave.points[3]) +
                                " points; expected an image, or a stack of images",
                            "curves are not height maps"});
  const std::size_t channels = std::max(1u, wave.points[2]);
  const std::size_t size = sample_size(wave.type);
  if (channels > bytes.left() / size)
    throw core::InputError(
        {{file},
         std::to_string(channels) + " channels in " + std::to_string(bytes.left()) + " bytes",
         "the header is damaged"});
  const std::size_t points =
      checked_points(wave.points[0], wave.points[1], bytes.left() / channels, size, file);
  if (wave_size < kWaveHeader || wave_size - kWaveHeader != channels * points * size)
    throw core::InputError({{file},
                            "the header states " + std::to_string(wave_size) + " bytes; expected " +
                                std::to_string(kWaveHeader + channels * points * size) + " for " +
                                std::to_string(wave.points[0]) + " x " + std::to_string(wave.points[1]) +
                                " x " + std::to_string(channels) + " points",
                            "the header is damaged"});
  wave.data = bytes.take_view(channels * points * size);
  read_tail(bytes, tail, 2, wave);
  return wave;
}

/// Asylum's software writes metres into the wave's header even where a channel holds an angle. The
/// note has "<name>Unit" for the user's inputs; else the name determines it.
std::string channel_unit(const std::string& label, const Wave& wave) {
  std::string base = label;
  for (const std::string_view ending : {"Retrace", "Trace"})
    if (base.ends_with(ending)) {
      base.resize(base.size() - ending.size());
      break;
    }
  if (const auto given = wave.notes.find(base + "Unit"); given != wave.notes.end()) return given->second;
  const bool asylum = wave.notes.contains("MicroscopeModel") || wave.notes.contains("InvOLS");
  if (!asylum || wave.labels.empty()) return wave.unit;
  for (const std::string_view length : {"Height", "ZSensor", "Amplitude", "Deflection"})
    if (base.starts_with(length)) return wave.unit;
  return base.starts_with("Phase") ? "deg" : "unknown unit";
}

}  // namespace

bool is_ibw(std::string_view content) {
  if (content.size() < kFileHeader + kWaveHeader) return false;
  const std::string_view version = content.substr(0, 2);
  if (version != std::string_view("\5\0", 2) && version != std::string_view("\0\5", 2)) return false;
  // Two bytes are a weak mark: the size of the wave must be at least that of its header.
  Bytes bytes(content, {}, 0, byte_order(content));
  bytes.skip(4);
  return bytes.take<std::int32_t>() >= static_cast<std::int32_t>(kWaveHeader);
}

RawMap parse_ibw(std::string_view content, const ReadRequest& request) {
  const Wave wave = parse_wave(content, request.file);
  const std::size_t count = std::max(1u, wave.points[2]);
  std::vector<ChannelInfo> channels(count);
  for (std::size_t k = 0; k < count; ++k) {
    if (k < wave.labels.size()) channels[k].name = wave.labels[k];
    channels[k].unit = channel_unit(channels[k].name, wave);
    channels[k].length = length_unit_um(channels[k].unit).has_value();
  }
  const ChosenChannel chosen = choose_channel(channels, request);
  RawMap map;
  map.format = "Igor wave";
  map.title = wave.name;
  take_channel(map, chosen, channels[chosen.index]);
  map.columns = wave.points[0];
  map.rows = wave.points[1];
  const std::size_t size = wave.data.size() / count;
  map.values = decode_samples(wave.data.substr(chosen.index * size, size), wave.type, wave.order);
  map.height_unit_um = length_unit_um(map.height_unit);
  const double step_x = std::abs(wave.step[0]), step_y = std::abs(wave.step[1]);
  if (!(step_x > 0.0 && step_y > 0.0 && std::isfinite(step_x * 1e6) && std::isfinite(step_y * 1e6) &&
        step_y / step_x > 0.0 && std::isfinite(step_y / step_x)))
    throw core::InputError(
        {{request.file}, "the distance of points is not a positive number", "the header is damaged"});
  map.pitch_ratio = step_y / step_x;
  const auto unit_x = length_unit_um(wave.units[0]), unit_y = length_unit_um(wave.units[1]);
  if (unit_x && unit_y) {
    map.pitch_x_um = step_x * *unit_x;
    map.pitch_y_um = step_y * *unit_y;
  }
  flip_rows(map);
  return map;
}

}  // namespace scintray::topography
