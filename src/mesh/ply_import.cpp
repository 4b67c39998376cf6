#include "scintray/mesh/ply_import.hpp"

#include <CGAL/IO/PLY.h>
#include <CGAL/Simple_cartesian.h>

#include <sstream>
#include <string_view>

#include "scintray/mesh/file_checks.hpp"

namespace scintray {
namespace {

/// CGAL allocates a face's list by its count before it reads it; a count of one byte bounds that.
void check_list_counts(const std::filesystem::path& path, std::string_view header) {
  constexpr std::string_view kWord = "property list ";
  for (std::size_t at = header.find(kWord); at != std::string_view::npos; at = header.find(kWord, at + 1)) {
    std::string_view type = header.substr(at + kWord.size());
    type = type.substr(0, type.find(' '));
    if (type != "uchar" && type != "uint8" && type != "char" && type != "int8") {
      reject_file(path,
                  "the PLY header counts list entries in \"" + std::string(type.substr(0, 40)) +
                      "\"; expected \"uchar\"",
                  "export with \"property list uchar int vertex_indices\", or as OBJ or STL");
    }
  }
}

}  // namespace

RawMesh import_ply(const std::filesystem::path& path, const std::string& content) {
  check_list_counts(path, std::string_view(content).substr(0, content.find("end_header")));
  std::vector<CGAL::Simple_cartesian<double>::Point_3> points;
  std::vector<std::vector<std::size_t>> polygons;
  std::istringstream stream(content, std::ios::binary);
  if (!CGAL::IO::read_PLY(stream, points, polygons)) {
    reject_file(path, "cannot read the PLY file: its content does not fit its header",
                "the file is cut short or damaged; export it again");
  }
  RawMesh raw;
  for (const auto& p : points) raw.mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::uint32_t> corners;
  for (std::size_t f = 0; f < polygons.size(); ++f) {
    corners.clear();
    for (const std::size_t v : polygons[f]) {
      if (v >= points.size()) {
        reject_file(path,
                    "face " + std::to_string(f + 1) + " refers to vertex " +
                        std::to_string(static_cast<std::ptrdiff_t>(v)) + " of " +
                        std::to_string(points.size()),
                    "the file is damaged; export it again");
      }
      corners.push_back(static_cast<std::uint32_t>(v));
    }
    raw.add_polygon(corners, raw.group_index("default"), false);
  }
  return raw;
}

}  // namespace scintray
