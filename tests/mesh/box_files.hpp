#pragma once
/// One box, 1 x 2 x 3, in the words of mesh formats.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "scintray/core/error.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/import/import.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

namespace scintray::test {

inline std::filesystem::path mesh_file(const std::string& name, const std::string& text) {
  static const auto folder = scratch_folder("mesh_import");
  const auto path = folder / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

/// Corners of the box 0..1 x 0..2 x 0..3, one a line.
inline std::string corner_lines(const std::string& before) {
  std::string text;
  for (int corner = 0; corner < 8; ++corner) {
    text += before + std::to_string(corner & 1) + " " + std::to_string((corner >> 1 & 1) * 2) + " " +
            std::to_string((corner >> 2 & 1) * 3) + "\n";
  }
  return text;
}

/// Its sides as quadrilaterals, outwards.
inline constexpr int kQuads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

inline std::string quad_lines(const std::string& before, int first_index) {
  std::string text;
  for (const auto& quad : kQuads) {
    text += before;
    for (const int corner : quad) text += std::to_string(corner + first_index) + " ";
    text += "\n";
  }
  return text;
}

inline void check_box(const mesh::MeshImport& read, double mm_per_unit) {
  CHECK(read.mesh.vertices.size() == 8);
  CHECK(read.mesh.triangles.size() == 12);
  CHECK(read.mesh.volume() == doctest::Approx(6.0 * std::pow(mm_per_unit, 3)).epsilon(1e-6));
  CHECK(read.mesh.group.size() == 12);
  CHECK(mesh::diagnose(read.mesh).sound());
}

inline void check_refused(const std::filesystem::path& path, double mm_per_unit, const Fragments& fragments) {
  check_contains(complaint_of([&] { mesh::import_mesh(path, mm_per_unit); }), fragments);
}

}  // namespace scintray::test
