/// Bruker (Veeco, Digital Instruments) Nanoscope, version 4.3 or newer, as described by its users:
/// http://www.physics.arizona.edu/~smanne/DI/software/fileformats.html
///
/// height = number / 2^(8 bytes) * full scale (V) * sensitivity (nm/V).

#include <cmath>
#include <map>
#include <utility>

#include "scintray/core/error.hpp"
#include "scintray/topography/detail/readers/bytes.hpp"
#include "scintray/topography/detail/readers/channels.hpp"
#include "scintray/topography/detail/readers/formats.hpp"
#include "scintray/topography/detail/readers/lines.hpp"

namespace scintray::topography {

namespace {

constexpr std::string_view kNanoscopeMagic = "\\*File list", kEnd = "\\*File list end";
/// From this version on, files exist that state 2 bytes a pixel and hold 4.
constexpr double kWideSince = 0x09200000;
/// No offset, length or number of points lies above the size of the largest file.
constexpr double kMostNumber = 1 << 30;

struct Entry {
  std::string value;
  long line = 0;
};

/// One "\*NAME" list and its "\Key: value" lines.
struct Section {
  std::string name;
  long line = 0;
  std::map<std::string, Entry> entries;
};

class Header {
 public:
  Header(std::string_view content, const std::string& file) : file_(file) {
    Lines lines(content);
    while (const auto line = lines.next()) {
      if (line->starts_with(kEnd)) return;
      if (line->starts_with("\\*"))
        sections_.push_back({std::string(trimmed(line->substr(2))), lines.number(), {}});
      else if (line->starts_with('\\') && !sections_.empty())  // other lines continue a note
        add(line->substr(1), lines.number());
    }
    throw core::InputError(
        {{file}, "a header without its end, \"\\*File list end\"", "the file is truncated"});
  }

  const std::vector<Section>& sections() const { return sections_; }

  /// The entry in whichever section has it.
  const Entry* find(const std::string& key) const {
    for (const Section& section : sections_)
      if (const auto found = section.entries.find(key); found != section.entries.end()) return &found->second;
    return nullptr;
  }

  const Entry& need(const Section& section, const std::string& key) const {
    const auto found = section.entries.find(key);
    if (found == section.entries.end())
      throw core::InputError(
          {{file_, section.line},
           "list " + core::in_quotes(section.name) + " without " + core::in_quotes("\\" + key),
           "files before Nanoscope 4.3 lack it: open the file in Gwyddion and save it as .gsf"});
    return found->second;
  }

  double number(const Section& section, const std::string& key) const {
    const Entry& entry = need(section, key);
    const auto value = whole_number(entry.value);
    if (!value || !(*value >= 0.0 && *value <= kMostNumber)) fail(entry, "a number from 0 to 2^30");
    return *value;
  }

  [[noreturn]] void fail(const Entry& entry, const std::string& expected) const {
    throw core::InputError({{file_, entry.line},
                            "found " + core::in_quotes(entry.value) + "; expected " + expected,
                            "the header is damaged"});
  }

 private:
  void add(std::string_view line, long number) {
    // Keys such as "@2:Z scale" hold a colon themselves; a blank follows the one that ends the key.
    std::size_t colon = line.find(": ");
    if (colon == std::string_view::npos) colon = line.find(':');
    if (colon == std::string_view::npos) colon = line.size();
    const std::string_view value = line.substr(std::min(colon + 1, line.size()));
    sections_.back().entries[std::string(trimmed(line.substr(0, colon)))] = {std::string(trimmed(value)),
                                                                             number};
  }

