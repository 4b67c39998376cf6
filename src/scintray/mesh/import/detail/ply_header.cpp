#include "scintray/mesh/import/detail/ply_header.hpp"

#include <charconv>
#include <map>
#include <sstream>

#include "scintray/core/error.hpp"

namespace scintray::mesh {
namespace {

class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& path, const std::string& content)
      : path_(path), content_(content) {}

  PlyHeader read() {
    if (next_line() != "ply") reject("a PLY file begins with the line \"ply\"");
    bool has_format = false;
    for (std::string line = next_line(); line != "end_header"; line = next_line()) {
      std::istringstream words(line);
      std::string keyword;
      words >> keyword;
      if (keyword.empty() || keyword == "comment" || keyword == "obj_info") continue;
      if (keyword == "format") {
        read_format(words);
        has_format = true;
      } else if (keyword == "element") {
        read_element(words);
      } else if (keyword == "property") {
        read_property(words);
      } else {
        reject("unknown keyword \"" + keyword.substr(0, 40) + "\" in the PLY header");
      }
    }
    if (!has_format) reject("the PLY header has no \"format\" line");
    header_.data_start = at_;
    return std::move(header_);
  }

 private:
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

  void read_format(std::istringstream& words) {
    static const std::map<std::string, PlyFormat> formats = {
        {"ascii", PlyFormat::ascii},
        {"binary_little_endian", PlyFormat::little_endian},
        {"binary_big_endian", PlyFormat::big_endian}};
    std::string name, version;
    words >> name >> version;
    const auto found = formats.find(name);
    if (found == formats.end() || version != "1.0") {
      reject("the PLY format \"" + name.substr(0, 40) + " " + version.substr(0, 10) +
             "\" is unknown; expected ascii, binary_little_endian or binary_big_endian, version 1.0");
    }
    header_.format = found->second;
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
    static const std::map<std::string, PlyType> types = {
        {"char", {Kind::signed_integer, 1}},  {"uchar", {Kind::unsigned_integer, 1}},
        {"short", {Kind::signed_integer, 2}}, {"ushort", {Kind::unsigned_integer, 2}},
        {"int", {Kind::signed_integer, 4}},   {"uint", {Kind::unsigned_integer, 4}},
        {"int8", {Kind::signed_integer, 1}},  {"uint8", {Kind::unsigned_integer, 1}},
        {"int16", {Kind::signed_integer, 2}}, {"uint16", {Kind::unsigned_integer, 2}},
        {"int32", {Kind::signed_integer, 4}}, {"uint32", {Kind::unsigned_integer, 4}},
        {"float", {Kind::floating, 4}},       {"float32", {Kind::floating, 4}},
        {"double", {Kind::floating, 8}},      {"float64", {Kind::floating, 8}}};
    const auto found = types.find(name);
    if (found == types.end()) reject("the type \"" + name.substr(0, 40) + "\" in the PLY header is unknown");
    return found->second;
  }

  const std::filesystem::path& path_;
  const std::string& content_;
  PlyHeader header_;
  std::size_t at_ = 0;
  long line_ = 0;
};

}  // namespace

PlyHeader read_ply_header(const std::filesystem::path& path, const std::string& content) {
  return HeaderReader(path, content).read();
}

}  // namespace scintray::mesh
