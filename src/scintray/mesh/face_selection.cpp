#include "scintray/mesh/face_selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scintray/core/error.hpp"
#include "scintray/mesh/detail/edges.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/triangle_distance.hpp"

namespace scintray::mesh {
namespace {

constexpr auto kUnlabelled = std::numeric_limits<std::uint32_t>::max();

/// Unit normals; zero for triangles without area.
std::vector<core::Vec3> unit_normals(const TriMesh& mesh) {
  std::vector<core::Vec3> normals(mesh.triangles.size());
  for (std::size_t t = 0; t < normals.size(); ++t) {
    const core::Vec3 area = mesh.area_vector(t);
    const double length = area.norm();
    normals[t] = length > 0.0 ? core::Vec3(area / length) : core::Vec3(core::Vec3::Zero());
  }
  return normals;
}

/// Growth of flat regions; used to label all triangles and to select one region.
class FlatRegionGrower {
 public:
  FlatRegionGrower(const TriMesh& mesh, double angle_tolerance_rad)
      : mesh_(mesh),
        neighbours_(mesh),
        normals_(unit_normals(mesh)),
        rounding_mm_(rounding_length(mesh)),
        tolerance_(angle_tolerance_rad) {
    if (!(angle_tolerance_rad >= 0.0)) {
      throw core::InputError(
          core::Problem{{}, "a negative angle tolerance for a flat region", "give an angle such as 0.1 deg"});
    }
  }

  /// Assigns `label` to the unlabelled triangles of the region that starts at `seed`.
  void grow(std::uint32_t seed, std::uint32_t label, std::vector<std::uint32_t>& labels) {
    labels[seed] = label;
    stack_.assign(1, seed);
    while (!stack_.empty()) {
      const std::uint32_t t = stack_.back();
      stack_.pop_back();
      for (auto* n = neighbours_.begin(t); n != neighbours_.end(t); ++n) {
        if (labels[*n] != kUnlabelled || !same_plane(seed, *n)) continue;
        labels[*n] = label;
        stack_.push_back(*n);
      }
    }
  }

 private:
  bool same_plane(std::uint32_t seed, std::uint32_t t) const {
    const core::Vec3& normal = normals_[seed];
    if (normal.isZero()) return false;
    if (!normals_[t].isZero() && angle_between(normal, normals_[t]) <= tolerance_) return true;
    // A sliver's own normal is mostly rounding; its vertices define its plane better.
    if (normals_[t].dot(normal) < 0.0) return false;
    const core::Vec3& origin = mesh_.vertices[mesh_.triangles[seed][0]];
    return std::all_of(mesh_.triangles[t].begin(), mesh_.triangles[t].end(), [&](std::uint32_t v) {
      return std::abs((mesh_.vertices[v] - origin).dot(normal)) <= rounding_mm_;
    });
  }

