#pragma once
/// Parts that nearly touch.

#include <string>
#include <vector>

#include "scintray/contact/placed_mesh.hpp"

namespace scintray::contact {

/// Two parts whose faces face each other across a gap that may be a mistake.
struct SmallGap {
  std::string a, b;
  double gap_mm = 0.0;                    ///< at its narrowest
  core::Vec3 place = core::Vec3::Zero();  ///< there, mm
};

/// A gap is small below this share of the smaller part's diagonal.
inline constexpr double kSmallGapShare = 1e-3;

/// Pairs of parts with nearly parallel faces that overlap, seen along their normals, across a gap wider
/// than `tolerance_mm` (nearer ones touch) and narrower than `share` of the diagonal of the smaller part.
/// Gaps that a third part fills are none.
std::vector<SmallGap> find_small_gaps(const std::vector<PlacedMesh>& parts, double tolerance_mm,
                                      double share = kSmallGapShare);

}  // namespace scintray::contact