  std::string file_;
  std::vector<Section> sections_;
};

/// The blank-separated words of a value.
std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::size_t at = text.find_first_not_of(" \t");
  while (at != std::string::npos) {
    const std::size_t end = std::min(text.find_first_of(" \t", at), text.size());
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(" \t", end);
  }
  return words;
}

double positive(const Header& header, const Entry& entry, const std::string& word) {
  const auto value = whole_number(word);
  if (!value || !(*value > 0.0) || !std::isfinite(*value)) header.fail(entry, "a positive number");
  return *value;
}

/// Physical range of the full range of the stored numbers.
struct Scale {
  double full = 0.0;  ///< in `unit`
  double step = 0.0;  ///< per stored unit, as rounded in the header; 0 when not stated
  std::string unit;
};

/// Factor from the unit `from` to `to`, for the electric units of sensitivities.
std::optional<double> electric_factor(const std::string& from, const std::string& to) {
  static const std::map<std::string, double> kVolts{{"V", 1.0}, {"mV", 1e-3}, {"uV", 1e-6}};
  if (from == to) return 1.0;
  const auto a = kVolts.find(from), b = kVolts.find(to);
  if (a == kVolts.end() || b == kVolts.end()) return std::nullopt;
  return a->second / b->second;
}

/// From "V [Sens. ZsensSens] (0.000375 V/LSB) 24.57563 V" and "V 790.3658 nm/V".
Scale read_scale(const Header& header, const Section& image) {
  const Entry& entry = header.need(image, "@2:Z scale");
  const std::string& text = entry.value;
  const std::size_t bracket = text.find('['), bracket_end = text.find(']');
  const std::size_t parenthesis = text.find('('), parenthesis_end = text.find(')');
  const bool sound = text.starts_with("V") && parenthesis != std::string::npos &&
                     parenthesis_end != std::string::npos && parenthesis_end > parenthesis;
  const std::vector<std::string> words =
      sound ? words_of(text.substr(parenthesis_end + 1)) : std::vector<std::string>();
  if (words.empty()) header.fail(entry, "\"V [NAME] (STEP V/LSB) FULL-SCALE V\"");
  Scale scale;
  scale.full = positive(header, entry, words[0]);
  if (words.size() > 1) scale.unit = words[1];
  const auto step = words_of(text.substr(parenthesis + 1, parenthesis_end - parenthesis - 1));
  if (!step.empty()) scale.step = whole_number(step[0]).value_or(0.0);
  if (bracket == std::string::npos || bracket_end == std::string::npos || bracket_end < bracket) return scale;

  const std::string name = text.substr(bracket + 1, bracket_end - bracket - 1);
  const Entry* sensitivity = name.empty() ? nullptr : header.find("@" + name);
  if (!sensitivity) return scale;
  const auto parts = words_of(sensitivity->value);
  if (parts.size() < 3) return scale;  // "V 1.000000": the number is in volts as it is
  const std::size_t slash = parts[2].find('/');
  if (slash == std::string::npos) return scale;
  const auto factor = electric_factor(scale.unit, parts[2].substr(slash + 1));
  if (!factor) return scale;
  const double per_unit = positive(header, *sensitivity, parts[1]) * *factor;
  scale.full *= per_unit;
  scale.step *= per_unit;
  scale.unit = parts[2].substr(0, slash);
  return scale;
}

struct Image {
  const Section* section = nullptr;
  ChannelInfo info;
  Scale scale;
};

/// The name between the quotes of 'S [ZSensor] "Height Sensor"'.
std::string image_name(const std::string& value) {
  const std::size_t first = value.find('"'), last = value.rfind('"');
  return first < last ? value.substr(first + 1, last - first - 1) : value;
}

std::vector<Image> images_of(const Header& header) {
  std::vector<Image> images;
  for (const Section& section : header.sections()) {
    if (lower_case(section.name) != "ciao image list") continue;
    Image image;
    image.section = &section;
    image.info.name = image_name(header.need(section, "@2:Image Data").value);
    if (const auto line = section.entries.find("Line Direction"); line != section.entries.end())
      image.info.direction = line->second.value;
    image.scale = read_scale(header, section);
    image.info.unit = image.scale.unit;
    image.info.length = length_unit_um(image.scale.unit).has_value();
    images.push_back(std::move(image));
  }
  return images;
}

/// "10 10 ~m", width and height, or "10000 nm", width alone.
void read_size(const Header& header, const Section& image, RawMap& map) {
  const Entry& entry = header.need(image, "Scan Size");
  const auto words = words_of(entry.value);
  const auto unit = words.empty() ? std::nullopt : length_unit_um(words.back());
  if (!unit || (words.size() != 2 && words.size() != 3))
    header.fail(entry, "one or two lengths and their unit");
  const double width = positive(header, entry, words[0]) * *unit;
  map.pitch_x_um = width / map.columns;
  map.pitch_y_um = words.size() == 3 ? positive(header, entry, words[1]) * *unit / map.rows : *map.pitch_x_um;
  if (words.size() == 3) return;
  const auto aspect = image.entries.find("Aspect Ratio");
  if (aspect != image.entries.end() && aspect->second.value != "1:1")
    header.fail(aspect->second, "\"1:1\" where the scan size is one number");
}

double version_of(const Header& header) {
  const Entry* version = header.find("Version");
  return version ? std::strtod(version->value.c_str(), nullptr) : 0.0;
}

/// Bytes of one stored number.
std::size_t stored_bytes(const Header& header, const Section& image, double points) {
  const double said = header.number(image, "Bytes/pixel"), length = header.number(image, "Data length");
  if (said != 2.0 && said != 4.0) header.fail(header.need(image, "Bytes/pixel"), "2 or 4");
  if (length == points * said) return static_cast<std::size_t>(said);
  if (length == 4.0 * points && version_of(header) >= kWideSince) return 4;
  header.fail(header.need(image, "Data length"),
              std::to_string(static_cast<long long>(points * said)) + " bytes for its points");
}

/// Volts or nm per stored unit. The header states it twice; the full scale has more digits. Before
/// version 9.2 the step in parentheses may be that of the whole range of the electronics, 330 V / 2^16 for
/// the z piezo, whatever part of it the full scale of the image is; numbers are shares of the full scale all
/// the same.
double step_of(const Scale& scale, std::size_t bytes, const Header& header, const Section& image) {
  const auto near = [](double a, double b) { return std::abs(a - b) <= 0.01 * std::abs(b); };
  const double step = std::ldexp(scale.full, -8 * static_cast<int>(bytes));
  const bool of_electronics = bytes == 2 && version_of(header) < kWideSince && scale.step > step;
  if (scale.step == 0.0 || of_electronics || near(scale.step, step) ||
      near(scale.step, std::ldexp(scale.full, -16)))
    return step;
  header.fail(header.need(image, "@2:Z scale"), "a full scale of 2^16 or 2^32 steps");
}

}  // namespace