  const TriMesh& mesh_;
  TriangleNeighbours neighbours_;
  std::vector<core::Vec3> normals_;
  double rounding_mm_;
  double tolerance_;
  std::vector<std::uint32_t> stack_;
};

template <typename Condition>
void keep_where(std::vector<char>& mask, Condition condition) {
  for (std::size_t t = 0; t < mask.size(); ++t) mask[t] = mask[t] && condition(t);
}

void apply_normal(const TriMesh& mesh, const core::Vec3& normal, double tolerance_rad,
                  std::vector<char>& mask) {
  if (!normal.allFinite() || normal.isZero()) {
    throw core::InputError(core::Problem{
        {}, "a normal of length zero selects no direction", "give a direction such as [0, 0, 1]"});
  }
  if (!(tolerance_rad >= 0.0)) {
    throw core::InputError(
        core::Problem{{}, "a negative angle tolerance for a normal", "give an angle such as 1 deg"});
  }
  const auto normals = unit_normals(mesh);
  keep_where(mask, [&](std::size_t t) {
    return !normals[t].isZero() && angle_between(normals[t], normal) <= tolerance_rad;
  });
}

bool group_matches(const std::string& group, const std::string& wanted) {
  if (group == wanted) return true;
  const std::size_t n = wanted.size();
  if (n == 0 || group.size() < n + 2) return false;
  return (group.starts_with(wanted) && group[n] == ':') ||
         (group.ends_with(wanted) && group[group.size() - n - 1] == ':');
}

bool has_tag(const FaceTags& tags, const std::string& key, const std::string& value) {
  const auto found = tags.find(key);
  return found != tags.end() && found->second == value;
}

template <typename Condition>
void keep_groups(const TriMesh& mesh, std::vector<char>& mask, Condition condition) {
  std::vector<char> matches(mesh.groups.size());
  for (std::size_t g = 0; g < matches.size(); ++g) matches[g] = condition(g);
  keep_where(mask, [&](std::size_t t) {
    return t < mesh.group.size() && mesh.group[t] < matches.size() && matches[mesh.group[t]];
  });
}

void apply_group(const TriMesh& mesh, const std::string& wanted, std::vector<char>& mask) {
  keep_groups(mesh, mask, [&](std::size_t g) {
    return group_matches(mesh.groups[g], wanted) || has_tag(mesh.tags_of(g), "face", wanted);
  });
}

void apply_tags(const TriMesh& mesh, const FaceTags& wanted, std::vector<char>& mask) {
  keep_groups(mesh, mask, [&](std::size_t g) {
    return std::all_of(wanted.begin(), wanted.end(),
                       [&](const auto& tag) { return has_tag(mesh.tags_of(g), tag.first, tag.second); });
  });
}

void apply_box(const TriMesh& mesh, Eigen::AlignedBox3d box, std::vector<char>& mask) {
  const core::Vec3 slack = core::Vec3::Constant(rounding_length(mesh));
  const core::Vec3 low = box.min() - slack, high = box.max() + slack;
  keep_where(mask, [&](std::size_t t) {
    return std::all_of(mesh.triangles[t].begin(), mesh.triangles[t].end(), [&](std::uint32_t v) {
      const auto& p = mesh.vertices[v].array();
      return (p >= low.array()).all() && (p <= high.array()).all();
    });
  });
}

void apply_flat_region(const TriMesh& mesh, const core::Vec3& point, double tolerance_rad,
                       std::vector<char>& mask) {
  std::vector<std::uint32_t> labels(mesh.triangles.size(), kUnlabelled);
  FlatRegionGrower(mesh, tolerance_rad)
      .grow(static_cast<std::uint32_t>(nearest_triangle(mesh, point)), 0, labels);
  keep_where(mask, [&](std::size_t t) { return labels[t] == 0; });
}

void apply_smooth_region(const TriMesh& mesh, const FaceSelector& selector, std::vector<char>& mask) {
  const std::vector<std::uint32_t> labels = smooth_regions(mesh, selector.edge_angle_rad);
  const auto keep_regions_of = [&](const std::vector<char>& seeds) {
    const std::vector<char> regions = whole_regions(seeds, labels);
    keep_where(mask, [&](std::size_t t) { return regions[t]; });
  };
  if (selector.smooth_region) {
    std::vector<char> seed(mask.size(), 0);
    seed[nearest_triangle(mesh, *selector.smooth_region)] = 1;
    keep_regions_of(seed);
  }
  if (selector.smooth_around) {
    std::vector<char> seeds(mask.size(), 1);
    apply_group(mesh, *selector.smooth_around, seeds);
    keep_regions_of(seeds);
  }
}

/// The least member of the set of `t`; halves the path to it (path halving).
std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t t) {
  while (parent[t] != t) t = parent[t] = parent[parent[t]];
  return t;
}

}  // namespace

