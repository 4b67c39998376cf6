#include "scintray/scene/accelerator.hpp"
#include "scintray/scene/detail/build_steps.hpp"
#include "scintray/scene/detail/round_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace scintray::scene {

namespace {

/// Tolerance (mm) within which vertices are equal in the comparison of boundaries.
constexpr double kSameVertex_mm = 1e-6;
/// Keeps round coordinates away from the edges of the comparison grid.
constexpr double kGridShift = 0.37;

using GridPoint = std::array<std::int64_t, 3>;
using GridTriangle = std::array<GridPoint, 3>;

/// A boundary triangle in the region's frame, with its order and identity.
struct Entry {
  GridTriangle key;
  BoundaryTriangle local;
  BoundaryLink link;
  core::PartId body, other;  ///< the part whose face it is, and that on the other side of it
  std::uint32_t support;     ///< in the part's list
  bool exact;                ///< on an exact body
  std::size_t index;         ///< of the interface triangle
};

/// The properties in which equal boundaries agree.
struct Shape {
  std::vector<GridTriangle> triangles;
  std::vector<std::uint32_t> labels;
  std::vector<std::uint32_t> exact;  ///< triangles on exact bodies; bodies may differ where triangles do not
  auto operator<=>(const Shape&) const = default;
};

GridPoint on_grid(const core::Vec3& v) {
  GridPoint point;
  for (int axis = 0; axis < 3; ++axis)
    point[static_cast<std::size_t>(axis)] = std::llround(std::floor(v[axis] / kSameVertex_mm + kGridShift));
  return point;
}

/// An entry of an interface triangle, with all but its place.
/// @param index  of the triangle
Entry entry_of(const contact::InterfaceTriangle& t, std::size_t index, core::InterfaceId interface,
               bool is_back) {
  const bool of_back = t.back_face.has_value() && (is_back || !t.front_face.has_value());
  Entry entry;
  entry.index = index;
  entry.link = {interface, core::MediumId::none(), is_back};
  entry.body = of_back ? t.back : t.front;
  entry.other = of_back ? t.front : t.back;
  entry.support = of_back ? t.back_support : t.front_support;
  entry.exact = false;
  return entry;
}

void place(Entry& entry, BoundaryTriangle local) {
  GridTriangle key{on_grid(local[0]), on_grid(local[1]), on_grid(local[2])};
  const auto first = std::min_element(key.begin(), key.end()) - key.begin();
  std::rotate(key.begin(), key.begin() + first, key.end());
  std::rotate(local.begin(), local.begin() + first, local.end());
  entry.key = key;
  entry.local = local;
}

/// Numbers of the interfaces of the triangles, in order of first appearance.
std::vector<std::uint32_t> pattern_of(const std::vector<Entry>& entries) {
  std::map<std::pair<core::InterfaceId, bool>, std::uint32_t> seen;
  std::vector<std::uint32_t> labels;
  for (const Entry& entry : entries)
    labels.push_back(seen.try_emplace({entry.link.interface, entry.link.from_back},
                                      static_cast<std::uint32_t>(seen.size()))
                         .first->second);
  return labels;
}

/// Triangles of a region's boundary: the index of each, and whether the region is at its back.
using RegionTriangles = std::vector<std::pair<std::size_t, bool>>;

core::IdVector<core::RegionId, RegionTriangles> triangles_by_region(
    const std::vector<contact::InterfaceTriangle>& triangles, std::size_t regions) {
  core::IdVector<core::RegionId, RegionTriangles> by_region(regions);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    by_region[region_of(triangles[i].back)].push_back({i, true});
    by_region[region_of(triangles[i].front)].push_back({i, false});
  }
  return by_region;
}

std::vector<RegionTriangle> region_triangles(const std::vector<Entry>& entries,
                                             const std::vector<std::uint32_t>& labels) {
  std::vector<RegionTriangle> result;
  for (std::size_t i = 0; i < entries.size(); ++i)
    result.push_back({entries[i].local, labels[i], entries[i].body, entries[i].other, entries[i].support});
  return result;
}

/// Finds the triangles of the region of `of` that are on exact bodies. @return whether it has any
bool find_exact(const PartBodies& bodies, core::PartId of, std::vector<Entry>& entries) {
  if (bodies.empty() || !needs_exact_bodies(bodies, of, region_triangles(entries, pattern_of(entries))))
    return false;
  for (Entry& entry : entries) entry.exact = on_exact_body(bodies, of, entry.body);
  return true;
}

/// The two places of each interface triangle: in the boundaries of the regions at its back and front.
class Twins {
 public:
  explicit Twins(std::size_t triangles) : of_back_(triangles), of_front_(triangles) {}

