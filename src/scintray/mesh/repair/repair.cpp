#include "scintray/mesh/repair/repair.hpp"
#include "scintray/mesh/degenerate.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "scintray/core/activity.hpp"
#include "scintray/mesh/boolean.hpp"
#include "scintray/mesh/detail/cgal_checks.hpp"
#include "scintray/mesh/detail/edges.hpp"
#include "scintray/mesh/repair/detail/passes.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::mesh {
namespace {

void append(TriMesh& mesh, const TriMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  mesh.group.insert(mesh.group.end(), other.group.begin(), other.group.end());
}

class Repairer {
  using Crossings = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

 public:
  Repairer(TriMesh mesh, const RepairSettings& settings) : settings_(settings) {
    result_.mesh = std::move(mesh);
    result_.mesh.group.resize(result_.mesh.triangles.size(), 0);
    core::report_activity("repairing: examining the mesh");
    result_.before = diagnose(result_.mesh);
  }

  RepairedMesh run() {
    result_.after = result_.before;
    if (result_.before.sound() && settings_.weld_mm == 0.0) return std::move(result_);
    constexpr std::size_t kRepairSteps = 6;
    weld();
    remove_flat();
    core::report_activity("repairing: edges", 1, kRepairSteps);
    clear_edges();
    core::report_activity("repairing: holes", 2, kRepairSteps);
    fill();
    clear_edges();  // covers of adjacent holes can touch
    core::report_activity("repairing: bodies and triangles that cross", 3, kRepairSteps);
    resolve_crossings();
    core::report_activity("repairing: orientation", 4, kRepairSteps);
    remove_flat();
    orient("");
    weld_vertices(mesh(), rounding_length(mesh()));  // removes vertices that nothing uses
    core::report_activity("repairing: examining the result", 5, kRepairSteps);
    result_.after = diagnose(mesh());
    return std::move(result_);
  }

 private:
  TriMesh& mesh() { return result_.mesh; }
  void note(const std::string& what, const Defects& where) {
    if (where.count == 0) return;
    const auto known = std::find_if(result_.steps.begin(), result_.steps.end(),
                                    [&](const RepairStep& step) { return step.what == what; });
    if (known == result_.steps.end()) {
      result_.steps.push_back({what, where});
      return;
    }
    for (const core::Vec3& place : where.examples) known->where.add(place);
    known->where.count += where.count - where.examples.size();
  }

  void clear_edges() {
    note("duplicate triangles removed", remove_duplicates(mesh()));
    note("triangles of fins and inner walls removed", remove_fins(mesh()));
    orient("edges whose triangles disagreed, mended by turning triangles round");
    note("edges of several bodies parted", part_touching_bodies(mesh()));
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
    const Defects where = edge_defects(mesh()).flipped_edges;
    if (!orient_outwards(mesh()) || what.empty()) return;
    if (where.count > 0)
      note(what, where);
    else
      note("meshes that were inside out turned", inverted());
  }

  Defects inverted() const {
    Defects where;
    where.add(result_.before.bounds.isEmpty() ? core::Vec3(core::Vec3::Zero())
                                              : core::Vec3(result_.before.bounds.center()));
    return where;
  }

  void fill() {
    const double limit = settings_.largest_hole_mm > 0.0 ? settings_.largest_hole_mm
                                                         : 0.25 * result_.before.bounds.diagonal().norm();
    const HoleFilling filling = fill_holes(mesh(), limit);
    note("holes filled", filling.filled);
    std::ostringstream sizes;
    sizes << " larger than the limit of " << limit << " mm (the largest is " << filling.largest_mm
          << " mm across)";
    refuse(filling.too_large.count, "hole stays open:" + sizes.str(), "holes stay open:" + sizes.str());
    refuse(filling.without_cover.count, "hole could not be covered", "holes could not be covered");
    refuse(filling.sheets, "open sheet encloses nothing: the medium behind it is not defined",
           "open sheets enclose nothing: the medium behind them is not defined");
  }

