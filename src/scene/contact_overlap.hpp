#pragma once
/// How much two parts overlap, for the message that refuses them.

#include <optional>

#include "scintray/scene/contact_geometry.hpp"

namespace scintray::contact {

struct OverlapVolume {
  double volume_mm3 = 0.0;
  Vec3 inside = Vec3::Zero();  ///< a point inside both, mm; where the grid finds none, the middle of the
                               ///< common part of their boxes
};

/// The volume common to two bodies, counted on a regular grid of 32^3 points over the common part of
/// their boxes (docs/decisions.md says why not by an exact boolean).
OverlapVolume overlap_volume(const PlacedPart& a, const PlacedPart& b);

}  // namespace scintray::contact