  /// @param link    its number in SceneRecords::links
  /// @param number  of the triangle in its region's boundary
  void add(const Entry& entry, std::size_t link, std::uint32_t number) {
    (entry.link.from_back ? of_back_ : of_front_)[entry.index] = {link, number};
  }
  /// As of SceneRecords.
  std::vector<std::uint32_t> of_links() const {
    std::vector<std::uint32_t> twins(2 * of_back_.size());
    for (std::size_t i = 0; i < of_back_.size(); ++i) {
      twins[of_back_[i].link] = of_front_[i].number;
      twins[of_front_[i].link] = of_back_[i].number;
    }
    return twins;
  }

 private:
  struct Place {
    std::size_t link = 0;
    std::uint32_t number = 0;
  };
  std::vector<Place> of_back_, of_front_;
};

/// Sets BoundaryLink::smooth_to, which requires all regions.
void link_smooth_media(Scene& scene) {
  for (BoundaryLink& link : scene.links) {
    const Interface& interface = scene.interfaces[link.interface];
    if (interface.plain && !scene.keeps_phases)
      link.smooth_to = scene.regions[link.from_back ? interface.front : interface.back].medium;
  }
}

}  // namespace

void build_regions(const Assembly& assembly, const std::vector<contact::InterfaceTriangle>& triangles,
                   const std::vector<core::InterfaceId>& interface_of, const PartBodies& bodies,
                   Scene& scene) {
  const auto by_region = triangles_by_region(triangles, assembly.parts.size() + 1);
  std::map<Shape, core::AcceleratorId> known;
  Twins twins(triangles.size());
  const auto build = [&](core::PartId of) {
    const AssemblyPart* const part = of.has_value() ? &assembly.parts[of] : nullptr;
    const RegionTriangles& own = by_region[region_of(of)];
    Region region;
    scene.region_names.push_back(part ? part->geometry.name : "ambient");
    region.part = of;
    region.medium = part ? part->medium : assembly.ambient;
    const Eigen::Matrix3d rotation = part ? part->rotation : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    region.rotation = rotation;
    region.rotated = !rotation.isIdentity(0.0);

    Eigen::AlignedBox3d bounds;  // in the part's own orientation
    for (const auto& [index, is_back] : own)
      for (const core::Vec3& vertex : triangles[index].vertex) bounds.extend(rotation.transpose() * vertex);
    if (!bounds.isEmpty()) region.centre = rotation * bounds.center();

    std::vector<Entry> entries;
    for (const auto& [index, is_back] : own) {
      BoundaryTriangle local;
      for (std::size_t i = 0; i < 3; ++i)
        local[i] = rotation.transpose() * (triangles[index].vertex[i] - region.centre);
      if (!is_back) std::swap(local[1], local[2]);
      entries.push_back(entry_of(triangles[index], index, interface_of[index], is_back));
      place(entries.back(), local);
    }
    region.curved = find_exact(bodies, of, entries);
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      return a.exact != b.exact ? b.exact : a.key < b.key;
    });

    Shape shape;
    std::vector<BoundaryTriangle> boundary;
    region.first_link = static_cast<std::uint32_t>(scene.links.size());
    shape.labels = pattern_of(entries);
    for (const Entry& entry : entries) {
      shape.triangles.push_back(entry.key);
      shape.exact.push_back(entry.exact ? 1 : 0);
      twins.add(entry, scene.links.size(), static_cast<std::uint32_t>(boundary.size()));
      boundary.push_back(entry.local);
      scene.links.push_back(entry.link);
    }
    region.accelerator = scene.accelerators.next_id();
    bool is_new = true;
    if (part) {
      const auto shared = known.try_emplace(shape, region.accelerator);
      region.accelerator = shared.first->second;
      is_new = shared.second;
    }
    if (is_new) {
      ExactBodies exact;
      if (region.curved)
        exact =
            exact_bodies_of(bodies, of, {region.centre, rotation}, region_triangles(entries, shape.labels));
      scene.accelerators.push_back(std::make_shared<Accelerator>(boundary, shape.labels, part != nullptr,
                                                                 assembly.accelerator, std::move(exact)));
    }
    region.thin_gaps = scene.accelerator(region).has_thin_gaps();
    scene.regions.push_back(region);
  };
  build(core::PartId::none());
  for (const core::PartId part : assembly.parts.ids()) build(part);
  scene.twins = twins.of_links();
  link_smooth_media(scene);
  set_lane_kinds(scene);
}

}  // namespace scintray::scene
