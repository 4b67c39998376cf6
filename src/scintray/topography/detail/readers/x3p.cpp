/// ISO 25178-72:2017 (ISO 5436-2) .x3p: a zip archive with main.xml, which describes the axes, and
/// a binary file or a list in the XML with the heights. Lengths are metres.

#include <cmath>
#include <cstring>
#include <pugixml.hpp>

#include "scintray/core/error.hpp"
#include "scintray/core/zip_archive.hpp"
#include "scintray/topography/detail/readers/bytes.hpp"
#include "scintray/topography/detail/readers/channels.hpp"
#include "scintray/topography/detail/readers/formats.hpp"

namespace scintray::topography {

namespace {

constexpr std::size_t kMostXml = std::size_t{64} << 20;

/// A height is number * increment + offset.
struct Axis {
  std::string kind;  ///< "I": at equal distances, "A": each has its own number
  std::string type;  ///< of numbers: I, L, F, D
  std::optional<double> increment;
  double offset = 0.0;
};

class Document {
 public:
  Document(std::string_view xml, const std::string& file, std::string name)
      : file_(file), name_(std::move(name)) {
    const pugi::xml_parse_result result = document_.load_buffer(xml.data(), xml.size());
    if (!result)
      throw core::InputError(
          {{file},
           name_ + " is not XML at byte " + std::to_string(result.offset) + ": " + result.description(),
           "the file is damaged"});
    root_ = document_.document_element();
  }

  /// The element at "Record1/Axes/CX", or none.
  pugi::xml_node find(const char* path) const { return root_.first_element_by_path(path); }

  std::string text(const char* path) const { return std::string(trimmed(find(path).text().get())); }

  std::optional<double> number(const char* path) const {
    const std::string value = text(path);
    if (value.empty()) return std::nullopt;
    const auto result = whole_number(value);
    if (!result || !std::isfinite(*result)) fail(path, "a number");
    return result;
  }

  [[noreturn]] void fail(const char* path, const std::string& expected) const {
    const std::string value = text(path);
    throw core::InputError({{file_},
                            std::string(path) + " in " + name_ + " is " +
                                (value.empty() ? "missing" : core::in_quotes(value)) + "; expected " +
                                expected,
                            "the file is damaged, or holds something other than one height map"});
  }

