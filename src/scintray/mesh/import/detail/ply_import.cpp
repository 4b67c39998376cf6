#include "scintray/mesh/import/mesh_format.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>

#include "scintray/core/error.hpp"
#include "scintray/core/words.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::mesh {
namespace {

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyType {
  enum class Kind { signed_integer, unsigned_integer, floating };
  Kind kind = Kind::floating;
  std::size_t bytes = 4;
};

struct PlyProperty {
  std::string name;
  PlyType type;
  bool is_list = false;
  PlyType count_type;  ///< of the number before a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t data_start = 0;  ///< first byte after the header's last line
};

/// Reads the header. Throws InputError with the line number for lines that are not PLY 1.0 and for
/// elements that announce more members than the content has bytes.
class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& path, const std::string& content)
      : path_(path), content_(content) {}

  PlyHeader read() {
    if (next_line() != "ply") reject("a PLY file begins with the line \"ply\"");
    for (std::string line = next_line(); line != "end_header"; line = next_line()) {
      std::istringstream words(line);
      std::string keyword;
      words >> keyword;
      if (keyword.empty()) continue;
      const std::optional<Reader> reader = core::find_word(kKeywords, keyword);
      if (!reader) reject("unknown keyword \"" + keyword.substr(0, 40) + "\" in the PLY header");
      (this->**reader)(words);
    }
    if (!has_format_) reject("the PLY header has no \"format\" line");
    header_.data_start = at_;
    return std::move(header_);
  }

 private:
  using Reader = void (HeaderReader::*)(std::istringstream& words);
  static const core::Word<Reader> kKeywords[5];  ///< with the readers of the lines that they begin

  [[noreturn]] void reject(const std::string& what) const {
    throw core::InputError(
        core::Problem{{path_.string(), line_, 0}, what, "the file is damaged; export it again"});
  }

  /// Lines end with LF or CR LF.
  std::string next_line() {
    ++line_;
    const std::size_t end = content_.find('\n', at_);
    if (end == std::string::npos) reject("the PLY header does not end with \"end_header\"");
    std::string line = content_.substr(at_, end - at_);
    at_ = end + 1;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return line;
  }

  void skip_line(std::istringstream& /*words*/) {}

  void read_format(std::istringstream& words) {
    static constexpr core::Word<PlyFormat> kFormats[] = {{"ascii", PlyFormat::ascii},
                                                         {"binary_little_endian", PlyFormat::little_endian},
                                                         {"binary_big_endian", PlyFormat::big_endian}};
    std::string name, version;
    words >> name >> version;
    const std::optional<PlyFormat> format = core::find_word(kFormats, name);
    if (!format || version != "1.0") {
      reject("the PLY format \"" + name.substr(0, 40) + " " + version.substr(0, 10) +
             "\" is unknown; expected ascii, binary_little_endian or binary_big_endian, version 1.0");
    }
    header_.format = *format;
    has_format_ = true;
  }

  void read_element(std::istringstream& words) {
    PlyElement element;
    std::string count;
    words >> element.name >> count;
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (error != std::errc() || end != count.data() + count.size()) {
      reject("element \"" + element.name.substr(0, 40) + "\" has no whole number after it");
    }
    if (element.count > content_.size()) {
      reject("the file announces " + count + " elements \"" + element.name.substr(0, 40) + "\" but is only " +
             std::to_string(content_.size()) + " bytes long");
    }
    header_.elements.push_back(std::move(element));
  }

  void read_property(std::istringstream& words) {
    if (header_.elements.empty()) reject("a property stands before the first element of the PLY header");
    PlyProperty property;
    std::string type;
    words >> type;
    if (type == "list") {
      property.is_list = true;
      words >> type;
      property.count_type = type_named(type);
      if (property.count_type.kind == PlyType::Kind::floating) reject("a list is counted in a floating type");
      words >> type;
    }
    property.type = type_named(type);
    if (!(words >> property.name)) reject("a property of the PLY header has no name");
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType type_named(const std::string& name) const {
    using Kind = PlyType::Kind;
    static constexpr core::Word<PlyType> kTypes[] = {
        {"char", {Kind::signed_integer, 1}},  {"uchar", {Kind::unsigned_integer, 1}},
        {"short", {Kind::signed_integer, 2}}, {"ushort", {Kind::unsigned_integer, 2}},
        {"int", {Kind::signed_integer, 4}},   {"uint", {Kind::unsigned_integer, 4}},
        {"int8", {Kind::signed_integer, 1}},  {"uint8", {Kind::unsigned_integer, 1}},
        {"int16", {Kind::signed_integer, 2}}, {"uint16", {Kind::unsigned_integer, 2}},
        {"int32", {Kind::signed_integer, 4}}, {"uint32", {Kind::unsigned_integer, 4}},
        {"float", {Kind::floating, 4}},       {"float32", {Kind::floating, 4}},
        {"double", {Kind::floating, 8}},      {"float64", {Kind::floating, 8}}};
    const std::optional<PlyType> type = core::find_word(kTypes, name);
    if (!type) reject("the type \"" + name.substr(0, 40) + "\" in the PLY header is unknown");
    return *type;
  }

  const std::filesystem::path& path_;
  const std::string& content_;
  PlyHeader header_;
  bool has_format_ = false;
  std::size_t at_ = 0;
  long line_ = 0;
};