  /// Bodies of one mesh, and the pairs that cross or touch.
  struct Bodies {
    std::vector<TriMesh> body;
    std::vector<Crossings> tangled;  ///< pairs of triangles of one body that cross, by their numbers in it
    std::map<std::pair<std::uint32_t, std::uint32_t>, core::Vec3>
        first_contact;  ///< where each pair of bodies first does
  };

  Bodies take_apart(const Crossings& crossings) {
    Bodies bodies;
    std::size_t count = 0;
    const auto label = connected_bodies(mesh(), count);
    bodies.body.resize(count);
    for (TriMesh& body : bodies.body) {
      body.groups = mesh().groups;
      body.group_tags = mesh().group_tags;
    }
    // Bodies may share a vertex: each gets its own, so that the cost is that of the mesh, however many there
    // are.
    constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::vector<std::uint32_t>> triangles_of(count);
    std::vector<std::uint32_t> number(label.size());  // within its body
    for (std::uint32_t t = 0; t < label.size(); ++t) {
      number[t] = static_cast<std::uint32_t>(triangles_of[label[t]].size());
      triangles_of[label[t]].push_back(t);
    }
    std::vector<std::uint32_t> own(mesh().vertices.size(), kNone), touched;
    for (std::uint32_t b = 0; b < count; ++b) {
      TriMesh& body = bodies.body[b];
      touched.clear();
      for (const std::uint32_t t : triangles_of[b])
        for (const std::uint32_t v : mesh().triangles[t])
          if (own[v] == kNone) {
            own[v] = 0;
            touched.push_back(v);
          }
      std::sort(touched.begin(), touched.end());
      for (const std::uint32_t v : touched) {
        own[v] = static_cast<std::uint32_t>(body.vertices.size());
        body.vertices.push_back(mesh().vertices[v]);
      }
      for (const std::uint32_t t : triangles_of[b]) {
        const auto& [i, j, k] = mesh().triangles[t];
        body.triangles.push_back({own[i], own[j], own[k]});
        body.group.push_back(mesh().group[t]);
      }
      for (const std::uint32_t v : touched) own[v] = kNone;
    }
    bodies.tangled.resize(count);
    for (const auto& [s, t] : crossings) {
      if (label[s] == label[t])
        bodies.tangled[label[s]].emplace_back(number[s], number[t]);
      else
        bodies.first_contact.try_emplace(std::minmax(label[s], label[t]), centre_of(mesh(), s));
    }
    return bodies;
  }

  /// Removes crossings within single bodies, then unites bodies that cross or touch.
  void resolve_crossings() {
    const auto crossings = self_intersections(mesh());
    if (crossings.empty()) return;
    Bodies bodies = take_apart(crossings);
    turn_outwards(bodies);
    untangle(bodies);
    unite(bodies);
    TriMesh whole;
    whole.groups = mesh().groups;
    whole.group_tags = mesh().group_tags;
    for (const TriMesh& body : bodies.body) append(whole, body);
    mesh() = std::move(whole);
  }

  /// A body that lies in no other one's box is no cavity: its normals have to point outwards.
  void turn_outwards(Bodies& bodies) {
    Defects turned;
    std::vector<Eigen::AlignedBox3d> box;
    for (const TriMesh& body : bodies.body) {
      box.emplace_back();
      for (const core::Vec3& vertex : body.vertices) box.back().extend(vertex);
    }
    for (std::size_t b = 0; b < box.size(); ++b) {
      const bool inner = std::any_of(box.begin(), box.end(), [&](const Eigen::AlignedBox3d& other) {
        return &other != &box[b] && other.contains(box[b]);
      });
      if (inner || bodies.body[b].volume() >= 0.0 || !edge_defects(bodies.body[b]).closed()) continue;
      reverse_orientation(bodies.body[b]);
      turned.add(box[b].center());
    }
    note("bodies that were inside out turned", turned);
  }

