#include "scintray/exchange/gdml/detail/solid_reader.hpp"

#include "scintray/mesh/degenerate.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/shapes/polygon.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::exchange::gdml {

mesh::TriMesh SolidReader::from_facets(const std::vector<std::vector<core::Vec3>>& facets) {
  mesh::TriMesh mesh;
  mesh.groups = {"default"};
  for (const std::vector<core::Vec3>& facet : facets) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), facet.begin(), facet.end());
    bool simple = true;
    for (const auto& [a, b, c] : mesh::triangulate_polygon(facet, simple)) {
      mesh.triangles.push_back({first + a, first + b, first + c});
      mesh.group.push_back(0);
    }
  }
  const double length_mm = mesh::rounding_length(mesh);
  mesh::weld_vertices(mesh, length_mm);
  mesh::remove_degenerate(mesh, length_mm);
  mesh::orient_outwards(mesh);
  return mesh;
}

}  // namespace scintray::exchange::gdml