const core::Word<HeaderReader::Reader> HeaderReader::kKeywords[5] = {
    {"comment", &HeaderReader::skip_line},
    {"obj_info", &HeaderReader::skip_line},
    {"format", &HeaderReader::read_format},
    {"element", &HeaderReader::read_element},
    {"property", &HeaderReader::read_property}};

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Reads one number after the other from the data part.
class NumberReader {
 public:
  NumberReader(const std::string& content, std::size_t start, PlyFormat format)
      : content_(content), at_(start), format_(format) {}

  /// False when the data end or hold no number here.
  bool next(const PlyType& type, double& value) {
    return format_ == PlyFormat::ascii ? next_text(value) : next_binary(type, value);
  }

 private:
  bool next_text(double& value) {
    while (at_ < content_.size() && is_space(content_[at_])) ++at_;
    if (at_ < content_.size() && content_[at_] == '+') ++at_;
    const char* last = content_.data() + content_.size();
    const auto [end, error] = std::from_chars(content_.data() + at_, last, value);
    if (error != std::errc() || (end != last && !is_space(*end))) return false;
    at_ = static_cast<std::size_t>(end - content_.data());
    return true;
  }

  bool next_binary(const PlyType& type, double& value) {
    if (content_.size() - at_ < type.bytes) return false;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < type.bytes; ++i) {
      const std::size_t place = format_ == PlyFormat::little_endian ? i : type.bytes - 1 - i;
      bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(content_[at_ + i])) << (8 * place);
    }
    at_ += type.bytes;
    value = decode(type, bits);
    return true;
  }

  static double decode(const PlyType& type, std::uint64_t bits) {
    if (type.kind == PlyType::Kind::floating) {
      return type.bytes == 8 ? std::bit_cast<double>(bits)
                             : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    }
    const double range = std::ldexp(1.0, static_cast<int>(8 * type.bytes));
    const double value = static_cast<double>(bits);
    return type.kind == PlyType::Kind::signed_integer && value >= 0.5 * range ? value - range : value;
  }

  const std::string& content_;
  std::size_t at_;
  PlyFormat format_;
};

class PlyReader {
 public:
  PlyReader(const std::filesystem::path& path, const std::string& content)
      : path_(path),
        header_(HeaderReader(path, content).read()),
        numbers_(content, header_.data_start, header_.format) {}

  RawMesh read() {
    for (const PlyElement& element : header_.elements) {
      (this->*core::find_word(kElements, element.name).value_or(&PlyReader::skip))(element);
    }
    add_faces();
    return std::move(raw_);
  }

 private:
  using Reader = void (PlyReader::*)(const PlyElement& element);
  static const core::Word<Reader> kElements[2];  ///< with their readers; others are skipped

  [[noreturn]] void reject_member(const PlyElement& element, std::uint64_t member,
                                  const std::string& what) const {
    reject_file(path_,
                "element \"" + element.name + "\" number " + std::to_string(member + 1) + " of " +
                    std::to_string(element.count) + " " + what,
                "the file is cut short or damaged; export it again");
  }

  double number(const PlyElement& element, std::uint64_t member, const PlyType& type) {
    double value = 0.0;
    if (!numbers_.next(type, value)) reject_member(element, member, "is missing or not a number");
    return value;
  }

