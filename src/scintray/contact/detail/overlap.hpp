#pragma once
/// How much two parts overlap, for the message that refuses them.

#include "scintray/contact/detail/geometry.hpp"

namespace scintray::contact {

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
OverlapVolume overlap_volume(const PlacedPart& a, const PlacedPart& b);

}  // namespace scintray::contact
