#pragma once
/// Nesting and overlap of parts.

#include <cstdint>
#include <vector>

#include "scintray/contact/detail/clusters.hpp"

namespace scintray::contact {

/// Bodies around bodies. Bodies that merely touch are not inside each other.
struct Nesting {
  std::vector<std::vector<std::uint32_t>> around;  ///< by body: all bodies around it, innermost first
  std::vector<OverlappingPair> overlaps;
  std::vector<OverlappingPair> by_facets;  ///< these overlap by no more than their facets deviate

  std::size_t depth(std::uint32_t body) const { return around[body].size(); }
  /// The part that is the innermost body around `body`, or kAmbient.
  core::PartId parent(std::uint32_t body) const {
    return around[body].empty() ? kAmbient : core::PartId(around[body].front());
  }
};

/// Relation of every near pair of bodies: disjoint (touching or not), nested or overlapping. A body that
/// reaches less than `tolerance_mm` into the other one counts as touching it.
/// @param deviation_mm  of each body, the largest distance of its facets from the surfaces that they
///        approximate: bodies that overlap by less than both are as if they touched; empty: 0
[[nodiscard]] Nesting find_nesting(const std::vector<Body>& bodies, const std::vector<BodyPair>& pairs,
                                   double tolerance_mm, const std::vector<double>& deviation_mm = {});

/// Overlap of two parts.
struct OverlapVolume {
  double volume_mm3 = 0.0;
  core::Vec3 inside = core::Vec3::Zero();  ///< a point inside both, mm; where none was found, the middle of
                                           ///< the common part of their boxes
  bool exact = true;                       ///< false: counted on a grid of points
};

/// Number of grid points for the overlap of large meshes.
inline constexpr int kOverlapGridPoints = 32 * 32 * 32;

/// Volume common to two bodies. Exact to rounding while the product of their numbers of triangles is at
/// most 200,000; beyond, estimated on a regular grid over the common part of their boxes.
[[nodiscard]] OverlapVolume overlap_volume(const PlacedPart& a, const PlacedPart& b);

}  // namespace scintray::contact
