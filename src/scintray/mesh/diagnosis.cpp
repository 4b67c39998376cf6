#include "scintray/mesh/diagnosis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "scintray/mesh/detail/cgal_checks.hpp"
#include "scintray/mesh/detail/edges.hpp"

namespace scintray::mesh {
namespace {

void require_valid(const TriMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      const std::string triangle = "triangle " + std::to_string(t + 1);
      if (v >= mesh.vertices.size()) {
        throw core::InputError(core::Problem{{},
                                             triangle + " refers to vertex " + std::to_string(v) + " of " +
                                                 std::to_string(mesh.vertices.size()),
                                             ""});
      }
      if (!mesh.vertices[v].allFinite()) {
        throw core::InputError(core::Problem{{}, triangle + " has a vertex that is not finite", ""});
      }
    }
  }
}

void examine_edges(const TriMesh& mesh, MeshDiagnosis& diagnosis) {
  const auto uses = sorted_edge_uses(mesh);
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    const core::Vec3 middle = 0.5 * (mesh.vertices[first->low] + mesh.vertices[first->high]);
    const auto count = last - first;
    if (count == 1) diagnosis.open_edges.add(middle);
    if (count > 2) diagnosis.nonmanifold_edges.add(middle);
    if (count == 2 && first[0].forward == first[1].forward) diagnosis.flipped_edges.add(middle);
  });
}

void examine_triangles(const TriMesh& mesh, MeshDiagnosis& diagnosis) {
  const double length = rounding_length(mesh);
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::size_t>> sorted(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_degenerate(mesh, t, length)) diagnosis.degenerate_triangles.add(centre_of(mesh, t));
    sorted[t] = {mesh.triangles[t], t};
    std::sort(sorted[t].first.begin(), sorted[t].first.end());
    for (const std::uint32_t v : mesh.triangles[t]) diagnosis.bounds.extend(mesh.vertices[v]);
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first)
      diagnosis.duplicate_triangles.add(centre_of(mesh, sorted[i].second));
  }
}

void examine_nesting(const TriMesh& mesh, MeshDiagnosis& diagnosis) {
  std::size_t bodies = 0;
  const auto body = connected_bodies(mesh, bodies);
  const auto reversed = reversed_to_bound_a_volume(mesh);
  std::vector<char> counted(bodies);
  for (std::size_t t = 0; t < reversed.size(); ++t) {
    if (!reversed[t] || counted[body[t]]) continue;
    counted[body[t]] = 1;
    diagnosis.inverted_bodies.add(centre_of(mesh, t));
  }
}

std::string place(const core::Vec3& p) {
  std::ostringstream text;
  text << "(" << p.x() << ", " << p.y() << ", " << p.z() << ") mm";
  return text.str();
}

void turn_round(std::array<std::uint32_t, 3>& triangle) { std::swap(triangle[1], triangle[2]); }

/// Turns triangles so that they agree with the first triangle of their body across every edge that
/// has exactly two; returns whether any turned.
bool make_consistent(TriMesh& mesh) {
  struct Link {
    std::uint32_t triangle;
    bool agrees;
  };
  std::vector<std::vector<Link>> links(mesh.triangles.size());
  const auto uses = sorted_edge_uses(mesh);
  for_each_edge(uses, [&links](const EdgeUse* first, const EdgeUse* last) {
    if (last - first != 2 || first[0].triangle == first[1].triangle) return;
    const bool agrees = first[0].forward != first[1].forward;
    links[first[0].triangle].push_back({first[1].triangle, agrees});
    links[first[1].triangle].push_back({first[0].triangle, agrees});
  });
  enum class State : char { unvisited, kept, turned };
  std::vector<State> state(mesh.triangles.size(), State::unvisited);
  std::vector<std::uint32_t> stack, patch;
  bool any = false;
  for (std::size_t seed = 0; seed < state.size(); ++seed) {
    if (state[seed] != State::unvisited) continue;
    state[seed] = State::kept;
    stack.assign(1, static_cast<std::uint32_t>(seed));
    patch.clear();
    std::size_t turned = 0;
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      patch.push_back(t);
      if (state[t] == State::turned) ++turned;
      for (const Link& link : links[t]) {
        if (state[link.triangle] != State::unvisited) continue;
        state[link.triangle] = link.agrees == (state[t] == State::kept) ? State::kept : State::turned;
        stack.push_back(link.triangle);
      }
    }
    // The majority of a patch is taken to be correct.
    const State wrong = 2 * turned > patch.size() ? State::kept : State::turned;
    for (const std::uint32_t t : patch) {
      if (state[t] != wrong) continue;
      turn_round(mesh.triangles[t]);
      any = true;
    }
  }
  return any;
}

}  // namespace

