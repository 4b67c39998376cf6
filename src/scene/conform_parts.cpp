#include "scintray/scene/conform_parts.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>

#include "scintray/mesh/diagnose_in_place.hpp"
#include "scintray/scene/carve.hpp"
#include "scintray/scene/contact_geometry.hpp"

namespace scintray {

namespace {

using contact::Body;

/// How a triangle of one part lies to the other part.
enum class Facing {
  none,     ///< nowhere within the tolerance
  flat,     ///< in contact within the scene's own tolerance where it is in contact at all
  partly,   ///< here within the tolerance and there not
  covered,  ///< everywhere within it
};

/// Points of a triangle: a regular grid of 6 steps a side, its corners included.
std::vector<Vec3> samples_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr int kSteps = 6;
  std::vector<Vec3> points;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; i + j <= kSteps; ++j) points.push_back((i * a + j * b + (kSteps - i - j) * c) / kSteps);
  return points;
}
std::vector<Vec3> samples_of(const Body& body, std::uint32_t t) {
  return samples_of(body.corner(t, 0), body.corner(t, 1), body.corner(t, 2));
}

/// The triangle of `body` nearest to a point, of those within `reach` whose normal has at least (at most,
/// when `opposed`) half a right angle's cosine with `normal`.
struct Nearest {
  std::uint32_t triangle = ~0U;
  double distance = HUGE_VAL;
  bool found() const { return triangle != ~0U; }
};
Nearest nearest(const Body& body, const Vec3& point, const Vec3& normal, bool opposed, double reach) {
  constexpr double kAligned = 0.7;
  Nearest best;
  body.tree.visit(body.box_of(point, point).grown(reach), [&](std::uint32_t t) {
    const double cosine = body.normal[t].dot(normal) * (opposed ? -1.0 : 1.0);
    if (cosine < kAligned) return;
    const double d = contact::distance(point, body.corner(t, 0), body.corner(t, 1), body.corner(t, 2));
    if (d <= reach && std::pair(d, t) < std::pair(best.distance, best.triangle)) best = {t, d};
  });
  return best;
}

/// Which triangles of `body` face `other`.
std::vector<Facing> facing(const Body& body, const Body& other, double tolerance, double flat_mm) {
  std::vector<Facing> result(body.triangles.size(), Facing::none);
  std::vector<char> touched(body.triangles.size(), 0);
  std::vector<double> farthest(body.triangles.size(), 0.0);
  for (std::uint32_t t = 0; t < other.triangles.size(); ++t)
    for (const Vec3& point : samples_of(other, t))
      if (const Nearest n = nearest(body, point, other.normal[t], true, tolerance); n.found()) {
        touched[n.triangle] = 1;
        farthest[n.triangle] = std::max(farthest[n.triangle], n.distance);
      }
  for (std::uint32_t t = 0; t < body.triangles.size(); ++t) {
    std::size_t near = 0;
    const auto points = samples_of(body, t);
    for (const Vec3& point : points)
      if (const Nearest n = nearest(other, point, body.normal[t], true, tolerance); n.found()) {
        ++near;
        farthest[t] = std::max(farthest[t], n.distance);
      }
    if (near == points.size()) {
      result[t] = Facing::covered;
    } else if (near > 0 || touched[t]) {
      result[t] = farthest[t] <= flat_mm ? Facing::flat : Facing::partly;
    }
  }
  return result;
}