std::size_t nearest_triangle(const TriMesh& mesh, const core::Vec3& point) {
  if (mesh.triangles.empty()) {
    throw core::InputError(core::Problem{{}, "no triangle is nearest in a mesh without triangles", ""});
  }
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const double distance = distance_to_triangle(point, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    if (distance < least) {
      least = distance;
      nearest = t;
    }
  }
  return nearest;
}

std::vector<std::uint32_t> flat_regions(const TriMesh& mesh, double angle_tolerance_rad) {
  std::vector<std::uint32_t> labels(mesh.triangles.size(), kUnlabelled);
  FlatRegionGrower grower(mesh, angle_tolerance_rad);
  std::uint32_t next = 0;
  for (std::size_t t = 0; t < labels.size(); ++t) {
    if (labels[t] == kUnlabelled) grower.grow(static_cast<std::uint32_t>(t), next++, labels);
  }
  return labels;
}

std::vector<std::uint32_t> smooth_regions(const TriMesh& mesh, double edge_angle_rad, bool by_group) {
  if (!(edge_angle_rad >= 0.0))
    throw core::InputError(core::Problem{
        {}, "a negative angle at the edges of a smooth region", "give an angle such as 30 deg"});
  std::vector<core::Vec3> area(mesh.triangles.size());
  for (std::size_t t = 0; t < area.size(); ++t) area[t] = mesh.area_vector(t);
  const auto group_of = [&](std::uint32_t t) { return t < mesh.group.size() ? mesh.group[t] : 0; };
  std::vector<std::uint32_t> parent(area.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for_each_edge(sorted_edge_uses(mesh), [&](const EdgeUse* first, const EdgeUse* last) {
    for (const EdgeUse* one = first; one != last; ++one)
      for (const EdgeUse* other = one + 1; other != last; ++other) {
        const std::uint32_t a = one->triangle, b = other->triangle;
        if (by_group && group_of(a) != group_of(b)) continue;
        if (angle_between(area[a], area[b]) > edge_angle_rad) continue;
        const std::uint32_t root_a = root_of(parent, a), root_b = root_of(parent, b);
        parent[std::max(root_a, root_b)] = std::min(root_a, root_b);
      }
  });
  std::vector<std::uint32_t> labels(area.size());
  std::uint32_t next = 0;
  for (std::uint32_t t = 0; t < labels.size(); ++t) {
    const std::uint32_t root = root_of(parent, t);
    labels[t] = root == t ? next++ : labels[root];
  }
  return labels;
}

std::vector<char> whole_regions(const std::vector<char>& mask, const std::vector<std::uint32_t>& labels) {
  std::vector<char> selected(labels.size(), 0);
  for (std::size_t t = 0; t < mask.size(); ++t)
    if (mask[t]) selected[labels[t]] = 1;
  std::vector<char> result(mask.size());
  for (std::size_t t = 0; t < mask.size(); ++t) result[t] = selected[labels[t]];
  return result;
}

std::vector<char> select_triangles(const TriMesh& mesh, const FaceSelector& selector) {
  std::vector<char> mask(mesh.triangles.size(), 1);
  if (selector.normal) apply_normal(mesh, *selector.normal, selector.normal_tolerance_rad, mask);
  if (selector.box) apply_box(mesh, *selector.box, mask);
  if (selector.group) apply_group(mesh, *selector.group, mask);
  if (!selector.tags.empty()) apply_tags(mesh, selector.tags, mask);
  if (selector.flat_region && !mask.empty()) {
    apply_flat_region(mesh, *selector.flat_region, selector.flat_tolerance_rad, mask);
  }
  if ((selector.smooth_region || selector.smooth_around) && !mask.empty())
    apply_smooth_region(mesh, selector, mask);
  if (selector.nearest && !mask.empty()) {
    const std::size_t nearest = nearest_triangle(mesh, *selector.nearest);
    keep_where(mask, [nearest](std::size_t t) { return t == nearest; });
  }
  return mask;
}

}  // namespace scintray::mesh
