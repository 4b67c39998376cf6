#pragma once
/// Triangles of a part that lie against another part.

#include <vector>

#include "scintray/contact/placed_mesh.hpp"

namespace scintray::contact {

/// Mask over the triangles of `part`: 1 where some of its area lies on a face of `other`, facing it. Flat
/// triangles touch within `tolerance_mm`; with `curved_mm` above it, the tolerance of a conforming contact of
/// the two, curved ones do within that.
[[nodiscard]] std::vector<char> touching_triangles(const PlacedMesh& part, const PlacedMesh& other,
                                                   double tolerance_mm, double curved_mm = 0.0);

}  // namespace scintray::contact
