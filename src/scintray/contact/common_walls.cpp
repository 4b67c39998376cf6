#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "scintray/contact/detail/boolean_difference.hpp"
#include "scintray/contact/detail/conformer.hpp"
#include "scintray/contact/detail/stitch.hpp"
#include "scintray/contact/neighbours.hpp"
#include "scintray/core/activity.hpp"

namespace scintray::contact {

namespace {

using Corners = std::array<core::Vec3, 3>;

Corners corners_of(const mesh::TriMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

/// The box around the triangles of each support surface.
std::vector<Eigen::AlignedBox3d> boxes_of_supports(const mesh::TriMesh& mesh) {
  std::vector<Eigen::AlignedBox3d> boxes(mesh.supports.size());
  for (std::size_t t = 0; t < mesh.support.size(); ++t)
    if (mesh.support[t] != mesh::kNoSupport)
      for (const core::Vec3& corner : corners_of(mesh, t)) boxes[mesh.support[t]].extend(corner);
  return boxes;
}

/// Search for round walls that two parts have in common.
class CommonWalls {
 public:
  CommonWalls(const std::vector<PlacedMesh>& parts, double flat_mm) : parts_(parts), flat_(flat_mm) {
    for (const PlacedMesh& part : parts) support_boxes_.push_back(boxes_of_supports(part.mesh));
  }

  /// The contact of two parts with different facets on a common wall; nothing without one.
  std::optional<ContactRule> find(std::size_t reference, std::size_t conforming) {
    const mesh::TriMesh &first = parts_[reference].mesh, &second = parts_[conforming].mesh;
    std::vector<char> of_first(first.supports.size(), 0), of_second(second.supports.size(), 0);
    bool any = false;
    for (std::uint32_t a = 0; a < of_first.size(); ++a)
      for (std::uint32_t b = 0; b < of_second.size(); ++b) {
        if (support_boxes_[reference][a].exteriorDistance(support_boxes_[conforming][b]) > flat_) continue;
        if (!are_one(first, a, second.supports[b])) continue;
        of_first[a] = of_second[b] = 1;
        any = true;
      }
    if (!any) return std::nullopt;
    constexpr double kMargin = 1.05;
    ContactRule rule;
    rule.wall_of_reference = triangles_on(first, of_first);
    rule.wall_of_conforming = triangles_on(second, of_second);
    const double deviation =
        std::max(deviation_of(first, rule.wall_of_reference), deviation_of(second, rule.wall_of_conforming));
    rule.reach = {kMargin * deviation + 2.0 * flat_, flat_};
    if (!facets_differ(reference, conforming, rule)) return std::nullopt;
    return rule;
  }

  /// Whether the part is outside of the wall.
  bool is_around(std::size_t part, const std::vector<char>& wall) const {
    const mesh::TriMesh& mesh = parts_[part].mesh;
    const auto t = static_cast<std::size_t>(std::find(wall.begin(), wall.end(), 1) - wall.begin());
    return mesh.supports[mesh.support[t]].gradient(mesh::centre_of(mesh, t)).dot(mesh.area_vector(t)) < 0.0;
  }

  /// A part has changed.
  void update(std::size_t part) {
    support_boxes_[part] = boxes_of_supports(parts_[part].mesh);
    bodies_.erase(part);
  }

 private:
  /// Whether a support surface of a mesh is another one, too.
  bool are_one(const mesh::TriMesh& mesh, std::uint32_t support, const mesh::SupportSurface& other) const {
    if (mesh.supports[support].kind() != other.kind()) return false;
    const auto t = static_cast<std::size_t>(std::find(mesh.support.begin(), mesh.support.end(), support) -
                                            mesh.support.begin());
    return t < mesh.support.size() && mesh.supports[support].agrees_with(other, corners_of(mesh, t), flat_);
  }

  static std::vector<char> triangles_on(const mesh::TriMesh& mesh, const std::vector<char>& supports) {
    std::vector<char> on;
    for (const std::uint32_t support : mesh.support)
      on.push_back(support != mesh::kNoSupport && supports[support]);
    return on;
  }

  static double deviation_of(const mesh::TriMesh& mesh, const std::vector<char>& triangles) {
    double largest = 0.0;
    for (std::size_t t = 0; t < triangles.size(); ++t)
      if (triangles[t])
        largest = std::max(
            largest, mesh::facet_deviation(mesh.supports[mesh.support[t]], corners_of(mesh, t)).distance_mm);
    return largest;
  }

  const Body& body(std::size_t part) {
    const auto known = bodies_.find(part);
    if (known != bodies_.end()) return known->second;
    return bodies_.try_emplace(part, geometry_of(parts_[part]), Eigen::Matrix3d::Identity()).first->second;
  }

  /// Whether facets of the two on a common wall are apart.
  bool facets_differ(std::size_t reference, std::size_t conforming, const ContactRule& rule) {
    const Body &first = body(reference), &second = body(conforming);
    const auto apart = [&](const Body& own, const std::vector<char>& wall, const Body& other,
                           const std::vector<char>& other_wall) {
      for (std::uint32_t t = 0; t < wall.size(); ++t) {
        if (!wall[t]) continue;
        const core::Vec3 &a = own.corner(t, 0), &b = own.corner(t, 1), &c = own.corner(t, 2);
        for (const core::Vec3& point : {core::Vec3((a + b + c) / 3.0), core::Vec3(0.5 * (a + b)),
                                        core::Vec3(0.5 * (b + c)), core::Vec3(0.5 * (c + a))}) {
          const Nearest near = nearest(other, point, own.normal[t], true, rule.reach.tolerance, &other_wall);
          if (near.found() && near.distance > flat_) return true;
        }
      }
      return false;
    };
    return apart(first, rule.wall_of_reference, second, rule.wall_of_conforming) ||
           apart(second, rule.wall_of_conforming, first, rule.wall_of_reference);
  }

  const std::vector<PlacedMesh>& parts_;
  double flat_;
  std::vector<std::vector<Eigen::AlignedBox3d>> support_boxes_;  ///< by part
  std::map<std::size_t, Body> bodies_;
};

ContactRule reversed(ContactRule rule) {
  std::swap(rule.wall_of_reference, rule.wall_of_conforming);
  return rule;
}

/// Largest distance (mm) of the corners of a part's round faces from their surfaces; infinite where its
/// surfaces are not known any more.
double corners_off_surface(const mesh::TriMesh& mesh) {
  if (mesh.supports.empty()) return HUGE_VAL;
  double largest = 0.0;
  for (std::size_t t = 0; t < mesh.support.size(); ++t)
    if (mesh.support[t] != mesh::kNoSupport)
      for (const core::Vec3& corner : corners_of(mesh, t))
        largest = std::max(largest, std::abs(mesh.supports[mesh.support[t]].distance(corner)));
  return largest;
}

/// Whether the contacts of two parts alone can be resolved.
bool fit_together(const PlacedMesh& a, const PlacedMesh& b, double flat_mm) {
  try {
    return !resolve_contacts({geometry_of(a), geometry_of(b)}, flat_mm).empty();
  } catch (const core::Error&) {
    return false;
  }
}

/// Gives two parts the same facets on their common wall, by the change that leaves corners nearest to their
/// surfaces. Returns false where none succeeds and both are as before.
bool conform_walls(PlacedMesh& inner, PlacedMesh& outer, const ContactRule& rule) {
  const Eigen::Matrix3d axes = difference_axes({inner, outer});
  const ContactRule other_way = reversed(rule);
  std::optional<std::pair<PlacedMesh, PlacedMesh>> best;
  double least = HUGE_VAL;
  const auto attempt = [&](auto&& change) {
    std::pair<PlacedMesh, PlacedMesh> changed{inner, outer};
    if (!change(changed.first, changed.second)) return;
    const double off =
        std::max(corners_off_surface(changed.first.mesh), corners_off_surface(changed.second.mesh));
    if ((best && !(off < least)) || !fit_together(changed.first, changed.second, rule.reach.flat)) return;
    least = off;
    best = std::move(changed);
  };
  attempt([&](PlacedMesh& in, PlacedMesh& out) {
    Conformer conformer(in, out, rule);
    return conformer.covered() && conformer.conform(axes).empty();
  });
  attempt([&](PlacedMesh& in, PlacedMesh& out) {
    Conformer conformer(out, in, other_way);
    return conformer.covered() && conformer.conform(axes).empty();
  });
  attempt([&](PlacedMesh& in, PlacedMesh& out) { return stitch(in, out, rule, axes).empty(); });
  attempt([&](PlacedMesh& in, PlacedMesh& out) { return stitch(out, in, other_way, axes).empty(); });
  if (!best) return false;
  std::tie(inner, outer) = std::move(*best);
  return true;
}

}  // namespace

void conform_common_walls(std::vector<PlacedMesh>& parts, const std::vector<ConformingContact>& stated,
                          double flat_mm) {
  std::vector<std::size_t> round;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (!parts[i].mesh.supports.empty()) round.push_back(i);
  if (round.size() < 2) return;
  core::report_activity("looking for round walls of two parts");
  const auto has_own_tolerance = [&](const PlacedMesh& a, const PlacedMesh& b) {
    return std::any_of(stated.begin(), stated.end(), [&](const ConformingContact& contact) {
      return (contact.first == a.name && contact.second == b.name) ||
             (contact.first == b.name && contact.second == a.name);
    });
  };
  CommonWalls walls(parts, flat_mm);
  for (std::size_t i = 0; i < round.size(); ++i)
    for (std::size_t j = i + 1; j < round.size(); ++j) {
      std::size_t inner = round[i], outer = round[j];
      if (parts[inner].diagnosis.bounds.exteriorDistance(parts[outer].diagnosis.bounds) > flat_mm) continue;
      if (has_own_tolerance(parts[inner], parts[outer])) continue;
      std::optional<ContactRule> rule = walls.find(inner, outer);
      if (!rule) continue;
      if (walls.is_around(inner, rule->wall_of_reference)) {
        std::swap(inner, outer);
        rule = reversed(*rule);
      }
      core::report_activity("facets of a common wall: " + parts[inner].name + ", " + parts[outer].name);
      if (!conform_walls(parts[inner], parts[outer], *rule)) continue;
      walls.update(inner);
      walls.update(outer);
    }
}

}  // namespace scintray::contact
