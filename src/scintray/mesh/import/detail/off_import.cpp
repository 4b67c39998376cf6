#include <charconv>
#include <cmath>
#include <string_view>

#include "scintray/core/error.hpp"
#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/import/mesh_format.hpp"

namespace scintray::mesh {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// Reads a file line by line; what follows a "#" and empty lines are skipped.
class OffReader {
 public:
  OffReader(const std::filesystem::path& path, std::string_view content) : path_(path), rest_(content) {}

  RawMesh read() {
    read_header();
    for (vertex_ = 0; vertex_ < vertices_; ++vertex_) read_vertex();
    for (face_ = 0; face_ < faces_; ++face_) read_face();
    return std::move(raw_);
  }

 private:
  static constexpr const char* kExportAgain = "the file is cut short or damaged; export it again";

  [[noreturn]] void reject(const std::string& what, const std::string& hint = kExportAgain) const {
    throw core::InputError(core::Problem{{path_.string(), line_number_, 0}, what, hint});
  }

  /// The next line with content; false at the end.
  bool next_line() {
    while (!rest_.empty()) {
      ++line_number_;
      const std::size_t end = rest_.find('\n');
      line_ = rest_.substr(0, end);
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      line_ = line_.substr(0, line_.find('#'));
      skip_blanks();
      if (!line_.empty()) return true;
    }
    return false;
  }

  void skip_blanks() {
    std::size_t blanks = 0;
    while (blanks < line_.size() && is_blank(line_[blanks])) ++blanks;
    line_.remove_prefix(blanks);
  }

  /// The next number of the line; false when there is none.
  bool next_number(double& value) {
    skip_blanks();
    if (line_.starts_with('+')) line_.remove_prefix(1);
    const auto [end, error] = std::from_chars(line_.data(), line_.data() + line_.size(), value);
    const auto length = static_cast<std::size_t>(end - line_.data());
    if (error != std::errc() || (length < line_.size() && !is_blank(line_[length]))) return false;
    line_.remove_prefix(length);
    return true;
  }

  bool next_whole(double most, std::uint32_t& value) {
    double number = 0.0;
    if (!next_number(number) || !(number >= 0.0 && number <= most) || number != std::floor(number))
      return false;
    value = static_cast<std::uint32_t>(number);
    return true;
  }

  /// The keyword, after which the numbers of vertices, faces and edges may be on the same line.
  void read_header() {
    if (!next_line()) reject("the OFF file is empty");
    for (const char* prefix : {"ST", "C", "N"})
      if (line_.starts_with(prefix)) line_.remove_prefix(std::string_view(prefix).size());
    if (!line_.starts_with("OFF")) {
      const bool dimensions = line_.starts_with("4") || line_.starts_with("n");
      reject("an OFF file begins with the keyword OFF, not with " + core::in_quotes(line_.substr(0, 20)),
             dimensions ? "coordinates of other than three dimensions are not read: export x, y, z"
                        : "export the mesh again as OFF");
    }
    line_.remove_prefix(3);
    skip_blanks();
    if (line_.starts_with("BINARY"))
      reject("binary OFF is not read", "export the mesh as ASCII OFF, PLY or STL");
    if (line_.empty() && !next_line()) reject("the OFF file ends after its keyword");
    constexpr double kMost = kMostElements;
    if (!next_whole(kMost, vertices_) || !next_whole(kMost, faces_))
      reject("the OFF file does not begin with its numbers of vertices and faces",
             "expected for example \"OFF\" and then \"8 6 12\"");
  }

  /// Three coordinates; normals, colours and texture coordinates after them are not read.
  void read_vertex() {
    const std::string name = "vertex " + std::to_string(vertex_ + 1) + " of " + std::to_string(vertices_);
    if (!next_line()) reject(name + " is missing");
    core::Vec3 vertex;
    for (int axis = 0; axis < 3; ++axis)
      if (!next_number(vertex[axis])) reject(name + " does not have three coordinates");
    raw_.mesh.vertices.push_back(vertex);
  }

  /// The number of corners and the corners; a colour after them is not read.
  void read_face() {
    const std::string name = "face " + std::to_string(face_ + 1) + " of " + std::to_string(faces_);
    if (!next_line()) reject(name + " is missing");
    std::uint32_t corners = 0;
    // Each corner takes two characters or more.
    if (!next_whole(static_cast<double>(line_.size()), corners))
      reject(name + " does not begin with its number of corners");
    std::vector<std::uint32_t> polygon(corners);
    for (std::uint32_t& corner : polygon) {
      if (!next_whole(static_cast<double>(vertices_) - 1.0, corner))
        reject(name + " refers to a vertex that does not exist, or lacks a corner");
    }
    if (!raw_.add_polygon(polygon, raw_.mesh.group_index("default"), false))
      reject(name + " has " + std::to_string(corners) + " corners, more than can be read",
             "cut polygons in triangles when exporting");
  }

  const std::filesystem::path& path_;
  std::string_view rest_, line_;
  long line_number_ = 0;
  std::uint32_t vertices_ = 0, faces_ = 0, vertex_ = 0, face_ = 0;
  RawMesh raw_;
};

}  // namespace

/// Mesh of an ASCII file in the Object File Format (Geomview 1.9 manual, "OFF Files"): OFF and its forms with
/// colours, normals or texture coordinates, which are not read. A vertex or a face a line. Coordinates keep
/// double precision. One group, "default". Time and memory are bounded by the length of the content.
///
/// Assimp is not used: up to 5.3 it reads beyond the numbers of a damaged file.
RawMesh import_off(const MeshFile& file) { return OffReader(file.path, file.content).read(); }

}  // namespace scintray::mesh