bool is_nanoscope(std::string_view content) { return content.starts_with(kNanoscopeMagic); }

RawMap parse_nanoscope(std::string_view content, const ReadRequest& request) {
  const Header header(content, request.file);
  const std::vector<Image> images = images_of(header);
  std::vector<ChannelInfo> channels;
  for (const Image& image : images) channels.push_back(image.info);
  const ChosenChannel chosen = choose_channel(channels, request);
  const Image& image = images[chosen.index];
  const Section& section = *image.section;
  RawMap map;
  map.format = "Nanoscope";
  take_channel(map, chosen, image.info);
  const double columns = header.number(section, "Samps/line"),
               rows = header.number(section, "Number of lines");
  const std::size_t bytes = stored_bytes(header, section, columns * rows);
  const double offset = header.number(section, "Data offset");
  const std::string_view data = content.substr(
      offset < static_cast<double>(content.size()) ? static_cast<std::size_t>(offset) : content.size());
  const std::size_t points = checked_points(columns, rows, data.size(), bytes, request.file);
  map.columns = static_cast<std::uint32_t>(columns);
  map.rows = static_cast<std::uint32_t>(rows);
  map.values =
      decode_samples(data.substr(0, points * bytes), bytes == 2 ? SampleType::int16 : SampleType::int32);
  const double step = step_of(image.scale, bytes, header, section);
  for (double& value : map.values) value *= step;
  map.height_unit_um = length_unit_um(map.height_unit);
  read_size(header, section, map);
  map.pitch_ratio = *map.pitch_y_um / *map.pitch_x_um;
  flip_rows(map);
  return map;
}

}  // namespace scintray::topography