 private:
  std::string file_, name_;
  pugi::xml_document document_;
  pugi::xml_node root_;
};

Axis read_axis(const Document& document, const std::string& name) {
  const std::string path = "Record1/Axes/" + name;
  Axis axis;
  axis.kind = document.text((path + "/AxisType").c_str());
  axis.type = document.text((path + "/DataType").c_str());
  axis.increment = document.number((path + "/Increment").c_str());
  axis.offset = document.number((path + "/Offset").c_str()).value_or(0.0);
  return axis;
}

double pitch_um(const Document& document, const std::string& name) {
  const std::string path = "Record1/Axes/" + name;
  const Axis axis = read_axis(document, name);
  if (axis.kind != "I") document.fail((path + "/AxisType").c_str(), "\"I\", points at equal distances");
  if (!axis.increment || !(*axis.increment > 0.0) || !std::isfinite(*axis.increment * kUmPerMetre))
    document.fail((path + "/Increment").c_str(), "a positive distance in metres");
  return *axis.increment * kUmPerMetre;
}

SampleType sample_type(const Document& document, const std::string& type) {
  if (type == "D") return SampleType::float64;
  if (type == "F") return SampleType::float32;
  if (type == "L") return SampleType::int32;
  if (type == "I") return SampleType::int16;
  document.fail("Record1/Axes/CZ/DataType", "D, F, L or I");
}

/// Heights in the XML: one element a point, empty where it is missing.
void read_list(const Document& document, std::size_t points, const std::string& file, RawMap& map) {
  for (const pugi::xml_node datum : document.find("Record3/DataList").children("Datum")) {
    // With all coordinates present, the height is the last of three.
    std::string_view text = trimmed(datum.text().get());
    if (const std::size_t last = text.rfind(';'); last != std::string_view::npos)
      text.remove_prefix(last + 1);
    const auto value = text.empty() ? std::optional(std::nan("")) : whole_number(trimmed(text));
    if (!value || map.values.size() == points)
      throw core::InputError({{file},
                              "datum " + std::to_string(map.values.size() + 1) + " is " +
                                  core::in_quotes(text) + "; expected " +
                                  (value ? "no more than " + std::to_string(points) : "a height"),
                              "the file is damaged"});
    map.values.push_back(*value);
  }
  if (map.values.size() != points)
    throw core::InputError(
        {{file},
         std::to_string(map.values.size()) + " heights in the list; expected " + std::to_string(points),
         "the file is damaged"});
}

/// A bit for each point, set where it is valid, lowest bit first.
void read_valid_points(const std::string& bits, RawMap& map) {
  for (std::size_t k = 0; k < map.values.size(); ++k)
    if ((static_cast<unsigned char>(bits[k / 8]) >> (k % 8) & 1) == 0) map.values[k] = std::nan("");
}

/// The entry that is main.xml, at the top or in a folder, but not the copy that macOS adds.
std::string main_entry(const core::ZipArchive& archive, const std::string& file) {
  std::string best;
  for (const std::string& name : archive.names()) {
    const bool fits = name == "main.xml" || name.ends_with("/main.xml");
    if (!fits || name.find("__MACOSX") != std::string::npos) continue;
    if (best.empty() || name.size() < best.size()) best = name;
  }
  if (best.empty())
    throw core::InputError({{file},
                            "a zip archive without main.xml; expected an .x3p height map",
                            "unpack it, if it holds a height map of another format"});
  return best;
}

void read_heights(const core::ZipArchive& archive, const Document& document, const std::string& folder,
                  const std::string& file, RawMap& map) {
  const auto size = [&](const char* path) {
    const auto value = document.number(path);
    if (!value || !(*value >= 1.0)) document.fail(path, "a number of points");
    return *value;
  };
  const double columns = size("Record3/MatrixDimension/SizeX"), rows = size("Record3/MatrixDimension/SizeY");
  if (size("Record3/MatrixDimension/SizeZ") != 1.0) document.fail("Record3/MatrixDimension/SizeZ", "1 layer");
  const Axis height = read_axis(document, "CZ");
  const SampleType type = sample_type(document, height.type);
  const std::string link = document.text("Record3/DataLink/PointDataLink");
  const bool listed = link.empty();
  // An element of the list has at least the bytes of "<Datum/>".
  const std::size_t there = listed ? archive.size(folder + "main.xml") : archive.size(folder + link);
  const std::size_t points = checked_points(columns, rows, there, listed ? 8 : sample_size(type), file);
  map.columns = static_cast<std::uint32_t>(columns);
  map.rows = static_cast<std::uint32_t>(rows);
  if (listed)
    read_list(document, points, file, map);
  else
    map.values = decode_samples(archive.read(folder + link, points * sample_size(type)), type);
  if (const std::string valid = document.text("Record3/DataLink/ValidPointsLink"); !valid.empty())
    read_valid_points(archive.read(folder + valid, (points + 7) / 8), map);
  const bool whole = type == SampleType::int16 || type == SampleType::int32;
  if (whole && !height.increment)
    document.fail("Record1/Axes/CZ/Increment", "metres per unit of whole numbers");
  for (double& value : map.values) value = value * height.increment.value_or(1.0) + height.offset;
}

}  // namespace

bool is_x3p(std::string_view content) {
  // Other instruments' formats are zip archives too; the names of entries are not compressed.
  return content.starts_with("PK\x03\x04") && content.find("main.xml") != std::string_view::npos;
}

RawMap parse_x3p(std::string_view content, const ReadRequest& request) {
  const std::string& file = request.file;
  require_channel({}, request);
  const core::ZipArchive archive(content, file);
  const std::string main = main_entry(archive, file);
  const std::string folder = main.substr(0, main.size() - std::strlen("main.xml"));
  const std::size_t xml_size = archive.size(main);
  if (xml_size > kMostXml)
    throw core::InputError(
        {{file}, main + " has " + std::to_string(xml_size) + " bytes; expected at most 64 MiB", ""});
  const Document document(archive.read(main, xml_size), file, main);
  if (document.text("Record1/FeatureType") != "SUR") document.fail("Record1/FeatureType", "SUR, a surface");
  RawMap map;
  map.format = "ISO 25178-72";
  map.pitch_x_um = pitch_um(document, "CX");
  map.pitch_y_um = pitch_um(document, "CY");
  map.pitch_ratio = *map.pitch_y_um / *map.pitch_x_um;
  map.height_unit_um = kUmPerMetre;
  read_heights(archive, document, folder, file, map);
  return map;
}

}  // namespace scintray::topography
