#pragma once
/// How much two parts overlap, for the message that refuses them.

#include <optional>

#include "scintray/scene/contact_geometry.hpp"

namespace scintray::contact {

struct OverlapVolume {
  double volume_mm3 = 0.0;
  Vec3 inside = Vec3::Zero();  ///< a point inside both, mm; where the grid finds none, the middle of the
                               ///< common part of their boxes
  bool exact = true;           ///< false: estimated on a grid of points
};

/// The volume common to two bodies: by exact boolean intersection of the meshes, or, for meshes that
/// this cannot take (not closed, or crossing themselves), from a regular grid of points.
OverlapVolume overlap_volume(const PlacedPart& a, const PlacedPart& b);

}  // namespace scintray::contact