  /// Reads one property of a member and calls use(value) for each number in it.
  template <typename Use>
  void read_property(const PlyElement& element, std::uint64_t member, const PlyProperty& property, Use use) {
    double count = 1.0;
    if (property.is_list) count = number(element, member, property.count_type);
    if (!(count >= 0.0) || count != std::floor(count))
      reject_member(element, member, "has a list of impossible length");
    for (double i = 0.0; i < count; ++i) use(number(element, member, property.type));
  }

  void skip(const PlyElement& element) {
    for (std::uint64_t member = 0; member < element.count; ++member) {
      for (const PlyProperty& property : element.properties) {
        read_property(element, member, property, [](double) {});
      }
    }
    raw_.notes.push_back(std::to_string(element.count) + " elements \"" + element.name + "\" left out");
  }

  void read_vertices(const PlyElement& element) {
    constexpr int kNoAxis = 3;
    std::vector<int> axis_of(element.properties.size(), kNoAxis);
    int found = 0;
    for (std::size_t p = 0; p < axis_of.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const auto axis = std::string_view("xyz").find(property.name);
      if (property.is_list || property.name.size() != 1 || axis == std::string_view::npos) continue;
      axis_of[p] = static_cast<int>(axis);
      found |= 1 << axis;
    }
    if (found != 7)
      reject_file(path_, "the PLY element \"vertex\" lacks a property x, y or z", "export it again");
    for (std::uint64_t member = 0; member < element.count; ++member) {
      core::Vec3 vertex = core::Vec3::Zero();
      for (std::size_t p = 0; p < axis_of.size(); ++p) {
        read_property(element, member, element.properties[p], [&](double value) {
          if (axis_of[p] != kNoAxis) vertex[axis_of[p]] = value;
        });
      }
      raw_.mesh.vertices.push_back(vertex);
    }
  }

  void read_faces(const PlyElement& element) {
    faces_ = &element;
    for (std::uint64_t member = 0; member < element.count; ++member) {
      for (const PlyProperty& property : element.properties) {
        const bool corners =
            property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
        read_property(element, member, property, [&](double value) {
          if (corners) corners_.push_back(value);
        });
      }
      corners_end_.push_back(corners_.size());
    }
  }

  /// Called at the end, as faces may precede the vertices they refer to.
  void add_faces() {
    std::size_t start = 0;
    std::vector<std::uint32_t> polygon;
    const auto vertices = static_cast<double>(raw_.mesh.vertices.size());
    for (std::size_t f = 0; f < corners_end_.size(); ++f) {
      polygon.clear();
      for (std::size_t c = start; c < corners_end_[f]; ++c) {
        const double corner = corners_[c];
        if (!(corner >= 0.0 && corner < vertices) || corner != std::floor(corner)) {
          reject_member(*faces_, f, "refers to a vertex that does not exist");
        }
        polygon.push_back(static_cast<std::uint32_t>(corner));
      }
      start = corners_end_[f];
      if (!raw_.add_polygon(polygon, raw_.mesh.group_index("default"), false)) {
        reject_member(*faces_, f, "has more corners than can be read");
      }
    }
  }

  const std::filesystem::path& path_;
  PlyHeader header_;
  NumberReader numbers_;
  RawMesh raw_;
  const PlyElement* faces_ = nullptr;
  std::vector<double> corners_;
  std::vector<std::size_t> corners_end_;  ///< per face, end of its part of corners_
};

const core::Word<PlyReader::Reader> PlyReader::kElements[2] = {{"vertex", &PlyReader::read_vertices},
                                                               {"face", &PlyReader::read_faces}};

}  // namespace

/// Mesh of a PLY file (G. Turk 1994, "The PLY Polygon File Format", version 1.0), ASCII or binary of either
/// byte order. Coordinates keep double precision. One group, "default". Elements other than "vertex" and
/// "face" are left out with a note. Time and memory are bounded by the length of the content.
///
/// Other readers are not used: assimp up to 5.3 skips data bytes of binary files that look like white space
/// after the header, and CGAL 5.5 crashes on headers whose lines are in an unexpected order.
RawMesh import_ply(const MeshFile& file) { return PlyReader(file.path, file.content).read(); }

}  // namespace scintray::mesh
