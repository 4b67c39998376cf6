#include "scintray/io/gdml/solid_reader.hpp"

#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/polygon.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::gdml {

TriMesh SolidReader::from_facets(const std::vector<std::vector<Vec3>>& facets) {
  TriMesh mesh;
  mesh.groups = {"default"};
  for (const std::vector<Vec3>& facet : facets) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), facet.begin(), facet.end());
    bool simple = true;
    for (const auto& [a, b, c] : triangulate_polygon(facet, simple)) {
      mesh.triangles.push_back({first + a, first + b, first + c});
      mesh.group.push_back(0);
    }
  }
  const double length_mm = rounding_length(mesh);
  weld_vertices(mesh, length_mm);
  remove_degenerate(mesh, length_mm);
  orient_outwards(mesh);
  return mesh;
}

}  // namespace scintray::gdml