/// Moves vertices so that the planes of marked triangles go outwards by `by` and those of their neighbours
/// stay (least squares, weighted by area so that slivers, whose normals are rounding, have no say; nearly
/// parallel planes count as one).
TriMesh pushed(const PlacedMesh& part, const Body& body, const std::vector<char>& marked, double by) {
  constexpr double kRankThreshold = 1e-3;
  TriMesh mesh = part.mesh;
  const auto mesh_area = [&](std::uint32_t t) { return part.mesh.area_vector(t).norm(); };
  std::vector<std::vector<std::uint32_t>> around(mesh.vertices.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) around[v].push_back(t);
  for (std::uint32_t v = 0; v < around.size(); ++v) {
    if (std::none_of(around[v].begin(), around[v].end(), [&](std::uint32_t t) { return marked[t]; }))
      continue;
    Eigen::MatrixX3d planes(around[v].size(), 3);
    Eigen::VectorXd shifts(around[v].size());
    double largest = 0.0;
    for (const std::uint32_t t : around[v]) largest = std::max(largest, mesh_area(t));
    for (std::size_t k = 0; k < around[v].size(); ++k) {
      const std::uint32_t t = around[v][k];
      const double weight = std::sqrt(mesh_area(t) / largest);
      planes.row(static_cast<Eigen::Index>(k)) = weight * body.normal[t];
      shifts(static_cast<Eigen::Index>(k)) = marked[t] ? weight * by : 0.0;
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixX3d> solver;
    solver.setThreshold(kRankThreshold);
    solver.compute(planes);
    mesh.vertices[v] += solver.solve(shifts);
  }
  return mesh;
}

/// One contact: `keeper` keeps its shape and `taker` takes it over.
class Conformer {
 public:
  Conformer(const PlacedMesh& keeper, PlacedMesh& taker, double tolerance, double flat_mm)
      : keeper_(keeper),
        taker_(taker),
        tolerance_(tolerance),
        flat_(flat_mm),
        keeper_body_(geometry_of(keeper), Eigen::Matrix3d::Identity()),
        taker_body_(geometry_of(taker), Eigen::Matrix3d::Identity()),
        facing_(facing(taker_body_, keeper_body_, tolerance, flat_mm)) {}

  bool faces() const { return count(Facing::covered) > 0 || count(Facing::partly) > 0; }
  bool covered() const { return count(Facing::covered) > 0 && count(Facing::partly) == 0; }
  /// Middle of the first triangle that lies partly within the tolerance.
  Vec3 partly_at() const {
    const auto found = std::find(facing_.begin(), facing_.end(), Facing::partly);
    return centre_of(taker_.mesh, static_cast<std::size_t>(found - facing_.begin()));
  }

  /// Changes the taker. Returns why it cannot, or nothing.
  std::string conform(const Eigen::Matrix3d& axes) {
    constexpr double kPush = 2.0;  // in tolerances: past the deepest sliver, with room
    std::vector<char> contact;
    for (const Facing f : facing_) contact.push_back(f == Facing::covered);
    const TriMesh grown = pushed(taker_, taker_body_, contact, kPush * tolerance_);
    const TriMesh tool = pushed(keeper_, keeper_body_, flush_ends(), kPush * tolerance_);
    const auto cut = carve(grown, tool, axes, flat_);
    if (!cut) return "the result would be no proper solid";
    std::vector<std::uint32_t> face_of;
    double moved = 0.0;
    for (std::uint32_t t = 0; t < cut->origin.size(); ++t) {
      const TriangleOrigin& origin = cut->origin[t];
      if (!origin.of_second && contact[origin.triangle])
        return "\"" + keeper_.name + "\" is too thin there for this tolerance";
      std::uint32_t own = origin.triangle;
      if (origin.of_second) {
        const Nearest replaced = replaced_by(cut->mesh, t);
        if (!replaced.found()) return "its face would move by more than twice the tolerance";
        moved = std::max(moved, replaced.distance);
        own = replaced.triangle;
      }
      face_of.push_back(taker_.face_of[own]);
    }
    const MeshDiagnosis diagnosis = diagnose_in_place(cut->mesh);
    const auto unsound = mesh_problems(diagnosis, taker_.name);
    if (!unsound.empty()) return "afterwards " + unsound.front().what;
    taker_.notes.push_back(fmt::format(
        "took the shape of \"{}\" where they touch within {:.4g} mm: {} triangles in place of {}, moved by "
        "up to "
        "{:.2g} mm, volume {:.8g} instead of {:.8g} mm3",
        keeper_.name, tolerance_,
        std::count_if(cut->origin.begin(), cut->origin.end(), [](const auto& o) { return o.of_second; }),
        count(Facing::covered), moved, diagnosis.volume_mm3, taker_.diagnosis.volume_mm3));
    taker_.mesh = cut->mesh;
    taker_.face_of = std::move(face_of);
    taker_.diagnosis = diagnosis;
    return {};
  }

 private:
  std::ptrdiff_t count(Facing what) const { return std::count(facing_.begin(), facing_.end(), what); }

  /// Triangles of the keeper that lie in one surface with triangles of the taker: pushed outwards, the cut
  /// does not graze those.
  std::vector<char> flush_ends() const {
    std::vector<char> flush(keeper_body_.triangles.size(), 0);
    for (std::uint32_t t = 0; t < flush.size(); ++t)
      for (const Vec3& point : samples_of(keeper_body_, t))
        flush[t] |= nearest(taker_body_, point, keeper_body_.normal[t], false, tolerance_).found();
    return flush;
  }

  /// The taker's own triangle that a new one stands for, and how far the new one strays from the taker's
  /// surface.
  Nearest replaced_by(const TriMesh& mesh, std::uint32_t t) const {
    const Vec3 normal = mesh.area_vector(t).normalized();
    const auto beside = [&](const Vec3& point) {
      return nearest(taker_body_, point, normal, false, 2.0 * tolerance_);
    };
    Nearest replaced = beside(centre_of(mesh, t));
    const auto& [a, b, c] = mesh.triangles[t];
    for (const Vec3& point : samples_of(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])) {
      const Nearest here = beside(point);
      if (!here.found()) return {};
      replaced.distance = std::max(replaced.distance, here.distance);
    }
    return replaced;
  }

  const PlacedMesh& keeper_;
  PlacedMesh& taker_;
  double tolerance_, flat_;
  Body keeper_body_, taker_body_;
  std::vector<Facing> facing_;  ///< of the taker's triangles
};

