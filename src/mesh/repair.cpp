#include "scintray/mesh/repair.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "scintray/mesh/boolean.hpp"
#include "scintray/mesh/cgal_checks.hpp"
#include "scintray/mesh/edges.hpp"
#include "scintray/mesh/repair_edges.hpp"
#include "scintray/mesh/repair_holes.hpp"
#include "scintray/mesh/untangle.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray {
namespace {

/// The triangles of one body as a mesh of its own, on the same vertices.
TriMesh body_of(const TriMesh& mesh, const std::vector<std::uint32_t>& label, std::uint32_t body) {
  TriMesh result = mesh;
  std::vector<char> wanted(label.size());
  for (std::size_t t = 0; t < label.size(); ++t) wanted[t] = label[t] == body;
  keep_triangles(result, wanted);
  return result;
}

void append(TriMesh& mesh, const TriMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  mesh.group.insert(mesh.group.end(), other.group.begin(), other.group.end());
}

class Repairer {
 public:
  Repairer(TriMesh mesh, const RepairSettings& settings) : settings_(settings) {
    result_.mesh = std::move(mesh);
    result_.mesh.group.resize(result_.mesh.triangles.size(), 0);
    result_.before = diagnose(result_.mesh);
  }

  RepairedMesh run() {
    result_.after = result_.before;
    if (result_.before.sound() && settings_.weld_mm == 0.0) return std::move(result_);
    weld();
    remove_flat();
    note("duplicate triangles removed", remove_duplicates(mesh()));
    note("triangles of fins and inner walls removed", remove_fins(mesh()));
    orient("edges whose triangles disagreed, mended by turning triangles round");
    note("edges of several bodies parted", part_touching_bodies(mesh()));
    fill();
    unite_crossing_bodies();
    replace_crossings();
    remove_flat();
    orient("");
    weld_vertices(mesh(), rounding_length(mesh()));  // drops vertices that nothing uses
    result_.after = diagnose(mesh());
    return std::move(result_);
  }

 private:
  TriMesh& mesh() { return result_.mesh; }
  void note(const std::string& what, const Defects& where) {
    if (where.count > 0) result_.steps.push_back({what, where});
  }

  void weld() {
    const double length = std::max(settings_.weld_mm, rounding_length(mesh()));
    Defects where;
    where.count = weld_vertices(mesh(), length);
    note("vertices welded to others beside them", where);
  }

  void remove_flat() {
    const double length = rounding_length(mesh());
    Defects where;
    for (std::size_t t = 0; t < mesh().triangles.size(); ++t)
      if (is_degenerate(mesh(), t, length)) where.add(centre_of(mesh(), t));
    remove_degenerate(mesh(), length);
    note("triangles without area removed", where);
  }

  void orient(const std::string& what) {
    Defects where = diagnose(mesh()).flipped_edges;
    if (!orient_outwards(mesh()) || what.empty()) return;
    if (where.count > 0)
      note(what, where);
    else
      note("bodies turned inside out, as all their normals pointed inwards", inverted());
  }

  Defects inverted() const {
    Defects where;
    where.add(result_.before.bounds.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(result_.before.bounds.center()));
    return where;
  }

  void fill() {
    const double limit = settings_.largest_hole_mm > 0.0 ? settings_.largest_hole_mm
                                                         : 0.25 * result_.before.bounds.diagonal().norm();
    const HoleFilling filling = fill_holes(mesh(), limit);
    note("holes filled", filling.filled);
    const auto refuse = [&](std::size_t count, const std::string& one, const std::string& many) {
      if (count == 0) return;
      result_.refused.push_back(std::to_string(count) + " " + (count == 1 ? one : many));
    };
    std::ostringstream sizes;
    sizes << " larger than the limit of " << limit << " mm (the largest is " << filling.largest_mm
          << " mm across)";
    refuse(filling.too_large.count, "hole stays open:" + sizes.str(), "holes stay open:" + sizes.str());
    refuse(filling.without_cover.count, "hole could not be covered", "holes could not be covered");
    refuse(filling.sheets, "open sheet encloses nothing: what lies behind it cannot be known",
           "open sheets enclose nothing: what lies behind them cannot be known");
  }

  /// Two bodies that cross or touch become one, as long as there are such two that CGAL can unite.
  void unite_crossing_bodies() {
    Defects united;
    std::set<std::pair<std::size_t, std::size_t>> refused;  // by numbers of triangles: labels change
    for (;;) {
      const auto crossings = self_intersections(mesh());
      if (crossings.empty()) break;
      std::size_t bodies = 0;
      const auto label = connected_bodies(mesh(), bodies);
      bool changed = false;
      for (const auto& [s, t] : crossings) {
        if (label[s] == label[t]) continue;
        const TriMesh a = body_of(mesh(), label, label[s]), b = body_of(mesh(), label, label[t]);
        if (refused.count(std::minmax(a.triangles.size(), b.triangles.size())) > 0) continue;
        const auto whole = unite(a, b);
        if (!whole) {
          refused.insert(std::minmax(a.triangles.size(), b.triangles.size()));
          continue;
        }
        united.add(centre_of(mesh(), s));
        std::vector<char> wanted(label.size());
        for (std::size_t i = 0; i < label.size(); ++i)
          wanted[i] = label[i] != label[s] && label[i] != label[t];
        keep_triangles(mesh(), wanted);
        append(mesh(), *whole);
        changed = true;
        break;
      }
      if (!changed) break;
    }
    note("pairs of bodies that cross or touch united", united);
    if (!refused.empty())
      result_.refused.push_back(
          "bodies that cross or touch could not be united: one of them is open or crosses itself, or they "
          "touch along edges only");
  }

  static std::optional<TriMesh> unite(const TriMesh& a, const TriMesh& b) {
    if (!diagnose(a).sound() || !diagnose(b).sound()) return std::nullopt;
    const double clean = std::max(rounding_length(a), rounding_length(b));
    auto whole = boolean(a, b, BooleanOperation::unite, clean);
    if (!whole) return std::nullopt;
    for (std::size_t t = 0; t < whole->origin.size(); ++t) {
      const TriangleOrigin& origin = whole->origin[t];
      whole->mesh.group[t] = (origin.of_second ? b : a).group[origin.triangle];
    }
    return std::move(whole->mesh);
  }

  void replace_crossings() {
    const MeshDiagnosis now = diagnose(mesh());
    if (now.self_intersections.count == 0 || !now.closed() || now.flipped_edges.count > 0) return;
    if (auto better = untangled(mesh()); better && diagnose(*better).sound()) {
      mesh() = std::move(*better);
      note("pairs of crossing triangles replaced, with some around them", now.self_intersections);
    } else {
      result_.refused.push_back("the triangles that cross could not be replaced (CGAL refuses)");
    }
  }

  RepairSettings settings_;
  RepairedMesh result_;
};

}  // namespace

RepairedMesh repair_mesh(TriMesh mesh, const RepairSettings& settings) {
  return Repairer(std::move(mesh), settings).run();
}

}  // namespace scintray