  void untangle(Bodies& bodies) {
    Defects replaced, left_out;
    std::size_t refused = 0;
    double farthest_mm = 0.0;
    for (std::size_t b = 0; b < bodies.body.size(); ++b) {
      if (bodies.tangled[b].empty()) continue;
      const auto better = crossing_free(bodies.body[b], bodies.tangled[b]);
      if (!better) {
        ++refused;
        continue;
      }
      for (const auto& pair : bodies.tangled[b]) replaced.add(centre_of(bodies.body[b], pair.first));
      for (std::size_t i = 0; i < better->left_out.count; ++i)
        left_out.add(better->left_out.examples[std::min(i, better->left_out.examples.size() - 1)]);
      farthest_mm = std::max(farthest_mm, better->farthest_mm);
      bodies.body[b] = better->mesh;
    }
    note("pairs of crossing triangles replaced, with some around them", replaced);
    std::ostringstream where;
    where << "vertices left out where triangles crossed, at most " << farthest_mm
          << " mm from what is there now";
    note(where.str(), left_out);
    refuse(refused, "body crosses itself in a way that cannot be mended",
           "bodies cross themselves in a way that cannot be mended");
  }

  /// A closed body without its crossings; nothing when that does not succeed.
  static std::optional<CrossFree> crossing_free(const TriMesh& body, const Crossings& crossings) {
    if (!edge_defects(body).closed()) return std::nullopt;
    CrossFree better = without_crossings(body, crossings);
    if (better.remaining == 0) {
      const MeshDiagnosis edges = edge_defects(better.mesh);
      if (edges.closed() && edges.flipped_edges.count == 0 && better.mesh.volume() > 0.0) return better;
    }
    // Crossings beyond this are no local defect, and CGAL takes minutes to find that it cannot repair them;
    // its time grows faster than the square of a vertex's number of edges.
    constexpr std::size_t kMostCrossings = 2000, kMostEdges = 500;
    std::vector<std::size_t> edges(body.vertices.size());
    for (const auto& triangle : body.triangles)
      for (const std::uint32_t v : triangle) ++edges[v];
    if (crossings.size() > kMostCrossings || *std::max_element(edges.begin(), edges.end()) > kMostEdges)
      return std::nullopt;
    core::report_activity("repairing: cutting out triangles that cross, by CGAL");
    const auto other = untangled(body);
    if (!other || !diagnose(*other).sound()) return std::nullopt;
    return CrossFree{*other, {}, 0.0, 0, 0};
  }

  void unite(Bodies& bodies) {
    std::vector<std::uint32_t> part_of(bodies.body.size());
    std::iota(part_of.begin(), part_of.end(), 0U);
    const auto find = [&](std::uint32_t b) {
      while (part_of[b] != b) b = part_of[b];
      return b;
    };
    Defects united;
    std::size_t refused = 0;
    for (const auto& [pair, place] : bodies.first_contact) {
      const std::uint32_t a = find(pair.first), b = find(pair.second);
      if (a == b) continue;
      if (auto one = united_body(bodies.body[a], bodies.body[b])) {
        bodies.body[a] = std::move(*one);
        bodies.body[b] = {};
        part_of[b] = a;
        united.add(place);
      } else {
        ++refused;
      }
    }
    note("pairs of bodies that cross or touch united", united);
    const std::string why = " not be united: one is open or crosses itself, or they touch along edges only";
    refuse(refused, "pair of bodies that cross or touch could" + why,
           "pairs of bodies that cross or touch could" + why);
  }

  static std::optional<TriMesh> united_body(const TriMesh& a, const TriMesh& b) {
    if (!diagnose(a).sound() || !diagnose(b).sound()) return std::nullopt;
    auto whole = boolean(a, b, BooleanOperation::unite, std::max(rounding_length(a), rounding_length(b)));
    if (!whole) return std::nullopt;
    for (std::size_t t = 0; t < whole->origin.size(); ++t) {
      const TriangleOrigin& origin = whole->origin[t];
      whole->mesh.group[t] = (origin.of_second ? b : a).group[origin.triangle];
    }
    return std::move(whole->mesh);
  }

  void refuse(std::size_t count, const std::string& one, const std::string& many) {
    if (count > 0) result_.refused.push_back(std::to_string(count) + " " + (count == 1 ? one : many));
  }

  RepairSettings settings_;
  RepairedMesh result_;
};

}  // namespace

RepairedMesh repair_mesh(TriMesh mesh, const RepairSettings& settings) {
  return Repairer(std::move(mesh), settings).run();
}

}  // namespace scintray::mesh
