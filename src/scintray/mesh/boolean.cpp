#include "scintray/mesh/boolean.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>

#include <map>
#include <memory>
#include <tuple>

#include "scintray/mesh/degenerate.hpp"
#include "scintray/mesh/detail/cgal_surface.hpp"
#include "scintray/mesh/detail/edges.hpp"
#include "scintray/mesh/diagnosis.hpp"

namespace scintray::mesh {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Face = Surface::Face_index;
using FaceNumbers = Surface::Property_map<Face, std::uint32_t>;

/// Transfers the number of each face to the pieces that it is cut into and to its copies.
class NumberVisitor : public pmp::Corefinement::Default_visitor<Surface> {
 public:
  void watch(Surface& surface, FaceNumbers numbers) { (*numbers_)[&surface] = numbers; }
  void before_subface_creations(Face whole, Surface& surface) { *current_ = numbers(surface)[whole]; }
  void after_subface_created(Face piece, Surface& surface) { numbers(surface)[piece] = *current_; }
  void after_face_copy(Face from, const Surface& source, Face to, Surface& target) {
    numbers(target)[to] = numbers(source)[from];
  }

 private:
  FaceNumbers& numbers(const Surface& surface) const { return numbers_->at(&surface); }
  // CGAL copies its visitor; the copies share their state.
  std::shared_ptr<std::map<const Surface*, FaceNumbers>> numbers_ =
      std::make_shared<std::map<const Surface*, FaceNumbers>>();
  std::shared_ptr<std::uint32_t> current_ = std::make_shared<std::uint32_t>(0);
};

/// Fills `surface` with the mesh; its faces are numbered from `first_number` on.
bool fill(const TriMesh& mesh, std::uint32_t first_number, Surface& surface, FaceNumbers& numbers) {
  Soup<Kernel::Point_3> soup(mesh);
  pmp::orient_polygon_soup(soup.points, soup.polygons);  // splits vertices in which several bodies touch
  if (!pmp::is_polygon_soup_a_polygon_mesh(soup.polygons)) return false;
  pmp::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, surface);
  for (const Face face : surface.faces()) numbers[face] = first_number + static_cast<std::uint32_t>(face);
  return CGAL::is_closed(surface) && pmp::does_bound_a_volume(surface);
}

/// Cleans a mesh whose groups are the numbers of the original triangles of its pieces, those of the
/// first mesh first, and assigns the first mesh's groups.
BooleanResult numbered(TriMesh mesh, const TriMesh& first, double clean_mm) {
  const auto of_first = static_cast<std::uint32_t>(first.triangles.size());
  BooleanResult result{std::move(mesh), {}};
  weld_vertices(result.mesh, clean_mm);
  remove_degenerate(result.mesh, clean_mm);
  result.mesh.groups = first.groups;
  result.mesh.group_tags = first.group_tags;
  for (std::uint32_t& group : result.mesh.group) {
    const bool of_second = group >= of_first;
    result.origin.push_back({of_second, of_second ? group - of_first : group});
    group = first.group.empty() ? 0 : first.group[of_second ? 0 : group];
  }
  return result;
}

/// True when every edge has two triangles, which agree, and none is flatter than `length_mm`.
bool is_sound(const TriMesh& mesh, double length_mm) {
  bool closed = true;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    closed = closed && !is_degenerate(mesh, t, length_mm);
  const auto uses = sorted_edge_uses(mesh);
  for_each_edge(uses, [&closed](const EdgeUse* from, const EdgeUse* to) {
    closed = closed && to - from == 2 && from[0].forward != from[1].forward;
  });
  return closed;
}

/// As numbered(), with the cleaning length for which the mesh stays closed. Where the sides of tessellated
/// coaxial or tangent solids cross at small angles, slivers lie in rows, and welding at one length folds some
/// of them onto others; a somewhat larger one takes whole rows. `wanted` is only changed by as much as is
/// needed.
BooleanResult cleaned(const TriMesh& mesh, const TriMesh& first, double wanted_mm) {
  BooleanResult result = numbered(mesh, first, wanted_mm);
  if (is_sound(result.mesh, wanted_mm)) return result;
  for (const double factor : {1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0}) {
    BooleanResult other = numbered(mesh, first, factor * wanted_mm);
    if (is_sound(other.mesh, wanted_mm)) return other;
  }
  return result;
}

}  // namespace

std::optional<BooleanResult> boolean(const TriMesh& first, const TriMesh& second, BooleanOperation operation,
                                     double clean_mm) {
  Surface a, b, out;
  NumberVisitor visitor;
  std::map<Surface*, FaceNumbers> numbers;
  for (Surface* surface : {&a, &b, &out}) {
    numbers[surface] = surface->add_property_map<Face, std::uint32_t>("f:number", 0U).first;
    visitor.watch(*surface, numbers[surface]);
  }
  const auto of_first = static_cast<std::uint32_t>(first.triangles.size());
  if (!fill(first, 0, a, numbers[&a]) || !fill(second, of_first, b, numbers[&b])) return std::nullopt;

  std::array<boost::optional<Surface*>, 4> outputs;
  const auto which = operation == BooleanOperation::unite      ? pmp::Corefinement::UNION
                     : operation == BooleanOperation::subtract ? pmp::Corefinement::TM1_MINUS_TM2
                                                               : pmp::Corefinement::INTERSECTION;
  outputs[which] = &out;
  try {
    const auto done = pmp::corefine_and_compute_boolean_operations(
        a, b, outputs, CGAL::parameters::visitor(visitor).throw_on_self_intersection(true));
    if (!done[which]) return std::nullopt;
  } catch (const pmp::Corefinement::Self_intersection_exception&) {
    return std::nullopt;
  }

  return cleaned(mesh_of(out, numbers[&out]), first, clean_mm);
}

std::optional<BooleanResult> imprint(const TriMesh& first, const TriMesh& second, double clean_mm) {
  Surface a, b;
  NumberVisitor visitor;
  std::map<Surface*, FaceNumbers> numbers;
  for (Surface* surface : {&a, &b}) {
    numbers[surface] = surface->add_property_map<Face, std::uint32_t>("f:number", 0U).first;
    visitor.watch(*surface, numbers[surface]);
  }
  if (!fill(first, 0, a, numbers[&a]) || !fill(second, 0, b, numbers[&b])) return std::nullopt;
  try {
    pmp::corefine(a, b, CGAL::parameters::visitor(visitor).throw_on_self_intersection(true));
  } catch (const pmp::Corefinement::Self_intersection_exception&) {
    return std::nullopt;
  }
  return cleaned(mesh_of(a, numbers[&a]), first, clean_mm);
}

}  // namespace scintray::mesh
