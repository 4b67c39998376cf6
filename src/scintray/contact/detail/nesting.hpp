#pragma once
/// Which part lies inside which, and which parts overlap and by how much.

#include <cstdint>
#include <vector>

#include "scintray/contact/detail/clusters.hpp"

namespace scintray::contact {

/// Two bodies that share volume without one lying inside the other.
struct OverlappingPair {
  std::uint32_t a, b;
};

/// Bodies around bodies. Bodies that merely touch are not inside each other.
struct Nesting {
  std::vector<std::vector<std::uint32_t>> around;  ///< by body: all bodies around it, innermost first
  std::vector<OverlappingPair> overlaps;

  std::size_t depth(std::uint32_t body) const { return around[body].size(); }
  /// The part that is the innermost body around `body`, or kAmbient.
  core::PartId parent(std::uint32_t body) const {
    return around[body].empty() ? kAmbient : core::PartId(around[body].front());
  }
};

/// Decides for every near pair whether the bodies are apart (touching or not), nested or overlapping.
/// What reaches less than `tolerance_mm` into the other body counts as touching it.
[[nodiscard]] Nesting find_nesting(const std::vector<Body>& bodies, const std::vector<BodyPair>& pairs,
                                   double tolerance_mm);

/// How much two parts overlap.
struct OverlapVolume {
  double volume_mm3 = 0.0;
  core::Vec3 inside = core::Vec3::Zero();  ///< a point inside both, mm; where none was found, the middle of
                                           ///< the common part of their boxes
  bool exact = true;                       ///< false: counted on a grid of points
};

/// Points of the grid that large meshes are counted on.
inline constexpr int kOverlapGridPoints = 32 * 32 * 32;

/// The volume common to two bodies. Exact to rounding while the product of their numbers of triangles
/// is at most 200,000; beyond, counted on a regular grid over the common part of their boxes.
[[nodiscard]] OverlapVolume overlap_volume(const PlacedPart& a, const PlacedPart& b);

}  // namespace scintray::contact
