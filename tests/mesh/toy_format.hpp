#pragma once
/// A mesh format from outside: nothing of ScintRay knows it but the list that the caller passes.

#include <sstream>
#include <string>
#include <vector>

#include "mesh/box_files.hpp"
#include "scintray/mesh/import/mesh_format.hpp"

namespace scintray::test {

/// Lines "v X Y Z" in cm, "f A B C ..." with corners counted from 0, and "solid NAME".
inline mesh::RawMesh read_lines_of_toy(const mesh::MeshFile& file) {
  mesh::RawMesh raw;
  raw.unit = {.name = "cm", .mm = 10.0, .written = true, .read_mm = 10.0};
  raw.mesh.groups = {"default"};
  std::istringstream lines(file.content);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      core::Vec3 vertex;
      words >> vertex.x() >> vertex.y() >> vertex.z();
      raw.mesh.vertices.push_back(vertex);
    } else if (kind == "f") {
      std::vector<std::uint32_t> corners;
      for (std::uint32_t corner = 0; words >> corner;) corners.push_back(corner);
      if (!raw.add_polygon(corners, 0, false))
        throw core::InputError({{file.path.string()}, "a face of too many corners", ""});
    } else if (kind == "solid") {
      std::string name;
      words >> name;
      raw.begin_body(name);
    } else {
      throw core::InputError({{file.path.string(), 0, 0}, "a line that begins with \"" + kind + "\"", ""});
    }
  }
  raw.fill_body();
  return raw;
}

/// The built-in formats, and .toy.
inline mesh::MeshFormats with_toy() {
  mesh::MeshFormats formats;
  formats.add({.extension = ".toy", .states_unit = true, .read = read_lines_of_toy});
  return formats;
}

/// The box of box_files.hpp, 1 x 2 x 3 cm.
inline const std::string kToyBox = "solid crystal\n" + corner_lines("v ") + quad_lines("f ", 0);

}  // namespace scintray::test