void conform(PlacedMesh& first, PlacedMesh& second, const ContactSpec& spec, const Eigen::Matrix3d& axes,
             double flat_mm, Problems& problems) {
  const double tolerance = *spec.tolerance_mm;
  const auto refuse = [&](const std::string& why, const std::string& hint, const Vec3& at) {
    problems.add(
        spec.where,
        fmt::format("the contact of \"{}\" and \"{}\" cannot be closed within {:.4g} mm: {}{}{}", first.name,
                    second.name, tolerance, why, also_at(first.name, first.where, spec.where),
                    also_at(second.name, second.where, spec.where)),
        hint, {{at.x(), at.y(), at.z()}});
  };
  const Vec3 between = first.diagnosis.bounds.intersection(second.diagnosis.bounds).center();
  Conformer onto_first(first, second, tolerance, flat_mm), onto_second(second, first, tolerance, flat_mm);
  if (!onto_first.faces() && !onto_second.faces())
    return refuse("no faces of theirs face each other that closely",
                  "raise the tolerance, or remove it for flat faces", between);
  Conformer* chosen = onto_first.covered() ? &onto_first : &onto_second;
  if (!chosen->covered())
    return refuse("on either part a triangle lies partly within the tolerance and partly beyond it",
                  "raise the tolerance; or, where each part's face ends within the other's, cut one of the "
                  "faces with an edge where the other ends",
                  onto_first.partly_at());
  const std::string why = chosen->conform(axes);
  if (!why.empty())
    refuse(why, "make both parts with the same tessellation, or change the tolerance", between);
}

}  // namespace

void conform_contacts(std::vector<PlacedMesh>& parts, const std::vector<ContactSpec>& contacts,
                      double flat_mm, Problems& problems) {
  for (const ContactSpec& spec : contacts) {
    if (!spec.tolerance_mm) continue;
    const auto named = [&](std::size_t side) {
      return std::find_if(parts.begin(), parts.end(),
                          [&](const PlacedMesh& part) { return part.name == spec.between[side].name; });
    };
    const auto first = named(0), second = named(1);
    if (first == parts.end() || second == parts.end()) continue;  // reported where names are looked up
    conform(*first, *second, spec, carving_axes({*first, *second}), flat_mm, problems);
  }
}

}  // namespace scintray