double rounding_length(const TriMesh& mesh) {
  double largest = 0.0;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle)
      largest = std::max(largest, mesh.vertices[v].cwiseAbs().maxCoeff());
  }
  return std::ldexp(largest, -22);
}

bool is_degenerate(const TriMesh& mesh, std::size_t triangle, double length_mm) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  if (a == b || b == c || c == a) return true;
  const core::Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
  const double longest = std::max({(q - p).norm(), (r - q).norm(), (p - r).norm()});
  return (q - p).cross(r - p).norm() <= length_mm * longest;
}

MeshDiagnosis diagnose(const TriMesh& mesh) {
  require_valid(mesh);
  MeshDiagnosis diagnosis;
  diagnosis.vertices = mesh.vertices.size();
  diagnosis.triangles = mesh.triangles.size();
  diagnosis.area_mm2 = mesh.area();
  diagnosis.volume_mm3 = mesh.volume();
  connected_bodies(mesh, diagnosis.bodies);
  examine_triangles(mesh, diagnosis);
  examine_edges(mesh, diagnosis);
  for (const auto& pair : self_intersections(mesh))
    diagnosis.self_intersections.add(centre_of(mesh, pair.first));
  if (diagnosis.closed() && diagnosis.flipped_edges.count == 0 && diagnosis.self_intersections.count == 0 &&
      diagnosis.degenerate_triangles.count == 0) {
    examine_nesting(mesh, diagnosis);
  }
  return diagnosis;
}

std::vector<core::Problem> mesh_problems(const MeshDiagnosis& diagnosis, const std::string& part_name) {
  std::vector<core::Problem> problems;
  const auto report = [&](const Defects& defects, const std::string& one, const std::string& many,
                          const std::string& hint) {
    if (defects.count == 0) return;
    std::vector<std::array<double, 3>> places;
    for (const core::Vec3& p : defects.examples) places.push_back({p.x(), p.y(), p.z()});
    problems.push_back({{},
                        "part \"" + part_name + "\" has " + std::to_string(defects.count) + " " +
                            (defects.count == 1 ? one : many) + "; " +
                            (defects.count == 1 ? "it is at " : "the first is at ") +
                            place(defects.examples.front()),
                        hint,
                        std::move(places)});
  };
  if (diagnosis.triangles == 0) {
    problems.push_back({{}, "part \"" + part_name + "\" has no triangles", "a part needs a closed surface"});
  }
  report(diagnosis.open_edges, "open edge (of one triangle only)", "open edges (of one triangle only)",
         "the surface has holes, so the medium behind it is not defined; scintray repair fills "
         "holes");
  report(diagnosis.nonmanifold_edges, "non-manifold edge (of three or more triangles)",
         "non-manifold edges (of three or more triangles)",
         "remove inner walls and doubled faces, or make bodies that touch separate parts; scintray repair "
         "can do some of it");
  report(diagnosis.flipped_edges, "edge whose two triangles face opposite ways",
         "edges whose two triangles face opposite ways",
         "recalculate the normals to point outwards, as scintray repair does");
  report(diagnosis.degenerate_triangles, "triangle without area", "triangles without area",
         "scintray repair removes them, or merge vertices by distance in the program that made the mesh");
  report(diagnosis.self_intersections, "pair of triangles that cross or overlap",
         "pairs of triangles that cross or overlap",
         "unite overlapping bodies (scintray repair), or make them separate parts");
  report(diagnosis.inverted_bodies, "body that is inside out", "bodies that are inside out",
         "recalculate the normals to point outwards, as scintray repair does");
  if (problems.empty() && diagnosis.volume_mm3 <= 0.0) {
    problems.push_back({{},
                        "part \"" + part_name + "\" encloses no positive volume",
                        "recalculate the normals to point outwards, as scintray repair does"});
  }
  return problems;
}

bool orient_outwards(TriMesh& mesh) {
  bool any = make_consistent(mesh);
  const MeshDiagnosis diagnosis = diagnose(mesh);
  if (diagnosis.inverted_bodies.count > 0) {
    const auto reversed = reversed_to_bound_a_volume(mesh);
    for (std::size_t t = 0; t < reversed.size(); ++t) {
      if (reversed[t]) turn_round(mesh.triangles[t]);
    }
    return true;
  }
  // With defects the nesting is not defined; the sign of the volume is the best estimate.
  if (!diagnosis.outward() && mesh.volume() < 0.0) {
    for (auto& triangle : mesh.triangles) turn_round(triangle);
    any = true;
  }
  return any;
}

}  // namespace scintray::mesh
